// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <optional>

namespace handeye
{

struct PoseSmootherOptions
{
  double restCutoffHz = 1.5;        ///< of the filter while nothing moves: the lower, the calmer
  double cutoffPerMmPerSec = 0.04;  ///< Hz more for each mm/s: the higher, the less it lags behind a motion
  double cutoffPerRadPerSec = 12;   ///< Hz more for each rad/s
  double speedCutoffHz = 1;         ///< of the filter on the speed itself
  double resetGapSec = 0.3;         ///< after a gap longer than this the filter starts anew: a tool was hidden

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// A pose with less jitter, and what that costs.
struct SmoothedPose
{
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();  ///< the same frames as the poses that were added, mm
  double delaySec = 0;  ///< by how much the translation or the rotation, whichever is later, lags behind a steady motion now
  double cutoffHz = 0;  ///< of the translation's filter now; 0 for the first pose, which is passed on as it is
};

/// Takes the jitter of a tracker out of a stream of poses: a low-pass filter that opens when the tool moves, so that a still
/// overlay is calm and a moving one is not late (the 1-euro filter, on rigid motions).
///
/// With the time step dt, translation t and rotation R each follow their measurement by the share a:
///
///     a = 1 / (1 + tau / dt),  tau = 1 / (2 pi cutoff),  cutoff = rest + slope * speed
///     t <- t + a (t_measured - t)          R <- R exp(a log(R^T R_measured))
///
/// The speed is that of the measurements, low-pass filtered as a vector, so that jitter to and fro is no motion. The delay for a
/// steady motion is dt (1 - a) / a = tau.
///
/// A pose with a time not later than the one before is not taken. Deterministic; not safe to share between threads.
/// Reference: Casiez, Roussel and Vogel, "1 euro filter: a simple speed-based low-pass filter for noisy input in interactive
/// systems", CHI 2012, equations 1, 6 and 9.
class PoseSmoother
{
public:
  /// @throws std::invalid_argument where the options do not check
  explicit PoseSmoother(const PoseSmootherOptions& options = {});

  /// @return the pose to show; for a time that is not later than the one before, the last one again
  /// @throws std::invalid_argument for a time or a transform that is not finite
  SmoothedPose add(double timeSec, const Eigen::Isometry3d& transform);

  /// Forgets all poses: the next one is passed on as it is.
  void reset() { last_.reset(); }

private:
  struct Filter
  {
    double timeSec;
    Eigen::Isometry3d measured, smoothed;
    Eigen::Vector3d velocityMm, turnRate;  ///< per second, filtered; the turn in the tool's own frame
    SmoothedPose result;
  };

  PoseSmootherOptions options_;
  std::optional<Filter> last_;
};

}  // namespace handeye
