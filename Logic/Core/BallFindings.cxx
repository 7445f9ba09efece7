// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallFindings.h"

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

/// A candidate this close to a ball that was found, as a share of its size, is that ball.
constexpr double AlreadyKnown = 0.1;
/// A region that goes no further than this beyond a ball that was found belongs to it (px).
constexpr int BeyondKnownPx = 4;

}  // namespace

bool FoundBall::isSameAs(const FoundBall& other) const
{
  const double apart = fit.cone.axis_Camera.cross(other.fit.cone.axis_Camera).norm();
  return apart < std::sin(std::max(fit.cone.halfAngle, other.fit.cone.halfAngle));
}

bool FoundBall::isSameAs(const SphereCone& candidate) const
{
  return fit.cone.isCloseTo(candidate, AlreadyKnown);
}

bool FoundBall::contains(const cv::Rect& region) const
{
  const auto isBeyond = [&](double x, double y, double nx, double ny)
  {
    // The region's side against the furthest point of the outline in its direction.
    double furthest = -1e9;
    for (const Eigen::Vector2d& point : fit.support_Image)
    {
      furthest = std::max(furthest, nx * point.x() + ny * point.y());
    }
    return nx * x + ny * y > furthest + BeyondKnownPx;
  };
  const cv::Point last = region.br() - cv::Point(1, 1);
  return !isBeyond(region.x, region.y, -1, 0) && !isBeyond(region.x, region.y, 0, -1) && !isBeyond(last.x, last.y, 1, 0) &&
    !isBeyond(last.x, last.y, 0, 1);
}

bool BallFindings::hasAround(const cv::Rect& region) const
{
  return std::any_of(balls.begin(), balls.end(), [&](const FoundBall& ball) { return ball.contains(region); });
}

void BallFindings::add(const FoundBall& found)
{
  if (!found.evidence.isBall)
  {
    partlySeen = found.evidence.isPartOfBall ? std::max(partlySeen, found.fit.visibleShare) : partlySeen;
    return;
  }
  const auto same = std::find_if(balls.begin(), balls.end(), [&](const FoundBall& other) { return found.isSameAs(other); });
  if (same == balls.end())
  {
    balls.push_back(found);
  }
  else if (found.score() > same->score())
  {
    *same = found;
  }
}

void BallFindings::sort()
{
  const auto isPiece = [&](const FoundBall& ball)
  {
    return std::any_of(smeared.begin(), smeared.end(),
      [&](const FoundBall& other) { return other.isSameAs(ball) && other.evidence.radiusPx > ball.evidence.radiusPx; });
  };
  balls.erase(std::remove_if(balls.begin(), balls.end(), isPiece), balls.end());
  std::sort(balls.begin(), balls.end(), [](const FoundBall& a, const FoundBall& b) { return a.score() > b.score(); });
}

}  // namespace handeye
