// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeErrorField.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace handeye
{

namespace
{

std::array<float, 3> entries(const Eigen::Matrix2d& symmetric)
{
  return { float(symmetric(0, 0)), float(symmetric(0, 1)), float(symmetric(1, 1)) };
}

/// The derivative of a pixel by a motion of what is seen there at a distance of 1 mm. Beyond what the lens model reaches, that of
/// the place nearest to it on the way to the principal point: nothing is drawn there, but cells that reach there are.
Eigen::Matrix<double, 2, 6> jacobianAt(const CameraModel& camera, const Eigen::Vector2d& point_Image)
{
  constexpr int steps = 64;
  const Eigen::Vector2d middle(camera.cx(), camera.cy());
  for (int step = 0; step < steps; ++step)
  {
    const Eigen::Vector2d place = point_Image + (middle - point_Image) * (double(step) / steps);
    const std::optional<Eigen::Vector3d> point_Camera = pointSeenAt({ camera }, place, 1.0);
    const auto jacobian = point_Camera ? pixelJacobian({ camera }, *point_Camera) : std::nullopt;
    if (jacobian)
    {
      return *jacobian;
    }
  }
  return Eigen::Matrix<double, 2, 6>::Zero();
}

}  // namespace

HandEyeErrorField::HandEyeErrorField(const CameraModel& camera, const Covariance6& covariance)
  : width_(camera.width())
  , height_(camera.height())
{
  if (!camera.hasImageSize())
  {
    throw std::invalid_argument("the camera has no image size, and a field over its image needs one");
  }
  for (int row = Rows - 1; row >= 0; --row)
  {
    for (int column = 0; column < Columns; ++column)
    {
      const Eigen::Vector2d point_Image(double(width_) * column / (Columns - 1) - 0.5, double(height_) * row / (Rows - 1) - 0.5);
      const Eigen::Matrix<double, 2, 6> jacobian = jacobianAt(camera, point_Image);
      const Eigen::Matrix<double, 2, 3> byTurn = jacobian.leftCols<3>(), byShift = jacobian.rightCols<3>();
      const Eigen::Matrix2d mixed = byTurn * covariance.topRightCorner<3, 3>() * byShift.transpose();
      constant_.push_back(entries(byTurn * covariance.topLeftCorner<3, 3>() * byTurn.transpose()));
      linear_.push_back(entries(mixed + mixed.transpose()));
      quadratic_.push_back(entries(byShift * covariance.bottomRightCorner<3, 3>() * byShift.transpose()));
    }
  }
}

Eigen::Matrix2d HandEyeErrorField::covariancePx(const Eigen::Vector2d& point_Image, double depthMm) const
{
  const double x = std::clamp((point_Image.x() + 0.5) / width_, 0.0, 1.0) * (Columns - 1);
  const double y = (1 - std::clamp((point_Image.y() + 0.5) / height_, 0.0, 1.0)) * (Rows - 1);
  const int column = std::min(int(x), Columns - 2), row = std::min(int(y), Rows - 2);
  const Eigen::Vector2d weightsX(column + 1 - x, x - column), weightsY(row + 1 - y, y - row);
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int corner = 0; corner < 4; ++corner)
  {
    const std::size_t node = std::size_t((row + corner / 2) * Columns + column + corner % 2);
    const auto at = [node](const Nodes& nodes)
    { return Eigen::Array3d(double(nodes[node][0]), double(nodes[node][1]), double(nodes[node][2])); };
    const Eigen::Array3d value = at(constant_) + (at(linear_) + at(quadratic_) / depthMm) / depthMm;
    sum += weightsX[corner % 2] * weightsY[corner / 2] * value;
  }
  Eigen::Matrix2d covariance;
  covariance << sum[0], sum[1], sum[1], sum[2];
  return covariance;
}

}  // namespace handeye
