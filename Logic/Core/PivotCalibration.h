// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace handeye
{

/// How pivotCalibration() judges its poses.
struct PivotCalibrationOptions
{
  /// Fewer poses than this do not give a tip that can be trusted.
  int minimumPoses = 20;
  /// A pose is thrown out when its residual exceeds this multiple of the robust noise (per axis) of the poses that stay.
  double rejectionFactor = 4.0;
  /// Least turning that each direction of the tip needs, as a root mean square angle (rad): below it the tip is not determined.
  double minimumRotation = 0.07;
  /// Largest share of poses that may be thrown out before the recording itself is doubted (the divot moved, the wrong tool).
  double maximumRejectedShare = 0.4;
  /// Largest root mean square residual (mm) of a usable result.
  double maximumRmsMm = 3.0;
  /// Largest distance (mm) between where the tip stood in the first and in the second half of the poses.
  double maximumTipMotionMm = 0.5;
  /// Least and largest distance (mm) of the tip from the marker.
  double nearestTipMm = 5;
  double furthestTipMm = 1000;

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

struct PivotCalibrationResult
{
  enum class Status
  {
    Ok,
    TooFewPoses,
    RotationAboutOneAxis,  ///< the stylus was spun or swung about a single axis: the tip is free along it
    TooLittleRotation,     ///< the stylus was hardly turned
    TooManyRejected,       ///< no tip explains most of the poses: the divot moved, or another tool was recorded
    TipMoved,              ///< the tip stood somewhere else in the second half of the recording
    ImplausibleTip,        ///< the tip is nearer to or further from the marker than any stylus' is: other units, or inverted poses
    TooNoisy               ///< the residuals are larger than a tracked stylus can have
  };

  Status status = Status::TooFewPoses;
  std::string message;                                      ///< for a person: what was found or what to do
  Eigen::Vector3d tip_Stylus = Eigen::Vector3d::Zero();     ///< mm
  Eigen::Vector3d pivot_Tracker = Eigen::Vector3d::Zero();  ///< mm, where the tip stood
  double rmsMm = 0;                                         ///< root mean square of the residual lengths of the used poses
  double maximumMm = 0;                                     ///< largest residual length of the used poses
  Eigen::Matrix3d tipCovariance = Eigen::Matrix3d::Zero();  ///< of tip_Stylus, mm^2, from the residuals of the used poses
  Eigen::Vector3d rotationSpread =
    Eigen::Vector3d::Zero();        ///< root mean square turning (rad) of the three principal directions, ascending
  std::vector<double> residualsMm;  ///< one per pose given, used or not
  std::vector<int> used;            ///< indices into the poses, ascending
  std::vector<int> rejected;        ///< indices into the poses, ascending

  bool isUsable() const { return status == Status::Ok; }
};

/// Finds the tip of a stylus that turns about it.
///
/// Frames: stylusToTracker poses, mm. With the tip at rest, stylusToTracker_i * tip_Stylus = pivot_Tracker for every pose i, six
/// unknowns in 3 n equations. Poses that disagree are found by sample consensus on triples of poses (deterministic) and thrown out
/// by their residual against the noise of those that stay; the rest is solved by least squares.
///
/// The rotation is judged by how much each direction of the tip was moved by it, so that spinning about one axis does not pass,
/// whatever its angle.
///
/// @param stylusToTracker poses of one stylus
/// @throws std::invalid_argument if a pose is not finite or the options do not check
/// Thread-safe. Reference: Z. Yaniv, "Which pivot calibration?", SPIE 9415 (2015), the algebraic one-step method.
[[nodiscard]] PivotCalibrationResult calibratePivot(
  const std::vector<Eigen::Isometry3d>& stylusToTracker, const PivotCalibrationOptions& options = {});

/// "ok", "too_few_poses", ...: the word that result files use.
std::string toString(PivotCalibrationResult::Status status);

}  // namespace handeye
