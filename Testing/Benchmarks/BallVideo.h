// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <vector>

namespace handeye::bench
{

/// A short video of a ball on a stylus that a hand moves through a cluttered room, 60 frames a second, in memory.
///
/// The room is a collage of rendered frames at their own scale; the ball is drawn analytically in linear light, with the optics'
/// blur and that of its motion; then noise (1.5 grey levels) and JPEG (quality 92).
struct BallVideo
{
  CameraModel camera;
  double ballRadiusMm = 15;
  std::vector<cv::Mat> frames;              ///< BGR, 8 bit
  std::vector<Eigen::Vector2d> ball_Image;  ///< px: where the ball's centre is seen
};

/// @param size of the frames; the field of view is the same for all sizes, so that the ball's size goes with the width
BallVideo makeBallVideo(const cv::Size& size, int frameCount);

}  // namespace handeye::bench
