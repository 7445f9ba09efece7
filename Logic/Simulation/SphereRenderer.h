// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace handeye::simulation
{

/// Blue, green, red in linear light, 0 to 1.
using Light = cv::Vec3f;

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

struct Photograph
{
  double blurPx = 0.7;  ///< standard deviation of the optics' blur, in linear light
  double noise = 0;     ///< standard deviation in steps of 8 bits, after the encoding
  int type = CV_8UC3;   ///< CV_8UC3 or CV_16UC3
  unsigned seed = 1;
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

/// A picture of balls, worked out analytically: whether a ray meets the sphere, each ray through the exact lens, 8 x 8 rays a pixel
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
    // Pixels whose corners are well on one side of the outline have one ray; the others a grid of them.
    cv::Mat1d corners(area.height + 1, area.width + 1);
    for (int i = 0; i < int(corners.total()); ++i)
    {
      const int row = i / corners.cols, column = i % corners.cols;
      corners(row, column) = beyondOutline(ball, area.x + column - 0.5, area.y + row - 0.5);
    }
    for (int row = 0; row < area.height; ++row)
    {
      for (int column = 0; column < area.width; ++column)
      {
        double nearest = 0, furthest = 0;
        cv::minMaxLoc(corners(cv::Rect(column, row, 2, 2)), &nearest, &furthest);
        const double margin = 0.3 * (furthest - nearest);
        Light& pixel = light_.at<Light>(area.y + row, area.x + column);
        if (nearest > margin)
        {
          continue;
        }
        pixel = furthest < -margin ? sample(ball, area.x + column, area.y + row, pixel)
                                   : supersample(ball, area.x + column, area.y + row, pixel);
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
    cv::Mat noise(light_.size(), CV_32FC3, cv::Scalar::all(0));
    cv::RNG random(how.seed);
    if (how.noise > 0)
    {
      random.fill(noise, cv::RNG::NORMAL, cv::Scalar::all(0), cv::Scalar::all(how.noise / 255));
    }
    const bool isWide = CV_MAT_DEPTH(how.type) == CV_16U;
    cv::Mat encoded(light_.size(), CV_32FC3);
    for (int row = 0; row < light_.rows; ++row)
    {
      const float* from = blurred.ptr<float>(row);
      float* to = encoded.ptr<float>(row);
      for (int i = 0; i < 3 * light_.cols; ++i)
      {
        to[i] = isWide ? encode(from[i]) : encodeByTable(from[i]);
      }
    }
    cv::Mat image;
    cv::Mat(encoded + noise).convertTo(image, how.type, isWide ? 65535 : 255);  // rounds and saturates
    return image;
  }

private:
  static constexpr int Grid = 8;

  static float encode(float linear)
  {
    return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
  }

  static float encodeByTable(float linear)
  {
    static const std::vector<float> table = []
    {
      std::vector<float> values;
      for (int i = 0; i <= 65535; ++i)
      {
        values.push_back(encode(float(i) / 65535));
      }
      return values;
    }();
    return table[std::size_t(std::clamp(std::lround(linear * 65535), 0L, 65535L))];
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

  Light sample(const RenderedBall& ball, double x, double y, const Light& behind) const
  {
    const Eigen::Vector3d ray = rayAt(x, y);
    return meets(ball, ray) ? colorAt(ball, ray) : behind;
  }

  Light supersample(const RenderedBall& ball, int column, int row, const Light& behind) const
  {
    Light sum(0, 0, 0);
    for (int i = 0; i < Grid * Grid; ++i)
    {
      sum += sample(ball, column + (i % Grid + 0.5) / Grid - 0.5, row + (i / Grid + 0.5) / Grid - 0.5, behind);
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
  const RayTable* rays_ = nullptr;
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
