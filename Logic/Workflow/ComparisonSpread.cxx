// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComparisonSpread.h"

#include "RigidTransform.h"

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

/// Squared distances of the projections of one ball from their mean, px^2; empty where one calibration does not see it.
std::vector<double> scatterOfBall(
  const std::vector<Eigen::Isometry3d>& markerToCamera, const Eigen::Vector3d& tip_Marker, const CameraModel& camera)
{
  std::vector<Eigen::Vector2d> places;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Isometry3d& calibration : markerToCamera)
  {
    const CameraModel::Projection seen = camera.project(calibration * tip_Marker);
    if (!seen.isUsable())
    {
      return {};
    }
    places.push_back(seen.point_Image);
    mean += seen.point_Image / double(markerToCamera.size());
  }
  std::vector<double> squares;
  for (const Eigen::Vector2d& place : places)
  {
    squares.push_back((place - mean).squaredNorm());
  }
  return squares;
}

}  // namespace

void measureSpread(const std::vector<Eigen::Isometry3d>& markerToCamera, const std::vector<HandEyeSample>& validation,
  const CameraModel& camera, Repeatability& result)
{
  result.calibrations = int(markerToCamera.size());
  if (result.calibrations < 2)
  {
    return;
  }
  const double freedoms = result.calibrations - 1;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d meanTranslation = Eigen::Vector3d::Zero();
  for (const Eigen::Isometry3d& calibration : markerToCamera)
  {
    sum += calibration.linear();
    meanTranslation += calibration.translation() / double(result.calibrations);
  }
  const Eigen::Matrix3d meanRotation = nearestRotation(sum);
  double turned = 0, moved = 0;
  for (const Eigen::Isometry3d& calibration : markerToCamera)
  {
    turned += std::pow(rotationAngle(calibration.linear() * meanRotation.transpose()), 2);
    moved += (calibration.translation() - meanTranslation).squaredNorm();
  }
  result.rotationDeg = std::sqrt(turned / freedoms) * 180 / EIGEN_PI;
  result.translationMm = std::sqrt(moved / freedoms);
  double squares = 0;
  int balls = 0;
  for (const HandEyeSample& sample : validation)
  {
    const std::vector<double> scatter = scatterOfBall(markerToCamera, sample.tip_Marker, camera);
    balls += scatter.empty() ? 0 : 1;
    for (const double square : scatter)
    {
      squares += square / freedoms;
      result.worstPx = std::max(result.worstPx, std::sqrt(square));
    }
  }
  result.projectionPx = balls > 0 ? std::sqrt(squares / balls) : 0;
}

}  // namespace handeye
