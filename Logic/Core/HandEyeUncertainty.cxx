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

namespace
{

/// Tips that are closer than this are one place of the ball.
constexpr double SamePlaceMm = 2;
/// From the first of these multiples of the expected scatter on, a misfit is taken to be systematic; from the second on wholly.
constexpr double RandomMisfit = 1.25;
constexpr double SystematicMisfit = 2;

}  // namespace

std::vector<double> placeShares(const HandEyeSamples& samples, const std::vector<int>& used)
{
  std::vector<double> shares(samples.size(), 0);
  for (int i : used)
  {
    const auto isHere = [&](int k)
    { return (samples[std::size_t(k)].tip_Marker - samples[std::size_t(i)].tip_Marker).norm() < SamePlaceMm; };
    shares[std::size_t(i)] = 1 / double(std::count_if(used.begin(), used.end(), isHere));
  }
  return shares;
}

double estimateCovariance(
  const HandEyeSamples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, HandEyeCalibrationResult& result)
{
  std::vector<int> used;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    if (result.samples[i].used)
    {
      used.push_back(int(i));
    }
  }
  const std::vector<double> shares = placeShares(samples, used);
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  double squares = 0, places = 0;
  for (int i : used)
  {
    const HandEyeSample& sample = samples[std::size_t(i)];
    const double share = shares[std::size_t(i)];
    const Eye& eye = eyes[std::size_t(sample.eye)];
    const Eigen::Vector3d tip_Camera = result.markerToCamera * sample.tip_Marker;
    const double distance = distanceMm(sample, eyes, result.markerToCamera);
    const double misfit = result.samples[std::size_t(i)].residualMm / expectedMm(sample, distance, eyes, options);
    squares += share * misfit * misfit;
    places += share;
    Eigen::Matrix<double, 2, 3> byPoint;
    if (!eye.camera.project(eye.cameraToEye * tip_Camera, &byPoint).isUsable())
    {
      continue;
    }
    Eigen::Matrix<double, 3, 6> motion;
    motion << -skew(tip_Camera), Eigen::Matrix3d::Identity();
    const Eigen::Matrix<double, 2, 6> byPose =
      byPoint * eye.cameraToEye.linear() * motion / expectedPx(sample, distance, eyes, options);
    information += share * byPose.transpose() * byPose;
  }
  const double misfit = std::sqrt(squares / std::max(1.0, 2.0 * places - 6));
  const double systematic = std::clamp((misfit - RandomMisfit) / (SystematicMisfit - RandomMisfit), 0.0, 1.0);
  const double varianceFactor = std::max(1.0, misfit * misfit) * (1 + systematic * (places - 1));
  result.placeCount = int(std::lround(places));
  result.covariance = varianceFactor * information.inverse();
  return misfit;
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
