// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EpipolarProgram.h"

#include <ClpSimplex.hpp>
#include <CoinPackedMatrix.hpp>

#include <numeric>

namespace handeye
{

namespace
{

constexpr double UnitMm = 100;
/// A program that falls short by less than this (in the unit above) is taken for feasible: CLP's own tolerance, so that nothing is
/// excluded by rounding.
constexpr double Tolerance = 1e-7;

/// The two rays of a correspondence in the second marker's frame.
struct RayPair
{
  RayPair(const EpipolarPair& pair, std::size_t i, const Eigen::Matrix3d& cameraToMarker)
    : first(pair.marker.linear() * (cameraToMarker * pair.rays_Cameras[i].first))
    , second(cameraToMarker * pair.rays_Cameras[i].second)
  {
    const Eigen::Vector3d difference = second - first, normal = second.cross(first);
    sineOfHalf = difference.norm() / 2;
    if (sineOfHalf > 1e-9 && normal.norm() > 1e-12)
    {
      between = difference.normalized();
      across = normal.normalized();
    }
  }

  Eigen::Vector3d first;
  Eigen::Vector3d second;
  double sineOfHalf = 0;                              ///< of half the angle between them
  Eigen::Vector3d between = Eigen::Vector3d::Zero();  ///< the middle of second and -first
  Eigen::Vector3d across = Eigen::Vector3d::Zero();   ///< the normal of both
};

}  // namespace

double epipolarErrorRad(
  const std::vector<EpipolarPair>& pairs, const Eigen::Matrix3d& markerToCamera, const Eigen::Vector3d& center_Marker)
{
  const Eigen::Matrix3d cameraToMarker = markerToCamera.transpose();
  double sine = 0;
  for (const EpipolarPair& pair : pairs)
  {
    const Eigen::Vector3d baseline = pair.marker * center_Marker - center_Marker;
    for (std::size_t i = 0; i < pair.rays_Cameras.size(); ++i)
    {
      const RayPair rays(pair, i, cameraToMarker);
      const double along = rays.between.dot(baseline), across = rays.across.dot(baseline);
      const double length = std::hypot(along, across);
      sine = std::max(sine, along > 0 && length > 0 ? rays.sineOfHalf * std::abs(across) / length : rays.sineOfHalf);
    }
  }
  return std::asin(std::min(1.0, sine));
}

EpipolarProgram::EpipolarProgram(const std::vector<EpipolarPair>& pairs, double limitMm)
  : pairs_(pairs)
  , limit_(limitMm / UnitMm)
  , simplex_(std::make_unique<ClpSimplex>())
{
  simplex_->setLogLevel(0);
}

EpipolarProgram::~EpipolarProgram() = default;

/// The planes through the baseline's origin that touch both cones have normals  n = a between +- sqrt(1 - a^2) across  with
/// a = sin(bound) / sin(half the angle): n . v' = -n . u' = sin(bound).
void EpipolarProgram::addPlanes(const EpipolarPair& pair, const Eigen::Matrix3d& cameraToMarker, double boundRad)
{
  const Eigen::Vector3d translation = pair.marker.translation() / UnitMm;
  const Eigen::Matrix3d byCenter = pair.marker.linear() - Eigen::Matrix3d::Identity();
  for (std::size_t i = 0; i < pair.rays_Cameras.size(); ++i)
  {
    const RayPair rays(pair, i, cameraToMarker);
    const double a = std::sin(boundRad) / std::max(rays.sineOfHalf, 1e-12);
    if (!(a < 1) || rays.across.isZero())
    {
      continue;
    }
    for (const int side : { -1, 1 })
    {
      const Eigen::Vector3d normal = a * rays.between + side * std::sqrt(1 - a * a) * rays.across;
      const Eigen::Vector3d gradient = byCenter.transpose() * normal;
      costs_.push_back(normal.dot(translation));
      elements_.insert(elements_.end(), { 1, -gradient.x(), -gradient.y(), -gradient.z() });
    }
  }
}

std::optional<Eigen::Vector3d> EpipolarProgram::solve(const Eigen::Matrix3d& markerToCamera, double boundRad)
{
  costs_.clear();
  elements_.clear();
  const Eigen::Matrix3d cameraToMarker = markerToCamera.transpose();
  for (const EpipolarPair& pair : pairs_)
  {
    this->addPlanes(pair, cameraToMarker, std::min(boundRad, 1.57));
  }
  if (costs_.empty())
  {
    return Eigen::Vector3d(Eigen::Vector3d::Zero());
  }
  for (int k = 0; k < 6; ++k)
  {
    double column[4] = { 0, 0, 0, 0 };
    column[1 + k / 2] = k % 2 == 0 ? 1 : -1;
    costs_.push_back(limit_);
    elements_.insert(elements_.end(), column, column + 4);
  }
  const int columns = int(costs_.size());
  std::vector<CoinBigIndex> starts(std::size_t(columns) + 1);
  std::vector<int> rows(elements_.size());
  for (int i = 0; i <= columns; ++i)
  {
    starts[std::size_t(i)] = 4 * i;
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    rows[i] = int(i % 4);
  }
  const double right[4] = { 1, 0, 0, 0 };
  const CoinPackedMatrix matrix(
    true, 4, columns, CoinBigIndex(elements_.size()), elements_.data(), rows.data(), starts.data(), nullptr);
  simplex_->loadProblem(matrix, nullptr, nullptr, costs_.data(), right, right);
  simplex_->primal();
  ++solvedCount_;
  if (simplex_->status() != 0)
  {
    return Eigen::Vector3d(Eigen::Vector3d::Zero());  // not decided: nothing may be excluded
  }
  if (simplex_->objectiveValue() < -Tolerance)
  {
    return std::nullopt;
  }
  const double* multipliers = simplex_->getRowPrice();
  return Eigen::Vector3d(UnitMm * Eigen::Vector3d(multipliers[1], multipliers[2], multipliers[3]));
}

EpipolarSolution EpipolarProgram::minimize(const Eigen::Matrix3d& markerToCamera, double startRad)
{
  EpipolarSolution best;
  best.markerToCamera = markerToCamera;
  best.errorRad = std::numeric_limits<double>::infinity();
  double refused = 0, bound = startRad;
  for (int step = 0; step < 40 && !(best.errorRad - refused < 0.01 * best.errorRad) && bound > 1e-10; ++step)
  {
    const std::optional<Eigen::Vector3d> center = this->solve(markerToCamera, bound);
    if (center)
    {
      const double error = epipolarErrorRad(pairs_, markerToCamera, *center);
      if (error < best.errorRad)
      {
        best.errorRad = error;
        best.center_Marker = *center;
      }
    }
    else
    {
      refused = bound;
    }
    if (center && best.errorRad > 1.05 * bound)
    {
      break;  // rays too close to parallel to say anything: as good as it gets
    }
    bound = std::isfinite(best.errorRad) ? (refused + best.errorRad) / 2 : 2 * bound;
    if (bound > 1.6)
    {
      break;
    }
  }
  return best;
}

}  // namespace handeye
