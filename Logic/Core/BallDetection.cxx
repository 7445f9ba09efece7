// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallDetection.h"

#include "BallDetector.h"

#include <stdexcept>

namespace handeye
{

void BallDetectionOptions::check() const
{
  color.check();
  const auto isShare = [](double value) { return value >= 0 && value <= 1; };
  if (!(minimumRadiusPx >= 3) || !isShare(minimumVisibleShare) || !isShare(minimumFill) || !(distinctionFactor >= 1))
  {
    throw std::invalid_argument("ball detection options: a radius of at least 3 px and shares between 0 and 1 are expected");
  }
  if (!(nearestMm >= 0) || !(furthestMm > nearestMm))
  {
    throw std::invalid_argument("ball detection options: the working range must go from 0 mm or more to something further away");
  }
}

BallDetection detectBall(const cv::Mat& image, const CameraModel& camera, double ballRadiusMm, const BallDetectionOptions& options)
{
  return BallDetector(camera, ballRadiusMm, options).detect(image);
}

std::string toString(BallDetection::Status status)
{
  using Status = BallDetection::Status;
  switch (status)
  {
    case Status::Found:
      return "ok";
    case Status::NotFound:
      return "not_found";
    case Status::SeveralBalls:
      return "several_balls";
    case Status::TooLittleVisible:
      return "too_little_visible";
    case Status::OutOfRange:
      return "out_of_range";
    case Status::Elsewhere:
      return "elsewhere";
  }
  return "unknown";
}

}  // namespace handeye
