// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The three classical methods. R is the rotation of a pose, t its translation, e = R tip + t - pivot.
#include "PivotMethods.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace handeye
{

namespace
{

constexpr int SphereIterations = 20;

/// Variance per axis of residuals with so many unknowns fitted.
double variance(double squares, std::size_t count, int unknowns)
{
  return squares / std::max(1.0, 3.0 * double(count) - unknowns);
}

double squaredResiduals(const PivotPoses& poses, const std::vector<int>& subset, const PivotSolution& solution)
{
  double squares = 0;
  for (int i : subset)
  {
    squares += (poses[std::size_t(i)] * solution.tip_Stylus - solution.pivot_Tracker).squaredNorm();
  }
  return squares;
}

Eigen::Matrix3d pseudoInverse(const Eigen::Matrix3d& symmetric)
{
  return symmetric.completeOrthogonalDecomposition().pseudoInverse();
}

/// The sphere through points in the linear least squares of |p|^2 - 2 p . center + const: (center, radius).
Eigen::Vector4d linearSphere(const PivotPoses& poses, const std::vector<int>& subset, const Eigen::Vector3d& mean)
{
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (int i : subset)
  {
    const Eigen::Vector3d marker = poses[std::size_t(i)].translation() - mean;
    const Eigen::Vector4d row(2 * marker.x(), 2 * marker.y(), 2 * marker.z(), 1);
    normal += row * row.transpose();
    right += row * marker.squaredNorm();
  }
  const Eigen::Vector4d solved = normal.completeOrthogonalDecomposition().solve(right);
  const Eigen::Vector3d center = solved.head<3>();
  Eigen::Vector4d sphere;
  sphere << center + mean, std::sqrt(std::max(0.0, solved(3) + center.squaredNorm()));
  return sphere;
}

std::uint64_t hashOf(const Eigen::Isometry3d& pose)
{
  std::uint64_t hash = 1469598103934665603U;
  for (const int entry : { 0, 1, 4, 6, 9, 12, 13, 14 })
  {
    std::uint64_t bits = 0;
    std::memcpy(&bits, pose.matrix().data() + entry, sizeof(bits));
    hash = (hash ^ (bits >> 17) ^ bits) * 1099511628211U;
  }
  return hash ^ (hash >> 29);
}

}  // namespace

bool isSamePose(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b)
{
  return std::memcmp(a.matrix().data(), b.matrix().data(), 16 * sizeof(double)) == 0;
}

void findRepeated(const PivotPoses& poses, std::vector<int>& different, std::vector<int>& repeated)
{
  std::size_t slots = 64;
  while (slots < 2 * poses.size())
  {
    slots *= 2;
  }
  std::vector<int> table(slots, -1);
  different.reserve(poses.size());
  for (int i = 0; i < int(poses.size()); ++i)
  {
    std::size_t slot = hashOf(poses[std::size_t(i)]) & (slots - 1);
    while (table[slot] >= 0 && !isSamePose(poses[std::size_t(table[slot])], poses[std::size_t(i)]))
    {
      slot = (slot + 1) & (slots - 1);
    }
    (table[slot] >= 0 ? repeated : different).push_back(i);
    table[slot] = table[slot] >= 0 ? table[slot] : i;
  }
}

void PivotSums::add(const Eigen::Isometry3d& stylusToTracker)
{
  if (count_ == 0)
  {
    origin_Tracker_ = stylusToTracker.translation();
  }
  const Eigen::Vector3d position = stylusToTracker.translation() - origin_Tracker_;
  count_ += 1;
  rotations_ += stylusToTracker.linear();
  products_ += stylusToTracker.linear().transpose() * stylusToTracker.linear();
  positions_ += position;
  turnedPositions_ += stylusToTracker.linear().transpose() * position;
  squares_ += position.squaredNorm();
}

Eigen::Matrix3d PivotSums::spread() const
{
  const Eigen::Matrix3d mean = rotations_ / count_;
  return products_ / count_ - mean.transpose() * mean;
}

PivotSolution PivotSums::solve() const
{
  const Eigen::Matrix3d meanRotation = rotations_ / count_;
  const Eigen::Vector3d meanPosition = positions_ / count_;
  const Eigen::Matrix3d normal = count_ * this->spread();
  const Eigen::Vector3d right = count_ * (meanRotation.transpose() * meanPosition) - turnedPositions_;
  PivotSolution solution;
  solution.tip_Stylus = normal.completeOrthogonalDecomposition().solve(right);
  const Eigen::Vector3d pivot = meanRotation * solution.tip_Stylus + meanPosition;
  solution.pivot_Tracker = pivot + origin_Tracker_;
  const double squares = std::max(0.0, squares_ - count_ * meanPosition.squaredNorm() - solution.tip_Stylus.dot(right));
  solution.tipCovariance = variance(squares, std::size_t(count_), 6) * pseudoInverse(normal);
  return solution;
}

std::optional<PivotSolution> solveTriple(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const Eigen::Isometry3d& c)
{
  // Below this share of a full turn's determinant, noise decides what comes out.
  constexpr double leastDeterminant = 1e-7;
  const Eigen::Matrix3d first = b.linear() - a.linear(), second = c.linear() - a.linear();
  const Eigen::Vector3d firstStep = b.translation() - a.translation(), secondStep = c.translation() - a.translation();
  Eigen::Matrix3d normal = first.transpose() * first;
  normal.noalias() += second.transpose() * second;
  Eigen::Vector3d right = first.transpose() * firstStep;
  right.noalias() += second.transpose() * secondStep;
  Eigen::Matrix3d inverse;
  double determinant = 0;
  bool invertible = false;
  normal.computeInverseAndDetWithCheck(inverse, determinant, invertible, leastDeterminant);
  if (!invertible)
  {
    return std::nullopt;
  }
  PivotSolution solution;
  solution.tip_Stylus = -(inverse * right);
  solution.pivot_Tracker = (a * solution.tip_Stylus + b * solution.tip_Stylus + c * solution.tip_Stylus) / 3;
  return solution;
}

PivotSolution solveOneStep(const PivotPoses& poses, const std::vector<int>& subset)
{
  PivotSums sums;
  for (int i : subset)
  {
    sums.add(poses[std::size_t(i)]);
  }
  PivotSolution solution = sums.solve();
  solution.tipCovariance =
    variance(squaredResiduals(poses, subset, solution), subset.size(), 6) * pseudoInverse(double(subset.size()) * sums.spread());
  return solution;
}

PivotSolution solveTwoStep(const PivotPoses& poses, const std::vector<int>& subset)
{
  // Pairs that are a half, a third and a fifth of the recording apart: far apart in orientation whatever the rhythm of the motion.
  const std::size_t count = subset.size();
  const std::size_t strides[] = { count / 2, count / 3, count / 5 };
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero(), meat = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero(), mean = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < count; ++k)
  {
    const Eigen::Isometry3d& pose = poses[std::size_t(subset[k])];
    Eigen::Matrix3d influence = Eigen::Matrix3d::Zero();  // of the residual of this pose on the right-hand side
    for (const std::size_t stride : strides)
    {
      const Eigen::Isometry3d& next = poses[std::size_t(subset[(k + stride) % count])];
      const Eigen::Isometry3d& previous = poses[std::size_t(subset[(k + count - stride) % count])];
      const Eigen::Matrix3d turned = next.linear() - pose.linear();
      normal += turned.transpose() * turned;
      right -= turned.transpose() * (next.translation() - pose.translation());
      influence += 2 * pose.linear() - next.linear() - previous.linear();
    }
    meat += influence.transpose() * influence;
  }
  PivotSolution solution;
  const Eigen::Matrix3d inverse = pseudoInverse(normal);
  solution.tip_Stylus = normal.completeOrthogonalDecomposition().solve(right);
  for (int i : subset)
  {
    mean += poses[std::size_t(i)] * solution.tip_Stylus / double(count);
  }
  solution.pivot_Tracker = mean;
  const Eigen::Matrix3d spread = inverse * meat;
  solution.tipCovariance = variance(squaredResiduals(poses, subset, solution), count, 6) * (spread * inverse);
  return solution;
}

PivotSolution solveSphereFit(const PivotPoses& poses, const std::vector<int>& subset)
{
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d meanTurn = Eigen::Matrix3d::Zero();  // of Tracker to Stylus
  for (int i : subset)
  {
    mean += poses[std::size_t(i)].translation() / double(subset.size());
    meanTurn += poses[std::size_t(i)].linear().transpose() / double(subset.size());
  }
  Eigen::Vector4d sphere = linearSphere(poses, subset, mean);
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  double squares = 0;
  for (int iteration = 0; iteration < SphereIterations; ++iteration)
  {
    normal.setZero();
    squares = 0;
    Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
    for (int i : subset)
    {
      const Eigen::Vector3d fromCenter = poses[std::size_t(i)].translation() - sphere.head<3>();
      const double distance = fromCenter.norm();
      if (distance == 0)
      {
        continue;
      }
      Eigen::Vector4d row;
      row << -fromCenter / distance, -1;
      const double residual = distance - sphere(3);
      normal += row * row.transpose();
      gradient += row * residual;
      squares += residual * residual;
    }
    const Eigen::Vector4d step = normal.completeOrthogonalDecomposition().solve(gradient);
    sphere -= step;
    if (!(step.norm() > 1e-12 * (1 + sphere(3))))
    {
      break;
    }
  }
  PivotSolution solution;
  solution.pivot_Tracker = sphere.head<3>();
  for (int i : subset)
  {
    solution.tip_Stylus += poses[std::size_t(i)].inverse(Eigen::Isometry) * solution.pivot_Tracker / double(subset.size());
  }
  // The centre's error reaches the tip through the mean rotation; the rest averages out over the poses.
  const double radialVariance = squares / std::max(1.0, double(subset.size()) - 4);
  const Eigen::Matrix4d sphereCovariance =
    radialVariance * Eigen::Matrix4d(normal.completeOrthogonalDecomposition().pseudoInverse());
  const Eigen::Matrix3d turnedCovariance = meanTurn * sphereCovariance.topLeftCorner<3, 3>();
  const double averaged = squaredResiduals(poses, subset, solution) / (3.0 * double(subset.size()) * double(subset.size()));
  solution.tipCovariance = turnedCovariance * meanTurn.transpose() + averaged * Eigen::Matrix3d::Identity();
  return solution;
}

}  // namespace handeye
