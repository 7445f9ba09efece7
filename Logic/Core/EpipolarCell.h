// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "EpipolarSearch.h"
#include "SmallSimplex.h"

namespace handeye
{

/// A small part of the search: rotations and the camera's centres that go with them.
struct EpipolarCell
{
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();       ///< R0 of p_Camera = R (p_Marker - c)
  double reachRad = 0;                                          ///< all R with R^T = exp(r) R0^T and |r| <= reach
  Eigen::Vector3d center_Marker = Eigen::Vector3d::Zero();      ///< middle of a box of centres, mm
  Eigen::Vector3d halfWidthsMm = Eigen::Vector3d::Constant(0);  ///< half its edges
};

/// Bounds a cell by what rotation and centre do together: where EpipolarProgram lets each ray go its own way, here all of them turn by
/// one r. The condition that an error is below e,
///
///     sin(e) cos(t) (v' - u') . b  >=  sqrt(sin(t)^2 - sin(e)^2) |(v' x u') . b|         2 t: the angle between v' and u'
///
/// is expanded about the middle of the cell to first order in r and c. What is left out (second order in r, and r times c) is bounded
/// and given to the condition, so that a cell that the linear program in the six unknowns excludes holds no solution below e. The
/// slack shrinks with the square of the cell, the one of EpipolarProgram with its size.
///
/// Internal; not thread-safe.
class EpipolarCellProgram
{
public:
  explicit EpipolarCellProgram(const std::vector<EpipolarPair>& pairs);

  /// Whether the cell holds no solution with all errors below the bound.
  bool excludes(const EpipolarCell& cell, double boundRad);

  /// Takes what has no solution with all errors below the bound off the box of centres.
  /// @return false if nothing is left: the cell holds no such solution
  bool narrow(EpipolarCell& cell, double boundRad);

  long long solvedCount() const { return solvedCount_; }

private:
  void expand(const EpipolarCell& cell, double boundRad);
  void addConditions(
    const EpipolarPair& pair, std::size_t i, const EpipolarCell& cell, const Eigen::Matrix3d& cameraToMarker, double boundRad);
  bool hasSolution();
  double largest(int unknown, int side);

  const std::vector<EpipolarPair>& pairs_;
  SmallSimplex<7> dual_;
  SmallSimplex<6> box_;  ///< without the first row
  int limits_ = 0;       ///< the first of the columns that keep the unknowns between -1 and 1
  long long solvedCount_ = 0;
};

}  // namespace handeye
