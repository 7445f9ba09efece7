// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyePrediction.h"

#include "NumberWords.h"
#include "RigidTransform.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace handeye
{

namespace
{

/// The root of a variance, which rounding may leave a little below zero. What is not a number stays none: it is no small error.
double standardDeviation(double variance)
{
  return variance < 0 ? 0 : std::sqrt(variance);
}

}  // namespace

Covariance6 poseCovarianceIn(const Eigen::Isometry3d& fromToTo, const Covariance6& covariance_From)
{
  Covariance6 adjoint = Covariance6::Zero();
  adjoint.topLeftCorner<3, 3>() = adjoint.bottomRightCorner<3, 3>() = fromToTo.linear();
  adjoint.bottomLeftCorner<3, 3>() = skew(fromToTo.translation()) * fromToTo.linear();
  return adjoint * covariance_From * adjoint.transpose();
}

Eigen::Matrix<double, 3, 6> motionJacobian(const Eigen::Vector3d& point_Camera)
{
  Eigen::Matrix<double, 3, 6> motion;
  motion << -skew(point_Camera), Eigen::Matrix3d::Identity();
  return motion;
}

Eigen::Matrix3d predictTargetCovariance(const Covariance6& covariance, const Eigen::Vector3d& point_Camera)
{
  const Eigen::Matrix<double, 3, 6> motion = motionJacobian(point_Camera);
  return motion * covariance * motion.transpose();
}

double predictTargetErrorMm(const Covariance6& covariance, const Eigen::Vector3d& point_Camera)
{
  return standardDeviation(predictTargetCovariance(covariance, point_Camera).trace());
}

std::optional<Eigen::Vector3d> pointSeenAt(const Eye& eye, const Eigen::Vector2d& pixel, double depthMm)
{
  const CameraModel::Unprojection ray = eye.camera.unproject(pixel);
  if (!ray.isUsable())
  {
    return std::nullopt;
  }
  const Eigen::Vector3d point_Eye = ray.ray_Camera * (depthMm / ray.ray_Camera.z());
  return eye.cameraToEye.inverse() * point_Eye;
}

std::optional<Eigen::Matrix<double, 2, 6>> pixelJacobian(const Eye& eye, const Eigen::Vector3d& point_Camera)
{
  Eigen::Matrix<double, 2, 3> byPoint;
  if (!eye.camera.project(eye.cameraToEye * point_Camera, &byPoint).isUsable())
  {
    return std::nullopt;
  }
  const Eigen::Matrix<double, 2, 3> byPoint_Camera = byPoint * eye.cameraToEye.linear();
  return byPoint_Camera * motionJacobian(point_Camera);
}

std::optional<double> predictProjectionErrorPx(
  const Covariance6& covariance, const Eye& eye, const Eigen::Vector2d& pixel, double depthMm)
{
  const std::optional<Eigen::Vector3d> point_Camera = pointSeenAt(eye, pixel, depthMm);
  const auto byPose = point_Camera ? pixelJacobian(eye, *point_Camera) : std::nullopt;
  if (!byPose)
  {
    return std::nullopt;
  }
  return standardDeviation((*byPose * covariance * byPose->transpose()).trace());
}

PredictedError predictError(const Covariance6& covariance, const Eye& eye, double nearestMm, double furthestMm)
{
  constexpr int columns = 9, rows = 7, depths = 5;
  PredictedError error;
  error.nearestMm = nearestMm;
  error.furthestMm = furthestMm;
  const double width = eye.camera.hasImageSize() ? eye.camera.width() : 2 * eye.camera.cx() + 1;
  const double height = eye.camera.hasImageSize() ? eye.camera.height() : 2 * eye.camera.cy() + 1;
  int count = 0;
  for (int k = 0; k < depths * rows * columns; ++k)
  {
    const Eigen::Vector2d pixel((width - 1) * (k % columns) / (columns - 1), (height - 1) * (k / columns % rows) / (rows - 1));
    const double depth = nearestMm + (furthestMm - nearestMm) * (k / columns / rows) / (depths - 1);
    const std::optional<double> px = predictProjectionErrorPx(covariance, eye, pixel, depth);
    if (!px)
    {
      continue;
    }
    const double mm = predictTargetErrorMm(covariance, *pointSeenAt(eye, pixel, depth));
    error.meanPx += *px;
    error.meanMm += mm;
    error.maximumPx = std::max(error.maximumPx, *px);
    error.maximumMm = std::max(error.maximumMm, mm);
    ++count;
  }
  error.meanPx = count > 0 ? error.meanPx / count : std::numeric_limits<double>::infinity();
  error.meanMm = count > 0 ? error.meanMm / count : std::numeric_limits<double>::infinity();
  return error;
}

std::string describeWeakestFreedom(const Covariance6& covariance, double depthMm)
{
  static const char* const names[6] = { "pitch (turning about the image's x axis)", "yaw (turning about the image's y axis)",
    "roll (turning about the line of sight)", "a shift along the image's x axis", "a shift along the image's y axis",
    "a shift along the line of sight" };
  // A turn counts by what it does at the depth.
  Eigen::Matrix<double, 6, 1> unit;
  unit << Eigen::Vector3d::Constant(depthMm), Eigen::Vector3d::Ones();
  const Covariance6 scaled = unit.asDiagonal() * covariance * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Covariance6> spectrum(scaled);
  const Eigen::Matrix<double, 6, 1> freedom = spectrum.eigenvectors().col(5).cwiseAbs();
  constexpr int mostNamed = 3;
  std::array<int, 6> order = { 0, 1, 2, 3, 4, 5 };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return freedom(a) > freedom(b); });
  std::string words;
  for (int k = 0; k < mostNamed && freedom(order[std::size_t(k)]) > 0.5 * freedom.maxCoeff(); ++k)
  {
    words += (words.empty() ? "" : " together with ") + std::string(names[order[std::size_t(k)]]);
  }
  return words + ", " + fixedDigits(std::sqrt(std::max(0.0, spectrum.eigenvalues()(5))), 1) + " mm at " + fixedDigits(depthMm, 0) +
    " mm";
}

}  // namespace handeye
