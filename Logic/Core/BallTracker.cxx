// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallTracker.h"

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

/// The window reaches this far beyond the outline: a share of the radius, and some px.
constexpr double BeyondShare = 0.75;
constexpr double BeyondPx = 12;
/// A ball whose outline comes this close (px) to the window's border may go on beyond it.
constexpr double BorderPx = 3;
/// How far around a predicted place is looked.
constexpr double PredictionSigmas = 4;
/// No image reaches as far (px).
constexpr double FurthestPx = 1e6;

cv::Rect windowAround(const Eigen::Vector2d& center, double halfSize)
{
  const int half = int(std::ceil(std::min(halfSize, FurthestPx)));
  const auto whole = [](double px) { return int(std::lround(std::clamp(px, -FurthestPx, FurthestPx))); };
  return { whole(center.x()) - half, whole(center.y()) - half, 2 * half + 1, 2 * half + 1 };
}

}  // namespace

std::optional<cv::Rect> BallTracker::expect(const std::optional<BallPrediction>& prediction) const
{
  if (prediction)
  {
    const CameraModel::Projection place = detector_.camera().project(prediction->ball_Camera);
    const double distance = prediction->ball_Camera.norm();
    if (!place.isUsable() || !(distance > detector_.ballRadiusMm()))
    {
      return std::nullopt;
    }
    const double focal = (detector_.camera().fx() + detector_.camera().fy()) / 2;
    const double radiusPx = focal * std::tan(std::asin(detector_.ballRadiusMm() / distance));
    return windowAround(place.point_Image, (1 + BeyondShare) * radiusPx + BeyondPx + PredictionSigmas * prediction->sigmaPx);
  }
  if (!last_)
  {
    return std::nullopt;
  }
  // The ball goes on as it went.
  const Eigen::Vector2d center = last_->ball_Image + motion_Image_;
  return windowAround(center, (1 + BeyondShare) * last_->radiusPx + BeyondPx + motion_Image_.norm());
}

BallDetection BallTracker::next(const cv::Mat& image, const std::optional<BallPrediction>& prediction)
{
  if (prediction)
  {
    prediction->check();
  }
  const cv::Rect whole(0, 0, image.cols, image.rows);
  BallDetection found;
  searched_ = whole;
  if (const std::optional<cv::Rect> expected = expect(prediction))
  {
    searched_ = *expected & whole;
    found = detector_.detectIn(image, searched_, prediction);
  }
  else
  {
    searched_ = {};
  }
  if (searched_ != whole && !(found.isFound() && isInside(found, searched_, whole)))
  {
    searched_ = whole;
    found = detector_.detect(image, prediction);
  }
  motion_Image_ = last_ && found.isFound() ? Eigen::Vector2d(found.ball_Image - last_->ball_Image) : Eigen::Vector2d::Zero();
  last_ = found.isFound() ? std::optional(found) : std::nullopt;
  return found;
}

bool BallTracker::isInside(const BallDetection& found, const cv::Rect& window, const cv::Rect& whole)
{
  return std::all_of(found.outline_Image.begin(), found.outline_Image.end(),
    [&](const Eigen::Vector2d& point)
    {
      return (window.x == whole.x || point.x() > window.x + BorderPx) && (window.y == whole.y || point.y() > window.y + BorderPx) &&
        (window.br().x == whole.br().x || point.x() < window.br().x - 1 - BorderPx) &&
        (window.br().y == whole.br().y || point.y() < window.br().y - 1 - BorderPx);
    });
}

}  // namespace handeye
