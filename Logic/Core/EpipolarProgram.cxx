// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EpipolarProgram.h"

#include <ClpSimplex.hpp>
#include <CoinPackedMatrix.hpp>

#include <cmath>
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
      dual_.add({ 1, -gradient.x(), -gradient.y(), -gradient.z() }, normal.dot(translation));
    }
  }
}

/// The dual. @return false where no plane says anything
bool EpipolarProgram::load(const Eigen::Matrix3d& markerToCamera, double boundRad)
{
  dual_.clear();
  const Eigen::Matrix3d cameraToMarker = markerToCamera.transpose();
  for (const EpipolarPair& pair : pairs_)
  {
    this->addPlanes(pair, cameraToMarker, std::min(boundRad, 1.57));
  }
  box_ = dual_.columnCount();
  for (int k = 0; k < 6; ++k)
  {
    dual_.add((k % 2 == 0 ? 1 : -1) * Eigen::Vector4d::Unit(1 + k / 2), limit_);
  }
  return box_ > 0;
}

std::optional<Eigen::Vector3d> EpipolarProgram::solve(const Eigen::Matrix3d& markerToCamera, double boundRad)
{
  using End = SmallSimplex<4>::End;
  if (!this->load(markerToCamera, boundRad))
  {
    return Eigen::Vector3d(Eigen::Vector3d::Zero());
  }
  ++solvedCount_;
  // One plane with the weight 1, and of the limits what it takes to balance it.
  Eigen::Index first = 0;
  dual_.costs().head(box_).minCoeff(&first);
  SmallSimplex<4>::Basis basis{ int(first), 0, 0, 0 };
  for (int k = 0; k < 3; ++k)
  {
    basis[std::size_t(1 + k)] = box_ + 2 * k + (dual_.columns()(1 + k, first) > 0 ? 1 : 0);
  }
  const End end = dual_.minimize(Eigen::Vector4d::UnitX(), basis, -Tolerance);
  if (end == End::NotDecided)
  {
    return solveByClp();
  }
  return end == End::Below ? std::nullopt : std::optional<Eigen::Vector3d>(UnitMm * dual_.multipliers().tail<3>());
}

std::optional<Eigen::Vector3d> EpipolarProgram::solveByClp()
{
  const int columns = dual_.columnCount();
  const Eigen::Matrix4Xd elements = dual_.columns();
  const Eigen::VectorXd costs = dual_.costs();
  std::vector<CoinBigIndex> starts(std::size_t(columns) + 1);
  std::vector<int> rows(std::size_t(4 * columns));
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
    true, 4, columns, CoinBigIndex(elements.size()), elements.data(), rows.data(), starts.data(), nullptr);
  simplex_->loadProblem(matrix, nullptr, nullptr, costs.data(), right, right);
  simplex_->primal();
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

/// max of each c_k and -c_k with  n_i . (t_i + (R_i - I) c) >= 0: the same columns without the first row, a unit vector on the right.
/// Begins with the limits as the basis, so that whatever is reached is a bound.
bool EpipolarProgram::boxOfCenters(
  const Eigen::Matrix3d& markerToCamera, double boundRad, Eigen::Vector3d& middle, Eigen::Vector3d& halfWidths)
{
  if (!this->load(markerToCamera, boundRad))
  {
    return true;
  }
  box3_.clear();
  for (int i = 0; i < dual_.columnCount(); ++i)
  {
    box3_.add(dual_.columns().col(i).tail<3>(), dual_.costs()(i));
  }
  Eigen::Vector3d low = middle - halfWidths, high = middle + halfWidths;
  for (int k = 0; k < 6; ++k)
  {
    const int side = k % 2 == 0 ? 1 : -1;
    SmallSimplex<3>::Basis basis{ box_, box_ + 2, box_ + 4 };
    basis[std::size_t(k / 2)] = box_ + k;
    (void)box3_.minimize(side * Eigen::Vector3d::Unit(k / 2), basis, -1e30);
    ++solvedCount_;
    if (std::isfinite(box3_.objective()))
    {
      const double reach = side * UnitMm * (box3_.objective() + Tolerance);
      double& end = side > 0 ? high(k / 2) : low(k / 2);
      end = side > 0 ? std::min(end, reach) : std::max(end, reach);
    }
  }
  middle = (low + high) / 2;
  halfWidths = (high - low) / 2;
  return halfWidths.minCoeff() >= 0;
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
