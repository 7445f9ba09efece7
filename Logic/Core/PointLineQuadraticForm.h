// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "PointLineRegistration.h"

#include <vector>

namespace handeye
{

/// What one look at the pairs tells. Internal.
struct PointLineSummary
{
  Eigen::Vector3d centroid_Points = Eigen::Vector3d::Zero();  ///< weighted
  double totalWeight = 0;
  bool hasCommonOrigin = true;
};

/// @throws std::invalid_argument naming the first pair that holds a number that is none
PointLineSummary summarizePairs(const std::vector<PointLinePair>& pairs);

/// The point-to-line cost with its translation eliminated: f(R) = r^T Q r + 2 q^T r + c, r = the columns of R, one below the other.
///
/// Points are taken relative to their centroid and lines relative to the point nearest to all of them, which keeps Q well scaled.
/// Built in one pass (two if the lines do not share an origin) over the pairs; nothing is allocated. Internal to the solver.
class PointLineQuadraticForm
{
public:
  using Vector9 = Eigen::Matrix<double, 9, 1>;
  using Matrix9 = Eigen::Matrix<double, 9, 9>;

  PointLineQuadraticForm(const std::vector<PointLinePair>& pairs, const PointLineSummary& summary);

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
  const Eigen::Vector3d& centroid_Points() const { return centroid_; }

private:
  using Products = Eigen::Matrix<double, 6, 10>;

  void sumProducts(const std::vector<PointLinePair>& pairs);
  void sumOffsets(const std::vector<PointLinePair>& pairs);
  void eliminateTranslation(const Eigen::Matrix3d& sum, const Eigen::Matrix<double, 3, 9>& moment);

  /// Sums of w V, packed as (xx, xy, xz, yy, yz, zz), times 1, x, y, z, xx, xy, xz, yy, yz, zz of the centred points.
  Products products_ = Products::Zero();
  double totalWeight_ = 0;
  Matrix9 quadratic_ = Matrix9::Zero();
  Vector9 linear_ = Vector9::Zero();
  double constant_ = 0;
  Eigen::Matrix<double, 3, 9> rotationToTranslation_ = Eigen::Matrix<double, 3, 9>::Zero();
  Eigen::Vector3d linesCentre_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d centroid_ = Eigen::Vector3d::Zero();
  bool determinesTranslation_ = false;
};

}  // namespace handeye
