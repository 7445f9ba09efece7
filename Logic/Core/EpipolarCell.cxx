// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EpipolarCell.h"

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

constexpr int Unknowns = 6;  ///< r over the reach, the centre over the box's half widths: each from -1 to 1
constexpr int Rows = 1 + Unknowns;
/// A program that falls short by less is taken for feasible, so that nothing is excluded by rounding. Conditions are of the size of 1.
constexpr double Tolerance = 1e-7;

Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v)
{
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

}  // namespace

EpipolarCellProgram::EpipolarCellProgram(const std::vector<EpipolarPair>& pairs)
  : pairs_(pairs)
{
}

/// Both signs of the condition of one correspondence, divided by the largest baseline:  g . y + g0 + slack >= 0  with  y  the unknowns.
void EpipolarCellProgram::addConditions(
  const EpipolarPair& pair, std::size_t i, const EpipolarCell& cell, const Eigen::Matrix3d& cameraToMarker, double boundRad)
{
  const double d = cell.reachRad;
  const Eigen::Vector3d u = pair.marker.linear() * (cameraToMarker * pair.rays_Cameras[i].first);
  const Eigen::Vector3d v = cameraToMarker * pair.rays_Cameras[i].second;
  const Eigen::Vector3d difference = v - u, normal = v.cross(u);
  const double half = std::asin(std::min(1.0, difference.norm() / 2));
  const double leastHalf = std::max(0.0, half - d);  // both rays turn by up to d
  const double byDifference = std::sin(boundRad) * std::cos(leastHalf);
  const double byNormal = std::sqrt(std::max(0.0, std::pow(std::sin(leastHalf), 2) - std::pow(std::sin(boundRad), 2)));
  if (!(byNormal > 0))
  {
    return;  // rays that may be parallel say nothing
  }
  const Eigen::Matrix3d byCenter = pair.marker.linear() - Eigen::Matrix3d::Identity();
  const Eigen::Vector3d baseline = pair.marker * cell.center_Marker - cell.center_Marker;
  const double longest = baseline.norm() + byCenter.colwise().norm().dot(cell.halfWidthsMm);
  // What r does to v' - u' and v' x u', to first order.
  const Eigen::Matrix3d crossU = crossMatrix(u), crossV = crossMatrix(v);
  const Eigen::Matrix3d turnDifference = crossU * pair.marker.linear() - crossV;
  const Eigen::Matrix3d turnNormal = crossU * crossV - crossV * crossU * pair.marker.linear();
  const double second = byDifference * d * d + byNormal * (2 * d * d + d * d * d + d * d * d * d / 4);
  for (const int side : { -1, 1 })
  {
    const Eigen::Vector3d whole = byDifference * difference + side * byNormal * normal;
    const Eigen::Matrix3d turned = byDifference * turnDifference + side * byNormal * turnNormal;
    const Eigen::Vector3d byTurn = d * turned.transpose() * baseline;
    const Eigen::Vector3d byShift = cell.halfWidthsMm.cwiseProduct(byCenter.transpose() * whole);
    const double mixed = d * (byCenter.transpose() * turned).rowwise().norm().dot(cell.halfWidthsMm);
    Eigen::Matrix<double, Rows, 1> column;
    column << 1, -byTurn / longest, -byShift / longest;
    dual_.add(column, (whole.dot(baseline) + mixed) / longest + second);
  }
}

void EpipolarCellProgram::expand(const EpipolarCell& cell, double boundRad)
{
  dual_.clear();
  const Eigen::Matrix3d cameraToMarker = cell.rotation.transpose();
  for (const EpipolarPair& pair : pairs_)
  {
    for (std::size_t i = 0; i < pair.rays_Cameras.size(); ++i)
    {
      addConditions(pair, i, cell, cameraToMarker, boundRad);
    }
  }
  limits_ = dual_.columnCount();
  for (int k = 0; k < 2 * Unknowns; ++k)
  {
    dual_.add((k % 2 == 0 ? 1 : -1) * Eigen::Matrix<double, Rows, 1>::Unit(1 + k / 2), 1);
  }
}

/// max s  with  g_i . y + g0_i + slack_i >= s  and  |y_k| <= 1: there is a solution where s >= 0. Solved as its dual, whose first row
/// says that the multipliers add up to 1.
bool EpipolarCellProgram::hasSolution()
{
  if (limits_ == 0)
  {
    return true;
  }
  Eigen::Index first = 0;
  dual_.costs().head(limits_).minCoeff(&first);
  SmallSimplex<Rows>::Basis basis{ int(first) };
  for (int k = 0; k < Unknowns; ++k)
  {
    basis[std::size_t(1 + k)] = limits_ + 2 * k + (dual_.columns()(1 + k, first) > 0 ? 1 : 0);
  }
  ++solvedCount_;
  return dual_.minimize(Eigen::Matrix<double, Rows, 1>::UnitX(), basis, -Tolerance) != SmallSimplex<Rows>::End::Below;
}

/// A bound of y_k (or -y_k) with all conditions: 1, as before, where the dual says nothing.
double EpipolarCellProgram::largest(int unknown, int side)
{
  SmallSimplex<Unknowns>::Basis basis{};
  for (int k = 0; k < Unknowns; ++k)
  {
    basis[std::size_t(k)] = limits_ + 2 * k + (k == unknown && side < 0 ? 1 : 0);
  }
  (void)box_.minimize(side * Eigen::Matrix<double, Unknowns, 1>::Unit(unknown), basis, -1e30);
  ++solvedCount_;
  return std::min(1.0, box_.objective() + Tolerance);
}

bool EpipolarCellProgram::excludes(const EpipolarCell& cell, double boundRad)
{
  expand(cell, boundRad);
  return !hasSolution();
}

bool EpipolarCellProgram::narrow(EpipolarCell& cell, double boundRad)
{
  constexpr int mostRounds = 4;
  for (int round = 0; round < mostRounds; ++round)
  {
    expand(cell, boundRad);
    if (!hasSolution())
    {
      return false;
    }
    box_.clear();
    for (int i = 0; i < dual_.columnCount(); ++i)
    {
      box_.add(dual_.columns().col(i).tail<Unknowns>(), dual_.costs()(i));
    }
    Eigen::Vector3d low, high;
    for (int k = 0; k < 3; ++k)
    {
      high(k) = largest(3 + k, 1);
      low(k) = -largest(3 + k, -1);
    }
    if ((high - low).minCoeff() < 0)
    {
      return false;  // by more than rounding: each was given its tolerance
    }
    const Eigen::Vector3d middle = (high + low) / 2, half = (high - low) / 2;
    cell.center_Marker += cell.halfWidthsMm.cwiseProduct(middle);
    cell.halfWidthsMm = cell.halfWidthsMm.cwiseProduct(half);
    if (half.minCoeff() > 0.7)
    {
      break;
    }
  }
  return true;
}

}  // namespace handeye
