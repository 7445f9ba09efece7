// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ClutteredPicture.h"
#include "TestCameras.h"

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

namespace handeye::test
{

const Light TissuePink(0.16F, 0.14F, 0.42F);
const Light LampWhite(2.5F, 2.5F, 2.5F);

struct Background
{
  std::string name;
  int clutterSeed = 0;  ///< 0: a grey table
};

inline void PrintTo(const Background& background, std::ostream* os)
{
  *os << background.name;
}

/// Balls and other things before a grey table or a cluttered room, photographed by the webcam: for what a detection must answer
/// where the picture is not as it should be.
class ConditionScene
{
public:
  static constexpr double BlurPx = 0.7;

  static std::vector<Background> backgrounds() { return { { "grey table", 0 }, { "cluttered room", 3 }, { "other room", 8 } }; }

  explicit ConditionScene(const Background& background = {})
    : camera_(webcam())
    , light_(480, 640, CV_32FC3, cv::Scalar(TableGrey[0], TableGrey[1], TableGrey[2]))
  {
    if (background.clutterSeed != 0)
    {
      light_ = toLight(clutter(light_.size(), unsigned(background.clutterSeed)));
    }
  }

  const CameraModel& camera() const { return camera_; }

  ConditionScene& add(const RenderedBall& ball, const Eigen::Vector2d& motionPx = { 0, 0 })
  {
    drawBall(light_, cv::Rect({ 0, 0 }, light_.size()), camera_, ball, BlurPx, motionPx);
    return *this;
  }

  ConditionScene& disc(const Eigen::Vector2d& center, double radiusPx, const Light& color)
  {
    cv::Mat mask = cv::Mat::zeros(light_.size(), CV_8U);
    cv::circle(mask, fixed(center), int(std::lround(radiusPx * Fixed)), 255, cv::FILLED, cv::LINE_AA, Bits);
    return painted(mask, color);
  }

  ConditionScene& ring(const Eigen::Vector2d& center, double radiusPx, int widthPx, const Light& color)
  {
    cv::Mat mask = cv::Mat::zeros(light_.size(), CV_8U);
    cv::circle(mask, fixed(center), int(std::lround(radiusPx * Fixed)), 255, widthPx, cv::LINE_AA, Bits);
    return painted(mask, color);
  }

  ConditionScene& ellipse(const Eigen::Vector2d& center, const cv::Size& halfAxes, double angleDeg, const Light& color)
  {
    cv::Mat mask = cv::Mat::zeros(light_.size(), CV_8U);
    cv::ellipse(mask, fixed(center), halfAxes * Fixed, angleDeg, 0, 360, 255, cv::FILLED, cv::LINE_AA, Bits);
    return painted(mask, color);
  }

  ConditionScene& polygon(const std::vector<Eigen::Vector2d>& corners, const Light& color)
  {
    std::vector<cv::Point> points;
    for (const Eigen::Vector2d& corner : corners)
    {
      points.push_back(fixed(corner));
    }
    cv::Mat mask = cv::Mat::zeros(light_.size(), CV_8U);
    cv::fillConvexPoly(mask, points, 255, cv::LINE_AA, Bits);
    return painted(mask, color);
  }

  /// A finger: a stroke of this width with round ends.
  ConditionScene& finger(const Eigen::Vector2d& from, const Eigen::Vector2d& to, int widthPx, const Light& color)
  {
    cv::Mat mask = cv::Mat::zeros(light_.size(), CV_8U);
    cv::line(mask, fixed(from), fixed(to), 255, widthPx, cv::LINE_AA, Bits);
    return painted(mask, color);
  }

  /// A hand with a straight edge that leaves `visibleShare` of a circle's outline; it comes from the direction of `angle` (rad).
  ConditionScene& hand(const Eigen::Vector2d& center, double radiusPx, double visibleShare, double angle)
  {
    const Eigen::Vector2d away(std::cos(angle), std::sin(angle)), along(-away.y(), away.x());
    const Eigen::Vector2d edge = center + radiusPx * std::cos(double(EIGEN_PI) * (1 - visibleShare)) * away;
    const double reach = 2.5 * radiusPx;
    return polygon(
      { edge + reach * along, edge - reach * along, edge - reach * along + reach * away, edge + reach * along + reach * away },
      GloveBlue);
  }

  /// A hand in a glove of this colour, its fingers spread.
  ConditionScene& glove(const Eigen::Vector2d& wrist, double size, const Light& color)
  {
    const auto at = [&](double x, double y) { return Eigen::Vector2d(wrist + size * Eigen::Vector2d(x, -y)); };
    polygon({ at(-0.28, 0), at(0.28, 0), at(0.42, 0.75), at(0.2, 0.95), at(-0.25, 0.95), at(-0.42, 0.7) }, color);
    const double tips[][4] = { { -0.32, 0.8, -0.5, 1.5 }, { -0.1, 0.85, -0.14, 1.75 }, { 0.12, 0.85, 0.2, 1.7 },
      { 0.32, 0.75, 0.52, 1.4 }, { -0.3, 0.25, -0.85, 0.75 } };
    for (const auto& tip : tips)
    {
      finger(at(tip[0], tip[1]), at(tip[2], tip[3]), int(0.2 * size), color);
    }
    return *this;
  }

  /// @param exposure what the light is multiplied by; @param noise in grey levels, after the encoding
  cv::Mat photograph(double exposure = 1, double noise = 1.5, unsigned seed = 1) const
  {
    Photograph how;
    how.blurPx = 0;
    how.noise = noise;
    how.seed = seed;
    return develop(light_ * exposure, how);
  }

private:
  static constexpr int Bits = 4, Fixed = 1 << Bits;

  static cv::Point fixed(const Eigen::Vector2d& point)
  {
    return { int(std::lround(Fixed * point.x())), int(std::lround(Fixed * point.y())) };
  }

  ConditionScene& painted(const cv::Mat& mask, const Light& color)
  {
    paint(light_, mask, color, BlurPx);
    return *this;
  }

  CameraModel camera_;
  cv::Mat light_;
};

}  // namespace handeye::test
