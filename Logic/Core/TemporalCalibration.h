// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "PoseTrack.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

namespace handeye
{

/// The moving ball in one frame of the video.
struct BallSighting
{
  double timeSec = 0;                                     ///< of the frame, by the video's clock
  Eigen::Vector3d ray_Camera = Eigen::Vector3d::UnitZ();  ///< unit ray to the ball's centre
  double distanceMm = 0;                                  ///< by its apparent size; positive
};

struct TemporalCalibrationOptions
{
  double maximumLatencySec = 0.3;  ///< looked for on both sides of zero
  int minimumSightings = 30;
  double maximumSigmaSec = 0.01;  ///< more than this is not usable: too little motion, or too much noise
  double maximumRmsPx = 8;        ///< more than this is no fit

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

struct TemporalCalibrationResult
{
  enum class Status
  {
    Ok,
    TooFewSightings,  ///< of the ball, or of frames of which the tracker saw both tools
    AtLimit,          ///< the best latency is at the end of what was looked for
    TooLittleMotion,  ///< the latency's uncertainty is too large
    PoorFit           ///< no latency makes video and tracker agree
  };

  Status status = Status::TooFewSightings;
  std::string message;    ///< for a person
  double latencySec = 0;  ///< the poses of a frame are those at the frame's time plus this; only if usable
  double sigmaSec = 0;    ///< its standard deviation
  double rmsPx = 0;       ///< of the used sightings at that latency
  int usedCount = 0;
  int rejectedCount = 0;  ///< sightings that disagree with the rest

  bool isUsable() const { return status == Status::Ok; }
};

/// Finds how far video and tracker are apart in time, from some seconds of a ball that moves.
///
///     tip_Marker(t) = inverse(markerToTracker(t)) * stylusToTracker(t) * tip_Stylus
///
/// must lie on the ray of the frame at t - latency. For each latency that is tried, the points tip_Marker are registered to the
/// rays
/// (see registerPointsToLines()), or mapped by `markerToCamera` where that is known; what remains, in px, is smallest at the right
/// one.
/// The minimum is refined by a parabola c0 + k (latency - minimum)^2 of the mean squared residual of n sightings; with s the
/// scatter of a
/// residual per axis, the uncertainty is sigma = s / sqrt(k n), and not less than what a delete-a-group jackknife over eight parts of the
/// recording gives: errors that last, such as those of poses interpolated over a fast turn, are in it. A latency and a hand-eye calibration do not disturb each other:
/// the registration is free.
///
/// @param sightings in any order
/// @param marker,stylus the tools' poses by the tracker's clock, at full rate, spanning the sightings by the largest latency where
/// they can
/// @param camera its focal length turns angles into px
/// @throws std::invalid_argument for numbers that are not finite, or distances that are not positive
/// Thread-safe.
[[nodiscard]] TemporalCalibrationResult calibrateLatency(const std::vector<BallSighting>& sightings, const PoseTrack& marker,
  const PoseTrack& stylus, const Eigen::Vector3d& tip_Stylus, const CameraModel& camera,
  const std::optional<Eigen::Isometry3d>& markerToCamera = {}, const TemporalCalibrationOptions& options = {});

/// "ok", "too_few_sightings", "at_limit", "too_little_motion", "poor_fit": the word that result files use.
std::string toString(TemporalCalibrationResult::Status status);

}  // namespace handeye
