// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LensWarp.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace handeye
{

namespace
{

constexpr double CornerMargin = 1.1;
constexpr double FoldMargin = 0.999;
constexpr double LeastSlope = 0.25;
constexpr int DirectionCount = 16;

Eigen::Vector2d direction(int index)
{
  const double angle = 2 * M_PI * index / DirectionCount;
  return { std::cos(angle), std::sin(angle) };
}

/// The homography of a tilted sensor, as OpenCV defines it.
Eigen::Matrix3f tiltHomography(double tauX, double tauY)
{
  const Eigen::Matrix3d rotation =
    (Eigen::AngleAxisd(-tauY, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(-tauX, Eigen::Vector3d::UnitX())).toRotationMatrix();
  Eigen::Matrix3d projection;
  projection << rotation(2, 2), 0, -rotation(0, 2), 0, rotation(2, 2), -rotation(1, 2), 0, 0, 1;
  return (projection * rotation).cast<float>();
}

/// The normalised radius of what is seen at the picture's border, and whether all of the border is within the lens model.
struct BorderRadius
{
  double largest = 0;
  bool complete = true;
};

BorderRadius borderRadius(const CameraModel& camera)
{
  BorderRadius border;
  constexpr int steps = 32;
  for (int i = 0; i <= steps; ++i)
  {
    const double u = -0.5 + double(camera.width()) * i / steps, v = -0.5 + double(camera.height()) * i / steps;
    const double right = camera.width() - 0.5, bottom = camera.height() - 0.5;
    for (const Eigen::Vector2d& pixel :
      { Eigen::Vector2d(u, -0.5), Eigen::Vector2d(u, bottom), Eigen::Vector2d(-0.5, v), Eigen::Vector2d(right, v) })
    {
      const CameraModel::Unprojection seen = camera.unproject(pixel);
      if (seen.isUsable())
      {
        border.largest = std::max(border.largest, seen.ray_Camera.hnormalized().norm());
      }
      border.complete = border.complete && seen.isUsable();
    }
  }
  return border;
}

double limitRadius(const CameraModel& camera)
{
  const double foldRadius = FoldMargin * camera.maximumRadius();
  const BorderRadius border = borderRadius(camera);
  if (!border.complete && std::isfinite(foldRadius))
  {
    return foldRadius;
  }
  return std::min(CornerMargin * border.largest, foldRadius);
}

double outerSlope(const CameraModel& camera, double radius)
{
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < DirectionCount; ++i)
  {
    Eigen::Matrix2d jacobian;
    camera.distort(radius * direction(i), &jacobian);
    least = std::min(least, direction(i).dot(jacobian * direction(i)));
  }
  return std::max(least, LeastSlope);
}

double secondDerivativePx(const CameraModel& camera, const Eigen::Vector2d& point_Normalized)
{
  constexpr double step = 1e-3;
  const Eigen::Vector2d focal(camera.fx(), camera.fy());
  const Eigen::Vector2d middle = camera.distort(point_Normalized);
  double largest = 0;
  for (int i = 0; i < DirectionCount / 2; ++i)
  {
    const Eigen::Vector2d ahead = camera.distort(point_Normalized + step * direction(i));
    const Eigen::Vector2d behind = camera.distort(point_Normalized - step * direction(i));
    const Eigen::Vector2d bend = (ahead - 2 * middle + behind) / (step * step);
    largest = std::max(largest, focal.cwiseProduct(bend).norm());
  }
  return largest;
}

double largestCurvaturePx(const CameraModel& camera)
{
  constexpr int steps = 16;
  double largest = 0;
  for (int row = 0; row <= steps; ++row)
  {
    for (int column = 0; column <= steps; ++column)
    {
      const Eigen::Vector2d pixel(-0.5 + double(camera.width()) * column / steps, -0.5 + double(camera.height()) * row / steps);
      const CameraModel::Unprojection seen = camera.unproject(pixel);
      if (seen.isUsable())
      {
        largest = std::max(largest, secondDerivativePx(camera, seen.ray_Camera.hnormalized()));
      }
    }
  }
  return largest;
}

/// How much longer an edge can be in normalised coordinates than its length by the distance, if it leans towards the camera.
double obliqueness(const LensWarp& warp)
{
  return std::sqrt(1 + warp.limitRadius * warp.limitRadius);
}

}  // namespace

LensWarp makeLensWarp(const CameraModel& camera)
{
  if (!camera.hasImageSize())
  {
    throw std::invalid_argument("the camera has no image size, and an overlay needs one");
  }
  LensWarp warp;
  const std::vector<double>& coefficients = camera.distortionCoefficients();
  std::transform(
    coefficients.begin(), coefficients.end(), warp.coefficients.begin(), [](double value) { return static_cast<float>(value); });
  const bool tilted = coefficients.size() == 14;
  Eigen::Map<Eigen::Matrix3f>(warp.tilt.data()) =
    tilted ? tiltHomography(coefficients[12], coefficients[13]) : tiltHomography(0, 0);
  warp.limitRadius = limitRadius(camera);
  warp.outerSlope = outerSlope(camera, warp.limitRadius);
  warp.curvaturePx = largestCurvaturePx(camera);
  return warp;
}

LensWarp plainWarp(const LensWarp& lens)
{
  LensWarp warp;
  Eigen::Map<Eigen::Matrix3f>(warp.tilt.data()) = tiltHomography(0, 0);
  warp.limitRadius = lens.limitRadius;
  return warp;
}

double longestEdgeMm(const LensWarp& warp, double nearestDistanceMm, double tolerancePx)
{
  // Below this the mapping is straight to within rounding.
  constexpr double straightPx = 1e-3;
  if (warp.curvaturePx < straightPx)
  {
    return std::numeric_limits<double>::infinity();
  }
  return nearestDistanceMm * std::sqrt(8 * tolerancePx / warp.curvaturePx) / obliqueness(warp);
}

double chordErrorPx(const LensWarp& warp, double nearestDistanceMm, double edgeMm)
{
  const double edge_Normalized = edgeMm / nearestDistanceMm * obliqueness(warp);
  return warp.curvaturePx * edge_Normalized * edge_Normalized / 8;
}

}  // namespace handeye
