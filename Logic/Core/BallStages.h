// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallDetection.h"
#include "CameraModel.h"

#include <opencv2/core.hpp>

namespace handeye
{

/// The stages of the detection as pictures of the frame's size, for a person to look at: the paper's figure. The fit itself takes its edges from
/// the image; mask and regions only say where to look.
struct BallStages
{
  cv::Mat mask;      ///< grey: how well each pixel suits the ball's colour (for the paper's pipeline: its threshold)
  cv::Mat smoothed;  ///< grey: the regions that are left without speckle (for the paper's pipeline: what the transform sees)
  cv::Mat edges;     ///< BGR: the frame, dimmed, and the edge points that the fit rests on (paper: that vote for circles)
  cv::Mat outline;   ///< BGR: the frame, the fitted outline and the ball's centre, or why there is none
};

/// @param image the frame, as given to detectBall()
/// @param detection what detectBall() said of it, with these options
/// @throws std::invalid_argument for an image that detectBall() would refuse
/// Thread-safe.
[[nodiscard]] BallStages drawBallStages(const cv::Mat& image, const BallDetection& detection, const CameraModel& camera,
  double ballRadiusMm, const BallDetectionOptions& options = {});

}  // namespace handeye
