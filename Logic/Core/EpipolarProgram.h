// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "EpipolarSearch.h"
#include "SmallSimplex.h"

#include <memory>

class ClpSimplex;

namespace handeye
{

/// Whether a rotation has a camera centre for which all epipolar errors are below a bound: a linear program. Internal; not thread-safe.
///
/// max s  with  n_i . (t_i + (R_i - I) c) >= s  for all planes i and  |c_k| <= limit.  Its dual has four rows however many planes
/// there are, and is what is solved; c and s are its multipliers. The bound holds where s >= 0. SmallSimplex mostly decides that; where
/// it does not, CLP does.
class EpipolarProgram
{
public:
  EpipolarProgram(const std::vector<EpipolarPair>& pairs, double limitMm);
  ~EpipolarProgram();

  /// @return a centre (mm, marker frame) if there is one, else nothing. Rays that come within twice the bound of being parallel
  ///         exclude nothing.
  std::optional<Eigen::Vector3d> solve(const Eigen::Matrix3d& markerToCamera, double boundRad);

  /// A box (mm, marker frame) that holds all centres for which solve() would find the bound kept; nothing if there are none.
  /// @param box middle and half widths: what is known already, and what comes out
  bool boxOfCenters(const Eigen::Matrix3d& markerToCamera, double boundRad, Eigen::Vector3d& middle, Eigen::Vector3d& halfWidths);

  /// The least error that a rotation can have, to about a hundredth of it: between the bound that was refused and the error that
  /// the centre has.
  EpipolarSolution minimize(const Eigen::Matrix3d& markerToCamera, double startRad);

  long long solvedCount() const { return solvedCount_; }

private:
  bool load(const Eigen::Matrix3d& markerToCamera, double boundRad);
  std::optional<Eigen::Vector3d> solveByClp();
  void addPlanes(const EpipolarPair& pair, const Eigen::Matrix3d& cameraToMarker, double boundRad);

  const std::vector<EpipolarPair>& pairs_;
  double limit_;
  SmallSimplex<4> dual_;
  SmallSimplex<3> box3_;
  int box_ = 0;  ///< the first of the dual's columns for the limit of c: +x, -x, +y, ...
  std::unique_ptr<ClpSimplex> simplex_;
  long long solvedCount_ = 0;
};

}  // namespace handeye
