// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "PointLineRegistration.h"

#include <vector>

namespace handeye
{

/// What one look at the pairs tells: all that their cost holds of the points and of the lines' directions. The pairs are taken in
/// blocks whose numbers lie side by side on the stack, so that the compiler takes several at once; nothing is allocated. Internal.
struct PointLineSums
{
  /// Sums of w V, V = I - d d^T packed as (xx, xy, xz, yy, yz, zz), times 1, x, y, z, xx, xy, xz, yy, yz, zz of the points
  /// relative to `centroid_Points`.
  Eigen::Matrix<double, 6, 10> products = Eigen::Matrix<double, 6, 10>::Zero();
  Eigen::Vector3d centroid_Points = Eigen::Vector3d::Zero();  ///< weighted
  double totalWeight = 0;
  bool hasCommonOrigin = true;
};

/// @throws std::invalid_argument naming the first pair that holds a number that is none, a direction of length zero or a weight
///         that is not positive
PointLineSums sumPairs(const std::vector<PointLinePair>& pairs);

/// Of moved points and their lines.
struct PointLineDistances
{
  double squaresMm2 = 0;    ///< sum of the squared distances
  std::size_t inFront = 0;  ///< points before the origin of their line, in its direction
};

/// @param distancesMm takes the distance of each point to its line; as long as the pairs
PointLineDistances measureDistances(const std::vector<PointLinePair>& pairs, const Eigen::Isometry3d& pointsToLines,
  bool haveCommonOrigin, std::vector<double>& distancesMm);

}  // namespace handeye
