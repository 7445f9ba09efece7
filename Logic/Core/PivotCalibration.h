// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace handeye
{

/// How the tip is computed from the poses.
enum class PivotMethod
{
  Robust,            ///< sample consensus, then maximum likelihood under the tracker's noise; poses that disagree are left out
  AlgebraicOneStep,  ///< least squares for tip and pivot point together
  AlgebraicTwoStep,  ///< the pivot point cancels in differences of poses: the tip first, then the pivot point
  SphereFit          ///< the marker's positions lie on a sphere about the pivot point; orientations give the tip only
};

/// What the tracker is expected to add to a pose, per axis: to the marker's position, and about it. Only the ratio of the two
/// decides how poses are weighted; the level is estimated from the poses.
struct TrackerNoise
{
  double positionMm = 0.12;
  double rotation = double(0.025 * EIGEN_PI / 180);  ///< rad

  static TrackerNoise fromDegrees(double positionMm, double rotationDeg)
  {
    return { positionMm, double(rotationDeg * EIGEN_PI / 180) };
  }
};

/// How calibratePivot() judges its poses.
struct PivotCalibrationOptions
{
  PivotMethod method = PivotMethod::Robust;
  TrackerNoise noise;
  /// Fewer different poses than this do not give a tip that can be trusted.
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
  /// A run of poses with the tip elsewhere counts as a moved divot from this share of the poses on; shorter ones are thrown out.
  double movedShare = 0.1;
  /// Least and largest distance (mm) of the tip from the marker.
  double nearestTipMm = 5;
  double furthestTipMm = 1000;

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// A pose that was not used.
struct PivotRejection
{
  enum class Reason
  {
    Disagrees,  ///< it puts the tip elsewhere than the other poses do
    Repeated    ///< bit for bit an earlier pose: the tracker had nothing new to say
  };

  int index = 0;  ///< into the poses
  Reason reason = Reason::Disagrees;
  double residualMm = 0;  ///< of the pose, whatever the reason
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
    TipMoved,              ///< the tip stood somewhere else for a part of the recording: it slipped, or the divot moved
    ImplausibleTip,        ///< the tip is nearer to or further from the marker than any stylus' is: other units, or inverted poses
    TooNoisy               ///< the residuals are larger than a tracked stylus can have
  };

  Status status = Status::TooFewPoses;
  std::string message;                                      ///< for a person: what was found or what to do
  PivotMethod method = PivotMethod::Robust;                 ///< that was used
  Eigen::Vector3d tip_Stylus = Eigen::Vector3d::Zero();     ///< mm
  Eigen::Vector3d pivot_Tracker = Eigen::Vector3d::Zero();  ///< mm, where the tip stood
  double rmsMm = 0;                                         ///< root mean square of the residual lengths of the used poses
  double meanMm = 0;                                        ///< their mean, which is smaller
  double maximumMm = 0;                                     ///< largest residual length of the used poses
  double noiseFactor = 0;  ///< residuals over what the tracker's noise model predicts; 1 is as said
  Eigen::Matrix3d tipCovariance = Eigen::Matrix3d::Zero();  ///< of tip_Stylus, mm^2, from the residuals of the used poses
  Eigen::Vector3d rotationSpread =
    Eigen::Vector3d::Zero();  ///< root mean square turning (rad) of the three principal directions, ascending
  /// From how far to how far the shaft leant (rad), in the two perpendicular directions in which it leant most and least.
  Eigen::Vector2d angularRange = Eigen::Vector2d::Zero();
  Eigen::Vector3d weakAxis_Stylus = Eigen::Vector3d::Zero();  ///< the direction that was turned least; the axis, if there was one
  double weakAxisDistanceMm = 0;                              ///< of the line about which the stylus then turned from the marker
  std::vector<double> residualsMm;                            ///< one per pose given, used or not
  std::vector<int> used;                                      ///< indices into the poses, ascending
  std::vector<int> rejected;                                  ///< indices of the poses that disagree, ascending
  std::vector<int> repeated;                                  ///< indices of the poses that repeat an earlier one, ascending
  std::vector<PivotRejection> rejections;                     ///< both, with the reason of each, ascending

  bool isUsable() const { return status == Status::Ok; }
};

/// Finds the tip of a stylus that turns about it.
///
/// Frames: stylusToTracker poses, mm. With the tip at rest, e_i = stylusToTracker_i * tip_Stylus - pivot_Tracker is zero for every
/// pose i, six unknowns in 3 n equations.
///
/// - AlgebraicOneStep minimises sum |e_i|^2; AlgebraicTwoStep sum |e_i - e_j|^2 over pairs of poses; SphereFit
///   sum (|marker_i - pivot_Tracker| - radius)^2. They take all poses, and do not look for errors among them.
/// - Robust looks for the tip by sample consensus on triples of poses (deterministic; scored on poses spread over the
///   orientations, so that a stylus at rest for most of the recording does no harm), throws out what disagrees, and then
///   maximises the likelihood. Noise of the marker's position (sigma_t per axis) and rotation (sigma_r) moves e_i by sigma_t
///   along the shaft and by (sigma_t^2 + sigma_r^2 |tip|^2)^1/2 across it, so e_i is weighted by that; since the weights depend
///   on the tip, so does the gradient, which takes out the bias that least squares have towards a short stylus. The minimum is
///   found by Gauss-Newton in the six unknowns with fixed-size matrices and no allocation; Ceres would spend more on setting
///   the problem up than this on solving it.
///
/// Poses that repeat an earlier one bit for bit are not used by any method. The rotation is judged by how much each direction
/// of the tip was moved by it, so that spinning about one axis does not pass, whatever its angle.
///
/// @param stylusToTracker poses of one stylus
/// @throws std::invalid_argument if a pose is not finite (naming it) or the options do not check
/// Thread-safe. Reference: Z. Yaniv, "Which pivot calibration?", SPIE 9415 (2015), for the three classical methods.
[[nodiscard]] PivotCalibrationResult calibratePivot(
  const std::vector<Eigen::Isometry3d>& stylusToTracker, const PivotCalibrationOptions& options = {});

/// "ok", "too_few_poses", ...: the word that result files use.
std::string toString(PivotCalibrationResult::Status status);

/// "robust", "algebraic-one-step", "algebraic-two-step", "sphere-fit".
std::string toString(PivotMethod method);

/// "disagrees", "repeated".
std::string toString(PivotRejection::Reason reason);

}  // namespace handeye
