// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "Photograph.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace handeye::simulation
{

const Light BallRed(0.02F, 0.015F, 0.55F);
const Light TableGrey(0.22F, 0.24F, 0.23F);
const Light GloveBlue(0.5F, 0.2F, 0.05F);

struct RenderedBall
{
  Eigen::Vector3d center_Camera = { 0, 0, 300 };
  double radiusMm = 15;
  Light color = BallRed;
  bool isShaded = false;  ///< Lambert's law under a lamp above and to the left, with ambient light; otherwise one colour
};

/// The rays of a camera's pixel corners, worked out once for many pictures. In between they are interpolated, which is exact to
/// better
/// than 1e-4 px for lenses that are not wilder than a fisheye's.
class RayTable
{
public:
  explicit RayTable(const CameraModel& camera)
    : rays_(camera.height() + 1, camera.width() + 1)
  {
    for (int row = 0; row < rays_.rows; ++row)
    {
      for (int column = 0; column < rays_.cols; ++column)
      {
        const Eigen::Vector3d ray = camera.unproject({ column - 0.5, row - 0.5 }).ray_Camera;
        rays_(row, column) = { ray.x(), ray.y(), ray.z() };
      }
    }
  }

  /// The unit ray of a place in the image; corners of pixels lie at halves.
  Eigen::Vector3d at(double x, double y) const
  {
    const int column = std::clamp(int(std::floor(x + 0.5)), 0, rays_.cols - 2),
              row = std::clamp(int(std::floor(y + 0.5)), 0, rays_.rows - 2);
    const double u = x + 0.5 - column, v = y + 0.5 - row;
    const cv::Vec3d* upper = rays_[row] + column;
    const cv::Vec3d* lower = rays_[row + 1] + column;
    const cv::Vec3d ray = (1 - v) * ((1 - u) * upper[0] + u * upper[1]) + v * ((1 - u) * lower[0] + u * lower[1]);
    return Eigen::Vector3d(ray[0], ray[1], ray[2]).normalized();
  }

private:
  cv::Mat_<cv::Vec3d> rays_;
};

/// A picture of balls, worked out analytically: whether a ray meets the sphere, through the exact lens, 8 x 8 rays a pixel
/// along the outline, in linear light; then blur, sRGB, noise and rounding.
class SphereScene
{
public:
  /// @param rays of this camera, where there are many pictures to make; kept by the caller
  explicit SphereScene(const CameraModel& camera, const Light& background = TableGrey, const RayTable* rays = nullptr)
    : camera_(camera)
    , rays_(rays)
    , light_(camera.height(), camera.width(), CV_32FC3, cv::Scalar(background[0], background[1], background[2]))
  {
  }

  /// The picture in linear light, for a test to draw other things in.
  cv::Mat& light() { return light_; }

  SphereScene& add(const RenderedBall& ball)
  {
    const cv::Rect area = boundsOf(ball);
    for (int y = area.y; y < area.br().y; y += Block)
    {
      for (int x = area.x; x < area.br().x; x += Block)
      {
        addBlock(ball, cv::Rect(x, y, Block, Block) & area);
      }
    }
    return *this;
  }

  /// A block of one colour that stands in front of what is there.
  SphereScene& cover(const cv::Rect& area, const Light& color = GloveBlue)
  {
    light_(area & cv::Rect({ 0, 0 }, light_.size())).setTo(cv::Scalar(color[0], color[1], color[2]));
    return *this;
  }

  cv::Mat photograph(const Photograph& how = {}) const
  {
    cv::Mat blurred = light_;
    if (how.blurPx > 0)
    {
      cv::GaussianBlur(light_, blurred, {}, how.blurPx, how.blurPx, cv::BORDER_REPLICATE);
    }
    return develop(blurred, how);
  }

private:
  static constexpr int Grid = 8;
  static constexpr int Block = 8;

  /// A block of pixels far from the outline needs at most a ray a pixel.
  void addBlock(const RenderedBall& ball, const cv::Rect& block)
  {
    const cv::Point end = block.br();
    const double corners[] = { beyondOutline(ball, block.x - 0.5, block.y - 0.5), beyondOutline(ball, end.x - 0.5, block.y - 0.5),
      beyondOutline(ball, block.x - 0.5, end.y - 0.5), beyondOutline(ball, end.x - 0.5, end.y - 0.5) };
    const auto [nearest, furthest] = std::minmax_element(std::begin(corners), std::end(corners));
    const double farAway = 3 * Block / std::min(camera_.fx(), camera_.fy());
    if (*nearest > farAway)
    {
      return;
    }
    const bool isInside = *furthest < -farAway;
    if (isInside && !ball.isShaded)
    {
      light_(block).setTo(cv::Scalar(ball.color[0], ball.color[1], ball.color[2]));
      return;
    }
    if (isInside)
    {
      for (int i = 0; i < block.area(); ++i)
      {
        const int x = block.x + i % block.width, y = block.y + i / block.width;
        light_.at<Light>(y, x) = colorAt(ball, rayAt(x, y));
      }
      return;
    }
    addRim(ball, block);
  }

  /// Pixels whose corners are well on one side of the outline have one ray; the others a grid of them.
  void addRim(const RenderedBall& ball, const cv::Rect& block)
  {
    cv::Mat1d beyond(block.height + 1, block.width + 1);
    for (int i = 0; i < int(beyond.total()); ++i)
    {
      const int row = i / beyond.cols, column = i % beyond.cols;
      beyond(row, column) = beyondOutline(ball, block.x + column - 0.5, block.y + row - 0.5);
    }
    for (int i = 0; i < block.area(); ++i)
    {
      const int column = i % block.width, row = i / block.width, x = block.x + column, y = block.y + row;
      const auto [nearest, furthest] =
        std::minmax({ beyond(row, column), beyond(row, column + 1), beyond(row + 1, column), beyond(row + 1, column + 1) });
      const double margin = 0.3 * (furthest - nearest);
      if (nearest <= margin)
      {
        Light& pixel = light_.at<Light>(y, x);
        pixel = furthest < -margin ? sample(ball, rayAt(x, y), pixel) : supersample(ball, x, y, pixel);
      }
    }
  }

  static bool meets(const RenderedBall& ball, const Eigen::Vector3d& ray)
  {
    return ray.dot(ball.center_Camera) > 0 && ray.cross(ball.center_Camera).norm() < ball.radiusMm;
  }

  static Light colorAt(const RenderedBall& ball, const Eigen::Vector3d& ray)
  {
    if (!ball.isShaded)
    {
      return ball.color;
    }
    const double along = ray.dot(ball.center_Camera);
    const double inside = ball.radiusMm * ball.radiusMm - ball.center_Camera.squaredNorm() + along * along;
    const Eigen::Vector3d hit = (along - std::sqrt(std::max(0.0, inside))) * ray;
    const Eigen::Vector3d normal = (hit - ball.center_Camera).normalized();
    const double lamp = std::max(0.0, normal.dot(Eigen::Vector3d(-0.3, -0.8, -0.5).normalized()));
    return ball.color * float(0.25 + 0.9 * lamp);
  }

  Eigen::Vector3d rayAt(double x, double y) const
  {
    return rays_ != nullptr ? rays_->at(x, y) : camera_.unproject({ x, y }).ray_Camera;
  }

  static Light sample(const RenderedBall& ball, const Eigen::Vector3d& ray, const Light& behind)
  {
    return meets(ball, ray) ? colorAt(ball, ray) : behind;
  }

  /// The rays of a pixel lie so close together that those between the exact ones of its quarters' corners are linear to 1e-4 px.
  Light supersample(const RenderedBall& ball, int column, int row, const Light& behind) const
  {
    Eigen::Vector3d exact[3][3];
    for (int i = 0; i < 9; ++i)
    {
      exact[i / 3][i % 3] = rayAt(column + 0.5 * (i % 3) - 0.5, row + 0.5 * (i / 3) - 0.5);
    }
    Light sum(0, 0, 0);
    for (int i = 0; i < Grid * Grid; ++i)
    {
      const double x = 2 * (i % Grid + 0.5) / Grid, y = 2 * (i / Grid + 0.5) / Grid;
      const int right = int(x), below = int(y);
      const Eigen::Vector3d upper = exact[below][right] + (x - right) * (exact[below][right + 1] - exact[below][right]);
      const Eigen::Vector3d lower = exact[below + 1][right] + (x - right) * (exact[below + 1][right + 1] - exact[below + 1][right]);
      sum += sample(ball, (upper + (y - below) * (lower - upper)).normalized(), behind);
    }
    return sum / float(Grid * Grid);
  }

  /// The angle (rad) between the outline and the ray of a place in the image, negative inside.
  double beyondOutline(const RenderedBall& ball, double x, double y) const
  {
    const Eigen::Vector3d ray = rayAt(x, y);
    const double angle = std::atan2(ray.cross(ball.center_Camera).norm(), ray.dot(ball.center_Camera));
    return angle - std::asin(ball.radiusMm / ball.center_Camera.norm());
  }

  /// Around the projections of rays that touch the ball.
  cv::Rect boundsOf(const RenderedBall& ball) const
  {
    const Eigen::Matrix3d zToBall =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), ball.center_Camera).toRotationMatrix();
    const double distance = ball.center_Camera.norm(), slope = std::tan(std::asin(ball.radiusMm / distance));
    Eigen::AlignedBox2d box;
    for (int i = 0; i < 90; ++i)
    {
      const double turn = 2 * EIGEN_PI * i / 90;
      const Eigen::Vector3d ray = zToBall * Eigen::Vector3d(slope * std::cos(turn), slope * std::sin(turn), 1);
      const CameraModel::Projection seen = camera_.project(ray);
      if (seen.isUsable())
      {
        box.extend(seen.point_Image);
      }
    }
    const cv::Rect area(
      cv::Point(int(box.min().x()) - 3, int(box.min().y()) - 3), cv::Point(int(box.max().x()) + 4, int(box.max().y()) + 4));
    return area & cv::Rect({ 0, 0 }, light_.size());
  }

  CameraModel camera_;
  const RayTable* rays_;
  cv::Mat light_;
};

/// A ball whose outline has about this radius (px) and whose centre is seen at this place, as shares of the image's width and
/// height.
inline RenderedBall ballSeenAt(const CameraModel& camera, double xShare, double yShare, double radiusPx, double radiusMm = 15)
{
  RenderedBall ball;
  ball.radiusMm = radiusMm;
  const double focal = (camera.fx() + camera.fy()) / 2;
  const Eigen::Vector3d ray = camera.unproject({ xShare * camera.width(), yShare * camera.height() }).ray_Camera;
  ball.center_Camera = ray * radiusMm / std::sin(std::atan(radiusPx / focal));
  return ball;
}

}  // namespace handeye::simulation
