// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <vector>

namespace handeye
{

/// What registerLandmarks() consists of. Internal; all functions are thread-safe. Points are columns, mm.

struct LandmarkFit
{
  Eigen::Isometry3d modelToPhantom = Eigen::Isometry3d::Identity();
  double rmsMm = 0;  ///< root mean square residual, unweighted
};

/// The weighted least squares (Umeyama without scale). @param weights one per column, positive
LandmarkFit fitLandmarks(const Eigen::Matrix3Xd& model, const Eigen::Matrix3Xd& phantom, const Eigen::VectorXd& weights);

/// Whether the points lie on one line or in one place.
bool areCollinear(const Eigen::Matrix3Xd& points);

/// Another order of the touched points in which they fit.
struct LandmarkOrder
{
  std::vector<int> order;  ///< touched point order[i] belongs to landmark i
  double rmsMm = 0;
};

/// The orders, other than the given one, that fit within a root mean square distance, best first; at most two are kept. Pairs whose
/// distances differ too much are never tried together, so that few of the n! orders are.
std::vector<LandmarkOrder> findOrders(const Eigen::Matrix3Xd& model, const Eigen::Matrix3Xd& phantom, double largestRmsMm);

}  // namespace handeye
