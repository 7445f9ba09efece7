// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallDetection.h"

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <array>
#include <string>
#include <vector>

namespace handeye::report
{

/// Where something puts the ball's centre.
struct PredictedCenter
{
  Eigen::Vector2d place_Image = Eigen::Vector2d::Zero();  ///< px of the recorded image
  std::array<unsigned char, 3> color = { 255, 220, 0 };   ///< red, green, blue
  std::string label;                                      ///< for the legend in the picture; none where empty
};

/// The whole frame with the ball's outline and, beside it, the surroundings of the centre so much enlarged that errors of a pixel
/// are seen: the segmented centre as a green cross, each predicted one as a coloured cross with an arrow from the segmented to it.
/// Predicted centres that would make the others too small to see leave the enlargement; their arrows say where to.
///
/// @param image as recorded: 8 or 16 bits, grey, BGR or BGRA
/// @param ball its outline and centre are drawn if it was found
/// @return BGR, 8 bits, 960 px wide or a little more
[[nodiscard]] cv::Mat drawMarkedPicture(
  const cv::Mat& image, const BallDetection& ball, const std::vector<PredictedCenter>& predicted);

/// The frame alone, in its own pixels, with outline and both centres. @param predicted may be null
[[nodiscard]] cv::Mat drawFrame(const cv::Mat& image, const BallDetection& ball, const Eigen::Vector2d* predicted);

}  // namespace handeye::report
