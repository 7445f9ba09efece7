// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <cstddef>
#include <deque>
#include <string>
#include <vector>

namespace handeye
{

struct PoseTrackOptions
{
  double historySec = 5;       ///< poses older than this, seen from the newest, are forgotten
  double maximumGapSec = 0.1;  ///< between the two poses that a moment lies between
  double maximumExtrapolationSec =
    0;                            ///< beyond the newest or before the oldest pose; within it the nearest pose is taken as it is
  double maximumRepeatSec = 0.5;  ///< the same numbers, bit by bit, for longer than this: a tracker that has stopped; 0: allowed

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// A pose at a moment, and how far it can be believed.
struct PoseAtTime
{
  enum class Status
  {
    Ok,
    NoPose,        ///< nothing was received
    Invalid,       ///< a pose beside the moment is not valid: the tool was not seen
    GapTooLarge,   ///< the poses beside the moment are too far apart
    Extrapolated,  ///< the moment is too far outside of what was received
    Stale          ///< the pose has not changed by a single bit for too long
  };

  Status status = Status::NoPose;
  std::string message;                                          ///< for a person; empty if the status is Ok
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();  ///< p_To = transform * p_From, mm; not meaningful unless Ok
  double gapSec = 0;                                            ///< between the poses on both sides; 0 for an extrapolated one
  double extrapolationSec = 0;                                  ///< how far outside: negative before the oldest pose
  double repeatSec = 0;                                         ///< for how long the pose had been the same, bit by bit

  bool isUsable() const { return status == Status::Ok; }
};

/// The poses of one tool over time, so that a pose can be had for the moment of an image.
///
/// Between two poses the rotation is interpolated along the shortest arc (slerp) and the translation linearly:
/// p_To = transform(t) * p_From, mm, seconds.
///
/// A pose with a time that is not later than the newest is put in its place if it lies within the history; one with a time that is
/// there already replaces it. A moment in between two poses of which one is invalid has no pose: the tool was hidden in between.
///
/// Not safe to share between threads.
class PoseTrack
{
public:
  explicit PoseTrack(const PoseTrackOptions& options = {});

  /// @param isValid false where the tracker did not see the tool; the transform does not matter then
  /// @return false for a pose that is older than the history and was not taken
  /// @throws std::invalid_argument for a time or a valid transform that is not finite
  bool add(double timeSec, const Eigen::Isometry3d& transform, bool isValid = true);

  [[nodiscard]] PoseAtTime at(double timeSec) const;

  bool isEmpty() const { return poses_.empty(); }
  std::size_t size() const { return poses_.size(); }
  /// Of every pose that is kept, valid or not, in order.
  [[nodiscard]] std::vector<double> timesSec() const;
  double newestSec() const { return poses_.empty() ? 0 : poses_.back().timeSec; }
  void clear() { poses_.clear(); }

private:
  struct Pose
  {
    double timeSec;
    Eigen::Isometry3d transform;
    bool isValid;
    double sameSinceSec;  ///< since when the numbers have been the same
  };

  PoseAtTime outside(const Pose& nearest, double extrapolationSec) const;
  PoseAtTime between(const Pose& before, const Pose& after, double timeSec) const;

  PoseTrackOptions options_;
  std::deque<Pose> poses_;  ///< by time
};

/// "ok", "no_pose", "invalid", "gap_too_large", "extrapolated", "stale": the word that result files use.
std::string toString(PoseAtTime::Status status);

}  // namespace handeye
