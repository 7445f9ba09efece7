// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "PointLineSums.h"

#include <vector>

namespace handeye
{

/// The point-to-line cost with its translation eliminated: f(R) = r^T Q r + 2 q^T r + c, r = the columns of R, one below the other.
///
/// Points are taken relative to their centroid and lines relative to the point nearest to all of them, which keeps Q well scaled.
/// Lines that do not share an origin take two more passes over the pairs; nothing is allocated. Internal to the solver.
class PointLineQuadraticForm
{
public:
  using Vector9 = Eigen::Matrix<double, 9, 1>;
  using Matrix9 = Eigen::Matrix<double, 9, 9>;

  PointLineQuadraticForm(const std::vector<PointLinePair>& pairs, const PointLineSums& sums);

  /// False where the lines are parallel, so that no translation can be computed.
  bool determinesTranslation() const { return determinesTranslation_; }

  double cost(const Eigen::Matrix3d& rotation) const;

  /// The translation that is best for this rotation.
  Eigen::Vector3d translation(const Eigen::Matrix3d& rotation) const;
  Eigen::Isometry3d pointsToLines(const Eigen::Matrix3d& rotation) const;

  /// The local minimum that Newton's method reaches from a rotation (damped where the cost is not convex). Adds its steps to
  /// `steps`.
  Eigen::Matrix3d descend(const Eigen::Matrix3d& start, int& steps) const;

  /// The rotation nearest to the nine numbers that make the cost smallest without being a rotation: a start close to the global
  /// minimum where there are six points and more.
  Eigen::Matrix3d linearStart() const;

  /// Whether it is proven that a minimum is the global one and that no other comes near it: the Lagrangian with the multipliers of
  /// R^T R = I and R R^T = I is convex, and stays so when `gap` of its curvature is taken away. Says no more often than it must.
  bool isCertainlyGlobal(const Eigen::Matrix3d& minimum) const;

  /// The weighted information of motions about the points' centroid, see informationMatrix(), and the points' spread about it, both
  /// from the sums that the form is made of.
  Eigen::Matrix<double, 6, 6> centredInformation(const Eigen::Matrix3d& rotation) const;
  double spread() const;
  const Eigen::Vector3d& centroid_Points() const { return sums_.centroid_Points; }
  bool hasCommonOrigin() const { return sums_.hasCommonOrigin; }

private:
  void sumOffsets(const std::vector<PointLinePair>& pairs);
  void eliminateTranslation(const Eigen::Matrix3d& sum, const Eigen::Matrix<double, 3, 9>& moment);

  PointLineSums sums_;
  Matrix9 quadratic_ = Matrix9::Zero();
  Vector9 linear_ = Vector9::Zero();
  double constant_ = 0;
  Eigen::Matrix<double, 3, 9> rotationToTranslation_ = Eigen::Matrix<double, 3, 9>::Zero();
  Eigen::Vector3d linesCentre_ = Eigen::Vector3d::Zero();
  bool determinesTranslation_ = false;
};

}  // namespace handeye
