// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallStages.h"

#include "BallColorLevels.h"
#include "HoughBall.h"
#include "SphereCone.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

const cv::Scalar Green(80, 255, 80);
const cv::Scalar Yellow(40, 230, 255);
constexpr int SpecklePx = 5;
constexpr int OutlineCorners = 360;
/// Sub-pixel drawing: coordinates have this many binary places.
constexpr int BinaryPlaces = 4;

cv::Point scaled(const Eigen::Vector2d& point)
{
  const double scale = 1 << BinaryPlaces;
  return { int(std::lround(scale * point.x())), int(std::lround(scale * point.y())) };
}

cv::Mat toBgr(const cv::Mat& image, BallColor::ChannelOrder order)
{
  cv::Mat buffer, bgr;
  const cv::Mat& eight = toEightBits(image, buffer);
  const bool isBgr = order == BallColor::ChannelOrder::Bgr, hasAlpha = image.channels() == 4;
  if (isBgr && !hasAlpha)
  {
    return eight.clone();
  }
  cv::cvtColor(eight, bgr, hasAlpha ? (isBgr ? cv::COLOR_BGRA2BGR : cv::COLOR_RGBA2BGR) : cv::COLOR_RGB2BGR);
  return bgr;
}

/// The outline of a ball of this size there; for the paper's pipeline the circle.
std::vector<cv::Point> outlineOf(
  const BallDetection& detection, const CameraModel& camera, double ballRadiusMm, const BallDetectionOptions& options)
{
  std::vector<cv::Point> polygon;
  if (options.method == BallDetectionOptions::Method::Hough)
  {
    for (int i = 0; i < OutlineCorners; ++i)
    {
      const double turn = 2 * EIGEN_PI * i / OutlineCorners;
      polygon.push_back(scaled(detection.ball_Image + detection.radiusPx * Eigen::Vector2d(std::cos(turn), std::sin(turn))));
    }
    return polygon;
  }
  const SphereCone cone{ detection.ray_Camera, std::asin(std::min(1.0, ballRadiusMm / detection.distanceMm)) };
  for (const Eigen::Vector2d& point : cone.outline(camera, OutlineCorners).points_Image)
  {
    polygon.push_back(scaled(point));
  }
  return polygon;
}

void drawBall(cv::Mat& picture, const BallDetection& detection, const std::vector<cv::Point>& outline)
{
  cv::polylines(picture, std::vector<std::vector<cv::Point>>{ outline }, true, Green, 1, cv::LINE_AA, BinaryPlaces);
  const double arm = std::clamp(detection.radiusPx / 4, 4.0, 15.0);
  for (const Eigen::Vector2d& along : { Eigen::Vector2d(arm, 0), Eigen::Vector2d(0, arm) })
  {
    cv::line(
      picture, scaled(detection.ball_Image - along), scaled(detection.ball_Image + along), Yellow, 1, cv::LINE_AA, BinaryPlaces);
  }
}

void writeReason(cv::Mat& picture, const std::string& reason)
{
  const double size = std::clamp(picture.cols / 1000.0, 0.4, 1.0);
  const cv::Point place(8, int(30 * size) + 4);
  cv::putText(picture, reason, place, cv::FONT_HERSHEY_SIMPLEX, size, cv::Scalar::all(0), 3, cv::LINE_AA);
  cv::putText(picture, reason, place, cv::FONT_HERSHEY_SIMPLEX, size, Yellow, 1, cv::LINE_AA);
}

}  // namespace

BallStages drawBallStages(const cv::Mat& image, const BallDetection& detection, const CameraModel& camera, double ballRadiusMm,
  const BallDetectionOptions& options)
{
  requireColorImage(image);
  BallStages stages;
  cv::Mat voters;
  if (options.method == BallDetectionOptions::Method::Hough)
  {
    HoughBallOptions hough;
    hough.channelOrder = options.color.channelOrder;
    stages.mask = houghMask(image, hough);
    stages.smoothed = houghSmoothed(stages.mask, hough);
    cv::Canny(stages.smoothed, voters, hough.cannyThreshold / 2, hough.cannyThreshold);
  }
  else
  {
    const BallColorLevels levels(image, adaptToLight(options.color, image), { 0, 0, image.cols, image.rows });
    stages.mask = levels.likelihood() * (255 / BallColorLevels::Count);
    cv::medianBlur(stages.mask, stages.smoothed, SpecklePx);
  }
  stages.outline = toBgr(image, options.color.channelOrder);
  stages.edges = 0.5 * stages.outline;
  if (!voters.empty())
  {
    stages.edges.setTo(Green, voters);
  }
  for (const Eigen::Vector2d& point : detection.outline_Image)
  {
    cv::circle(stages.edges, scaled(point), 1 << BinaryPlaces, Green, cv::FILLED, cv::LINE_AA, BinaryPlaces);
  }
  if (detection.isFound())
  {
    drawBall(stages.outline, detection, outlineOf(detection, camera, ballRadiusMm, options));
  }
  else
  {
    writeReason(stages.outline, detection.message);
  }
  return stages;
}

}  // namespace handeye
