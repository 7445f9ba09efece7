// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "EpipolarSearch.h"

#include <memory>

class ClpSimplex;

namespace handeye
{

/// Whether a rotation has a camera centre for which all epipolar errors are below a bound: a linear program, solved by CLP.
/// Internal; not thread-safe.
///
/// max s  with  n_i . (t_i + (R_i - I) c) >= s  for all planes i and  |c_k| <= limit.  Its dual has four rows however many planes
/// there are, and is what is solved; c and s are its multipliers. The bound holds where s >= 0.
class EpipolarProgram
{
public:
  EpipolarProgram(const std::vector<EpipolarPair>& pairs, double limitMm);
  ~EpipolarProgram();

  /// @return a centre (mm, marker frame) if there is one, else nothing. Rays that come within twice the bound of being parallel
  ///         exclude nothing.
  std::optional<Eigen::Vector3d> solve(const Eigen::Matrix3d& markerToCamera, double boundRad);

  /// The least error that a rotation can have, to about a hundredth of it: between the bound that was refused and the error that
  /// the centre has.
  EpipolarSolution minimize(const Eigen::Matrix3d& markerToCamera, double startRad);

  long long solvedCount() const { return solvedCount_; }

private:
  void addPlanes(const EpipolarPair& pair, const Eigen::Matrix3d& cameraToMarker, double boundRad);

  const std::vector<EpipolarPair>& pairs_;
  double limit_;
  std::unique_ptr<ClpSimplex> simplex_;
  std::vector<double> costs_;     ///< of the dual's columns
  std::vector<double> elements_;  ///< four rows a column
  long long solvedCount_ = 0;
};

}  // namespace handeye
