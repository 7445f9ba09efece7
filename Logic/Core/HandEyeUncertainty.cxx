// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeUncertainty.h"

#include "RigidTransform.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace handeye
{

double estimateCovariance(
  const HandEyeSamples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, HandEyeCalibrationResult& result)
{
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  double squares = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    if (!result.samples[i].used)
    {
      continue;
    }
    const Eye& eye = eyes[std::size_t(samples[i].eye)];
    const Eigen::Vector3d tip_Camera = result.markerToCamera * samples[i].tip_Marker;
    const double distance = distanceMm(samples[i], eyes, result.markerToCamera);
    const double misfit = result.samples[i].residualMm / expectedMm(samples[i], distance, eyes, options);
    squares += misfit * misfit;
    Eigen::Matrix<double, 2, 3> byPoint;
    if (!eye.camera.project(eye.cameraToEye * tip_Camera, &byPoint).isUsable())
    {
      continue;
    }
    Eigen::Matrix<double, 3, 6> motion;
    motion << -skew(tip_Camera), Eigen::Matrix3d::Identity();
    const Eigen::Matrix<double, 2, 6> byPose =
      byPoint * eye.cameraToEye.linear() * motion / expectedPx(samples[i], distance, eyes, options);
    information += byPose.transpose() * byPose;
  }
  const double freedoms = std::max(1.0, 2.0 * result.usedCount - 6);
  const double varianceFactor = std::max(1.0, squares / freedoms);
  result.covariance = varianceFactor * information.inverse();
  return std::sqrt(squares / freedoms);
}

PredictedError predictProjectionError(
  const Eigen::Matrix<double, 6, 6>& covariance, const Eye& eye, double nearestMm, double furthestMm)
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
    const CameraModel::Unprojection ray = eye.camera.unproject(pixel);
    if (!ray.isUsable())
    {
      continue;
    }
    const Eigen::Vector3d point_Eye = ray.ray_Camera * depth / ray.ray_Camera.z();
    const Eigen::Vector3d point_Camera = eye.cameraToEye.inverse() * point_Eye;
    Eigen::Matrix<double, 2, 3> byPoint;
    if (!eye.camera.project(point_Eye, &byPoint).isUsable())
    {
      continue;
    }
    Eigen::Matrix<double, 3, 6> motion;
    motion << -skew(point_Camera), Eigen::Matrix3d::Identity();
    const Eigen::Matrix<double, 2, 6> byPose = byPoint * eye.cameraToEye.linear() * motion;
    const double rms = std::sqrt(std::max(0.0, (byPose * covariance * byPose.transpose()).trace()));
    error.meanPx += rms;
    error.maximumPx = std::max(error.maximumPx, rms);
    ++count;
  }
  error.meanPx = count > 0 ? error.meanPx / count : std::numeric_limits<double>::infinity();
  return error;
}

}  // namespace handeye
