// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

namespace handeye
{

struct SpinCalibrationOptions
{
  int minimumPoses = 20;
  /// Least turning (rad, root mean square) of the directions across the shaft: 0.3 is reached by spinning to and fro over 60 deg.
  double minimumSpin = 0.3;
  /// Largest wobble (rad, root mean square) of the shaft while it was spun, also as a share of the spin.
  double maximumWobble = 0.15;
  double maximumWobbleShare = 0.4;
  /// A pose is thrown out when its shaft is further from the mean than this multiple of the robust spread.
  double rejectionFactor = 4;

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

struct SpinCalibrationResult
{
  enum class Status
  {
    Ok,
    TooFewPoses,
    TooLittleSpin,    ///< the stylus was hardly turned
    NotOneAxis,       ///< it was tilted about as much as it was spun: there is no one axis
    UnclearDirection  ///< the tip lies across the axis: not spun about the shaft, or the tip of another stylus
  };

  Status status = Status::TooFewPoses;
  std::string message;                                                  ///< for a person
  Eigen::Vector3d shaft_Stylus = Eigen::Vector3d::Zero();               ///< unit, from the tip along the shaft
  Eigen::Isometry3d stylusTipToStylus = Eigen::Isometry3d::Identity();  ///< only if usable
  double shaftSigma = 0;                                                ///< rad, standard error of the shaft's direction
  double spin = 0;                    ///< rad, root mean square turning of the directions across the shaft
  double wobble = 0;                  ///< rad, root mean square of the shaft about its mean
  std::optional<double> tipToAxisMm;  ///< distance of the tip from the line about which the stylus turned, if that line stood still
  std::vector<int> used;              ///< indices into the poses, ascending
  std::vector<int> rejected;          ///< those of which the shaft points elsewhere, and those that repeat an earlier one

  bool isUsable() const { return status == Status::Ok; }
};

/// Finds the direction of a stylus' shaft from poses in which it is spun about it, as SlicerIGT's spin calibration does, and
/// with the known tip the whole frame of the tip.
///
/// Frames: stylusToTracker poses. Spinning about the shaft leaves stylusToTracker_i.linear() * shaft_Stylus where it is, so the
/// shaft is the direction that the rotations R_i spread least: the eigenvector of sum (R_i - mean R)^T (R_i - mean R) with the
/// smallest eigenvalue. Poses in which it points elsewhere are found by sample consensus on the axes of relative rotations of
/// two poses (deterministic), and left out.
///
/// p_Stylus = stylusTipToStylus * p_StylusTip: the origin is the tip, -Z runs from the tip along the shaft (the convention of
/// PLUS), X is the projection of that axis of the stylus which is most across the shaft, and Y completes a right-handed frame.
/// Spinning does not fix X: it is a convention, and stable.
///
/// @param stylusToTracker poses of one stylus, spun about its shaft, in a divot or in the fingers
/// @param tip_Stylus mm, from calibratePivot()
/// @throws std::invalid_argument if a number is not finite or the options do not check
/// Thread-safe.
[[nodiscard]] SpinCalibrationResult calibrateSpin(const std::vector<Eigen::Isometry3d>& stylusToTracker,
  const Eigen::Vector3d& tip_Stylus, const SpinCalibrationOptions& options = {});

/// The frame of a tip with -Z from it along a shaft; see calibrateSpin(). @param shaft_Stylus of any length but zero
Eigen::Isometry3d tipFrame(const Eigen::Vector3d& tip_Stylus, const Eigen::Vector3d& shaft_Stylus);

/// "ok", "too_few_poses", ...: the word that result files use.
std::string toString(SpinCalibrationResult::Status status);

}  // namespace handeye
