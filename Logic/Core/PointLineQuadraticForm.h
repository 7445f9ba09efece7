// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "PointLineRegistration.h"

#include <vector>

namespace handeye
{

/// The point-to-line cost with its translation eliminated: f(R) = r^T Q r + 2 q^T r + c, r = the columns of R, one below the other.
///
/// Internal to the solver. The points are taken relative to their centroid, which keeps Q well scaled.
class PointLineQuadraticForm
{
public:
  explicit PointLineQuadraticForm(const std::vector<PointLinePair>& pairs);

  /// False where the lines are parallel, so that no translation can be computed.
  bool determinesTranslation() const { return determinesTranslation_; }

  double cost(const Eigen::Matrix3d& rotation) const;

  /// The translation that is best for this rotation.
  Eigen::Vector3d translation(const Eigen::Matrix3d& rotation) const;

  /// The local minimum that Newton's method reaches from a rotation (damped where the cost is not convex). Adds its steps to
  /// `steps`.
  Eigen::Matrix3d descend(Eigen::Matrix3d rotation, int& steps) const;

private:
  using Vector9 = Eigen::Matrix<double, 9, 1>;

  Eigen::Matrix<double, 9, 9> quadratic_ = Eigen::Matrix<double, 9, 9>::Zero();
  Vector9 linear_ = Vector9::Zero();
  double constant_ = 0;
  Eigen::Matrix<double, 3, 9> rotationToTranslation_ = Eigen::Matrix<double, 3, 9>::Zero();
  Eigen::Vector3d translationOffset_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d centroid_ = Eigen::Vector3d::Zero();
  bool determinesTranslation_ = false;
};

}  // namespace handeye
