// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointLineQuadraticForm.h"

#include "RigidTransform.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>

namespace handeye
{

namespace
{

using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix39 = Eigen::Matrix<double, 3, 9>;

constexpr int MaximumSteps = 60;
/// One step turns by this much (rad) at most.
constexpr double LongestTurn = 0.6;
/// Steps (rad) of the end of the descent, and of its last one.
constexpr double NearMinimum = 1e-7;
constexpr double Still = 1e-9;

/// The 3x9 matrix with R x = expand(x) * vec(R).
Matrix39 expand(const Eigen::Vector3d& point)
{
  Matrix39 matrix;
  matrix << point.x() * Eigen::Matrix3d::Identity(), point.y() * Eigen::Matrix3d::Identity(),
    point.z() * Eigen::Matrix3d::Identity();
  return matrix;
}

Vector9 vec(const Eigen::Matrix3d& matrix)
{
  return Eigen::Map<const Vector9>(matrix.data());
}

Eigen::Matrix3d unvec(const Vector9& vector)
{
  return Eigen::Map<const Eigen::Matrix3d>(vector.data());
}

Eigen::Matrix3d projectorOff(const Eigen::Vector3d& direction)
{
  const Eigen::Vector3d unit = direction.normalized();
  return Eigen::Matrix3d::Identity() - unit * unit.transpose();
}

}  // namespace

PointLineQuadraticForm::PointLineQuadraticForm(const std::vector<PointLinePair>& pairs)
{
  double totalWeight = 0;
  for (const PointLinePair& pair : pairs)
  {
    centroid_ += pair.weight * pair.point_Points;
    totalWeight += pair.weight;
  }
  centroid_ /= totalWeight;

  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Matrix39 moment = Matrix39::Zero();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  for (const PointLinePair& pair : pairs)
  {
    const Eigen::Matrix3d weighted = pair.weight * projectorOff(pair.direction_Lines);
    sum += weighted;
    moment += weighted * expand(pair.point_Points - centroid_);
    offset += weighted * pair.origin_Lines;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spectrum(sum);
  determinesTranslation_ = spectrum.eigenvalues()(0) > 1e-12 * totalWeight;
  if (!determinesTranslation_)
  {
    return;
  }
  const Eigen::Matrix3d inverse = sum.inverse();
  rotationToTranslation_ = -inverse * moment;
  translationOffset_ = inverse * offset;
  for (const PointLinePair& pair : pairs)
  {
    const Eigen::Matrix3d weighted = pair.weight * projectorOff(pair.direction_Lines);
    const Matrix39 slope = expand(pair.point_Points - centroid_) + rotationToTranslation_;
    const Eigen::Vector3d rest = translationOffset_ - pair.origin_Lines;
    quadratic_ += slope.transpose() * weighted * slope;
    linear_ += slope.transpose() * (weighted * rest);
    constant_ += rest.dot(weighted * rest);
  }
}

double PointLineQuadraticForm::cost(const Eigen::Matrix3d& rotation) const
{
  const Vector9 r = vec(rotation);
  return r.dot(quadratic_ * r) + 2 * linear_.dot(r) + constant_;
}

Eigen::Vector3d PointLineQuadraticForm::translation(const Eigen::Matrix3d& rotation) const
{
  return rotationToTranslation_ * vec(rotation) + translationOffset_ - rotation * centroid_;
}

Eigen::Matrix3d PointLineQuadraticForm::descend(Eigen::Matrix3d rotation, int& steps) const
{
  static const std::array<Eigen::Matrix3d, 3> generators = { skew(Eigen::Vector3d::UnitX()), skew(Eigen::Vector3d::UnitY()),
    skew(Eigen::Vector3d::UnitZ()) };
  double current = cost(rotation);
  double damping = 0;
  for (int step = 0; step < MaximumSteps; ++step)
  {
    ++steps;
    const Vector9 slope = quadratic_ * vec(rotation) + linear_;  // half the gradient by vec(R)
    const Eigen::Matrix3d slopeMatrix = unvec(slope) * rotation.transpose();
    Eigen::Matrix<double, 9, 3> tangent;
    for (int k = 0; k < 3; ++k)
    {
      tangent.col(k) = vec(generators[k] * rotation);
    }
    const Eigen::Vector3d gradient = tangent.transpose() * slope;
    // d2 exp(w) / dwj dwk at 0 is (Gj Gk + Gk Gj) / 2, and <slope, A R> = <slope R^T, A>: with M = slope R^T this sums to sym(M) -
    // tr(M) I.
    Eigen::Matrix3d hessian = tangent.transpose() * quadratic_ * tangent + (slopeMatrix + slopeMatrix.transpose()) / 2 -
      slopeMatrix.trace() * Eigen::Matrix3d::Identity();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spectrum(hessian);
    const double lowest = spectrum.eigenvalues()(0), highest = spectrum.eigenvalues().cwiseAbs().maxCoeff();
    // Where the cost bends downwards its size still gives the length of a step, downhill. A floor much higher than this would slow
    // down the descent on points that are nearly on one line.
    const Eigen::Array3d curvature = spectrum.eigenvalues().array().abs().max(1e-12 * highest) + damping * highest + 1e-300;
    Eigen::Vector3d turn =
      -spectrum.eigenvectors() * ((spectrum.eigenvectors().transpose() * gradient).array() / curvature).matrix();
    turn *= std::min(1.0, LongestTurn / std::max(turn.norm(), 1e-300));
    const Eigen::Matrix3d tried = rotationFromVector(turn) * rotation;
    const double triedCost = cost(tried);
    // So near to the minimum the cost is all rounding, but the slope is not.
    const bool isNear = turn.norm() < NearMinimum && lowest > 0;
    if (isNear || triedCost <= current * (1 + 1e-14))
    {
      rotation = nearestRotation(tried);
      current = triedCost;
      damping = damping > 1e-3 ? damping / 10 : 0;
      if (isNear && turn.norm() < Still)
      {
        return rotation;
      }
    }
    else if (turn.norm() < NearMinimum)
    {
      return rotation;
    }
    else
    {
      damping = damping > 0 ? 10 * damping : 1e-2;
    }
  }
  return rotation;
}

}  // namespace handeye
