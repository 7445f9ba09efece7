// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointLineQuadraticForm.h"

#include "RigidTransform.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

using Vector9 = PointLineQuadraticForm::Vector9;
using Matrix9 = PointLineQuadraticForm::Matrix9;

constexpr int MaximumSteps = 60;
/// One step turns by this much (rad) at most.
constexpr double LongestTurn = 0.6;
/// Steps (rad) of the end of the descent, and of its last one: Newton's method squares the error with each.
constexpr double NearMinimum = 1e-7;
constexpr double Still = 1e-8;
/// A convex step may raise the cost by this share of the form's trace: the cost is not known better, the slope is.
constexpr double Rounding = 4e-16;
/// Another minimum is told apart if it is this share above the lowest one ...
constexpr double DistinctCost = 1e-4;
/// ... and its nine numbers are this far (squared) from those of the lowest one and of its negative; 0.02 is a turn of 6 degrees.
constexpr double DistinctDistance = 0.02;

Vector9 vec(const Eigen::Matrix3d& matrix)
{
  return Eigen::Map<const Vector9>(matrix.data());
}

Eigen::Matrix3d unvec(const Vector9& vector)
{
  return Eigen::Map<const Eigen::Matrix3d>(vector.data());
}

/// Cayley's map: the rotation by `turn` up to terms of the third order, without a sine.
Eigen::Matrix3d smallTurn(const Eigen::Vector3d& turn)
{
  const Eigen::Vector3d a = 0.5 * turn;
  const double scale = 2 / (1 + a.squaredNorm());
  Eigen::Matrix3d rotation = scale * a * a.transpose();
  rotation.diagonal().array() += 1 - scale * a.squaredNorm();
  rotation += scale * skew(a);
  return rotation;
}

/// One step of Newton's iteration towards the nearest rotation, for matrices that are one but for rounding.
Eigen::Matrix3d polish(const Eigen::Matrix3d& rotation)
{
  const Eigen::Matrix3d rest = 3 * Eigen::Matrix3d::Identity() - rotation.transpose() * rotation;
  return 0.5 * rotation * rest;
}

/// Newton's step; where the cost bends downwards, the size of its curvature still gives the length of a step downhill.
Eigen::Vector3d newtonStep(const Eigen::Matrix3d& hessian, const Eigen::Vector3d& gradient, double damping, bool& isConvex)
{
  // Leading minors: convex, and the step is a closed formula.
  const double minor = hessian(0, 0) * hessian(1, 1) - hessian(0, 1) * hessian(0, 1), determinant = hessian.determinant();
  const double scale = hessian.diagonal().cwiseAbs().maxCoeff();
  isConvex = hessian(0, 0) > 0 && minor > 0 && determinant > 1e-9 * scale * scale * scale;
  if (isConvex && damping == 0)
  {
    return -(hessian.inverse() * gradient);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spectrum(hessian);
  const double highest = spectrum.eigenvalues().cwiseAbs().maxCoeff();
  isConvex = spectrum.eigenvalues()(0) > 0;
  // A floor much higher than this would slow down the descent on points that are nearly on one line.
  const Eigen::Array3d curvature = spectrum.eigenvalues().array().abs().max(1e-12 * highest) + damping * highest + 1e-300;
  return -spectrum.eigenvectors() * ((spectrum.eigenvectors().transpose() * gradient).array() / curvature).matrix();
}

/// Cholesky's factors of a symmetric 9x9 matrix, where it has them.
class Cholesky9
{
public:
  explicit Cholesky9(const Matrix9& matrix)
  {
    for (int i = 0; i < 9 && isPositiveDefinite_; ++i)
    {
      for (int k = 0; k <= i; ++k)
      {
        double rest = matrix(k, i);
        for (int j = 0; j < k; ++j)
        {
          rest -= factor_[i][j] * factor_[k][j];
        }
        isPositiveDefinite_ = k < i || rest > 0;
        factor_[i][k] = k < i ? rest * factor_[k][k] : 1 / std::sqrt(rest);  // the diagonal holds its inverse
      }
    }
  }

  bool isPositiveDefinite() const { return isPositiveDefinite_; }

  void solveInPlace(Vector9& right) const
  {
    for (int i = 0; i < 9; ++i)
    {
      for (int k = 0; k < i; ++k)
      {
        right(i) -= factor_[i][k] * right(k);
      }
      right(i) *= factor_[i][i];
    }
    for (int i = 8; i >= 0; --i)
    {
      right(i) *= factor_[i][i];
      for (int k = 0; k < i; ++k)
      {
        right(k) -= factor_[i][k] * right(i);
      }
    }
  }

private:
  double factor_[9][9];
  bool isPositiveDefinite_ = true;
};

/// The second derivative of the Lagrangian: less A and B, the multipliers of the columns' and of the rows' products.
Matrix9 withMultipliers(const Matrix9& quadratic, const Eigen::Matrix3d& columns, const Eigen::Matrix3d& rows)
{
  Matrix9 lagrangian = quadratic;
  for (int a = 0; a < 3; ++a)
  {
    lagrangian.block<3, 3>(3 * a, 3 * a) -= rows;
    for (int b = 0; b < 3; ++b)
    {
      lagrangian.block<3, 3>(3 * a, 3 * b).diagonal().array() -= columns(a, b);
    }
  }
  return lagrangian;
}

/// The nearest rotation by Higham's iteration for the polar decomposition; near enough for a start.
Eigen::Matrix3d roughlyNearestRotation(Eigen::Matrix3d matrix)
{
  constexpr int rounds = 6;
  for (int round = 0; round < rounds; ++round)
  {
    Eigen::Matrix3d cofactors;
    cofactors << matrix.col(1).cross(matrix.col(2)), matrix.col(2).cross(matrix.col(0)), matrix.col(0).cross(matrix.col(1));
    const double determinant = matrix.col(0).dot(cofactors.col(0));
    const double size = matrix.norm();
    if (!(determinant > 1e-6 * size * size * size))
    {
      return nearestRotation(matrix);
    }
    const Eigen::Matrix3d inverse = cofactors / determinant;
    const double scale = std::sqrt(inverse.norm() / size);
    matrix = 0.5 * (scale * matrix + inverse / scale);
  }
  return polish(matrix);
}

}  // namespace

Eigen::Matrix3d PointLineQuadraticForm::descend(const Eigen::Matrix3d& start, int& steps) const
{
  Eigen::Matrix3d rotation = start;
  Vector9 slope = quadratic_ * vec(rotation) + linear_;  // half the gradient by vec(R)
  double current = vec(rotation).dot(slope + linear_) + constant_;
  double damping = 0;
  const double rounding = Rounding * quadratic_.trace();
  for (int step = 0; step < MaximumSteps; ++step)
  {
    ++steps;
    const Eigen::Matrix3d moment = unvec(slope) * rotation.transpose();
    const Eigen::Vector3d gradient(moment(2, 1) - moment(1, 2), moment(0, 2) - moment(2, 0), moment(1, 0) - moment(0, 1));
    Eigen::Matrix<double, 9, 3> tangent;  // skew(e_k) R
    for (int column = 0; column < 3; ++column)
    {
      tangent.block<3, 3>(3 * column, 0) = -skew(rotation.col(column));
    }
    // d2 exp(w) / dwj dwk at 0 is (Gj Gk + Gk Gj) / 2, and <slope, A R> = <slope R^T, A>: with M = slope R^T this sums to sym(M) -
    // tr(M) I.
    const Eigen::Matrix<double, 9, 3> curved = quadratic_ * tangent;
    Eigen::Matrix3d hessian = tangent.transpose() * curved + 0.5 * (moment + moment.transpose());
    hessian.diagonal().array() -= moment.trace();
    bool isConvex = false;
    Eigen::Vector3d turn = newtonStep(hessian, gradient, damping, isConvex);
    const double length = turn.norm();
    turn *= length > LongestTurn ? LongestTurn / length : 1.0;
    const Eigen::Matrix3d tried = smallTurn(turn) * rotation;
    const Vector9 triedSlope = quadratic_ * vec(tried) + linear_;
    const double triedCost = vec(tried).dot(triedSlope + linear_) + constant_;
    // So near to the minimum the cost is all rounding, but the slope is not.
    const bool isNear = length < NearMinimum && isConvex;
    if (isNear || triedCost <= current * (1 + 1e-14) + (isConvex ? rounding : 0))
    {
      rotation = tried;
      slope = triedSlope;
      current = triedCost;
      damping = damping > 1e-3 ? damping / 10 : 0;
      if (isNear && length < Still)
      {
        break;
      }
    }
    else if (length < NearMinimum)
    {
      break;
    }
    else
    {
      damping = damping > 0 ? 10 * damping : 1e-2;
    }
  }
  return polish(rotation);
}

Eigen::Matrix3d PointLineQuadraticForm::linearStart() const
{
  // Lines through one centre: the eigenvector of the smallest eigenvalue, by inverse iteration. Otherwise -Q^-1 q.
  constexpr int rounds = 3;
  Matrix9 regular = quadratic_;
  regular.diagonal().array() += 1e-9 * quadratic_.trace();
  const Cholesky9 factors(regular);
  if (!factors.isPositiveDefinite())
  {
    return Eigen::Matrix3d::Identity();
  }
  Vector9 r;
  if (linear_.squaredNorm() > 0)
  {
    r = -linear_;
    factors.solveInPlace(r);
  }
  else
  {
    r << 1, 0.3, -0.5, 0.7, -1.1, 0.2, -0.4, 0.9, 0.6;
    for (int round = 0; round < rounds; ++round)
    {
      factors.solveInPlace(r);
      r /= r.norm();
    }
  }
  Eigen::Matrix3d matrix = unvec(r);
  matrix *= matrix.determinant() < 0 ? -1.0 : 1.0;
  return roughlyNearestRotation(matrix);
}

bool PointLineQuadraticForm::isCertainlyGlobal(const Eigen::Matrix3d& minimum) const
{
  // The multipliers A of R^T R = I and B of R R^T = I satisfy slope = R A + B R; the share of A is free. Half is nearly always
  // right for many points; for few, the direction in which the Lagrangian bends down most says how to change it.
  constexpr int changes = 4;
  const Vector9 r = vec(minimum);
  const Vector9 slope = quadratic_ * r + linear_;
  const double cost = std::max(0.0, r.dot(slope + linear_) + constant_);
  const Eigen::Matrix3d moment = unvec(slope) * minimum.transpose(), both = 0.5 * (moment + moment.transpose());
  const double gap = DistinctCost / DistinctDistance * cost + 1e-14 * quadratic_.trace();
  // Of lines through one centre the Lagrangian is flat along the minimum itself: that direction is lifted.
  const double lift = linear_.isZero(0) ? quadratic_.trace() / 27 : 0;
  Matrix9 lifted = quadratic_;
  lifted.noalias() += (lift * r) * r.transpose();
  lifted.diagonal().array() -= gap;
  const Eigen::Matrix3d halfTurned = 0.5 * both * minimum;
  Eigen::Matrix3d columns = minimum.transpose() * halfTurned;
  for (int change = 0; true; ++change)
  {
    const Eigen::Matrix3d turned = minimum * columns, rows = both - turned * minimum.transpose();
    const Matrix9 lagrangian = withMultipliers(lifted, columns, rows);
    if (Cholesky9(lagrangian).isPositiveDefinite())
    {
      return true;
    }
    if (change == changes)
    {
      return false;
    }
    const Eigen::SelfAdjointEigenSolver<Matrix9> spectrum(lagrangian);
    const Eigen::Matrix3d lowest = unvec(spectrum.eigenvectors().col(0)), inPlace = minimum.transpose() * lowest;
    // How the lowest curvature changes with A; the step brings it to half a gap above zero, were it linear.
    const Eigen::Matrix3d ascent = inPlace * inPlace.transpose() - lowest.transpose() * lowest;
    columns += (0.5 * gap - spectrum.eigenvalues()(0)) / std::max(ascent.squaredNorm(), 1e-30) * ascent;
  }
}

}  // namespace handeye
