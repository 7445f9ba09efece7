// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallColor.h"

#include <opencv2/core.hpp>

#include <optional>

namespace handeye
{

/// The ball's segmentation as the paper publishes it: HSV threshold for red, Gaussian and median smoothing, Hough circle.
///
/// The paper names the steps but not all numbers; where it is silent these are the values that OpenCV's own example of the
/// transform uses. Kept to compare with, not to be used: the circle's centre is not the ball's centre, and in a cluttered image the
/// strongest circle need not be the ball.
struct HoughBallOptions
{
  double hueToleranceDeg = 20;      ///< about red (0 deg)
  double minimumSaturation = 0.39;  ///< 100 of 255
  double minimumValue = 0.39;       ///< 100 of 255
  int gaussianSizePx = 9;
  double gaussianSigmaPx = 2;
  int medianSizePx = 5;
  double accumulatorScale = 2;  ///< Hough: image resolution over accumulator resolution
  double cannyThreshold = 100;
  double accumulatorThreshold = 30;
  BallColor::ChannelOrder channelOrder = BallColor::ChannelOrder::Bgr;
};

struct HoughCircle
{
  cv::Point2d center_Image;  ///< px
  double radiusPx = 0;
};

/// The first two stages: 255 where a pixel is red enough, and that smoothed.
cv::Mat houghMask(const cv::Mat& image, const HoughBallOptions& options = {});
cv::Mat houghSmoothed(const cv::Mat& mask, const HoughBallOptions& options = {});

/// The strongest circle in the thresholded image; nothing if there is none.
/// @param image BGR or BGRA, 8 or 16 bit
/// @throws std::invalid_argument as toHsv() does
std::optional<HoughCircle> findHoughCircle(const cv::Mat& image, const HoughBallOptions& options = {});

}  // namespace handeye
