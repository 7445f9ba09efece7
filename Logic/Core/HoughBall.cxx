// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HoughBall.h"

#include <opencv2/imgproc.hpp>

#include <vector>

namespace handeye
{

cv::Mat houghMask(const cv::Mat& image, const HoughBallOptions& options)
{
  BallColor red;
  red.hueToleranceDeg = options.hueToleranceDeg;
  red.minimumSaturation = options.minimumSaturation;
  red.minimumValue = options.minimumValue;
  return ballColorMask(toHsv(image, options.channelOrder), red);
}

cv::Mat houghSmoothed(const cv::Mat& mask, const HoughBallOptions& options)
{
  cv::Mat smoothed;
  cv::GaussianBlur(mask, smoothed, { options.gaussianSizePx, options.gaussianSizePx }, options.gaussianSigmaPx);
  cv::medianBlur(smoothed, smoothed, options.medianSizePx);
  return smoothed;
}

std::optional<HoughCircle> findHoughCircle(const cv::Mat& image, const HoughBallOptions& options)
{
  const cv::Mat smoothed = houghSmoothed(houghMask(image, options), options);
  std::vector<cv::Vec3f> circles;
  cv::HoughCircles(smoothed, circles, cv::HOUGH_GRADIENT, options.accumulatorScale, smoothed.rows / 4.0, options.cannyThreshold,
    options.accumulatorThreshold);
  if (circles.empty())
  {
    return std::nullopt;
  }
  return HoughCircle{ { circles[0][0], circles[0][1] }, circles[0][2] };
}

}  // namespace handeye
