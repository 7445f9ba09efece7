// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallDetection.h"
#include "CameraModel.h"
#include "FramePairing.h"
#include "Session.h"
#include "StillnessDetector.h"

#include <Eigen/Core>

#include <map>
#include <optional>
#include <string>

namespace handeye::devices
{

struct LiveCaptureOptions
{
  std::string stylusToTracker = "StylusToTracker";
  std::string markerToTracker = "MarkerToTracker";
  double ballRadiusMm = 15;
  double stillSec = 0.4;  ///< the ball counts as held still after this long ...
  double stillMm = 1.2;   ///< ... within this distance of the middle of its rest, in the marker's frame (see StillnessDetector)
  double differentPlaceMm = 15;  ///< a sample this near to an accepted one is the same place and not taken again
  BallDetectionOptions detection;

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// Watches paired frames and stores a sample in a session whenever the ball is held still at a new place:
///
///     tip_Marker = inverse(markerToTracker) * stylusToTracker * tip_Stylus,
///
/// with the poses of the frame's own moment. Of a frame of which a tool was not seen, or whose poses are stale or too far apart in time,
/// why is said; 0.2 s without poses begin the rest anew. Samples that were set aside (or removed) leave their place to others.
///
/// Not safe to share between threads.
class LiveCapture
{
public:
  struct Step
  {
    enum class Status
    {
      Accepted,   ///< on the disk, see sampleId
      Moving,     ///< not still, or not for long enough
      SamePlace,  ///< move on
      NoPose,     ///< a tool is not seen, or its poses cannot be believed
      NoBall,     ///< still, but the ball is not found in the image
      WrongImage  ///< of another size than the camera's, or not in colour
    };
    Status status = Status::Moving;
    int sampleId = -1;
    std::string message;  ///< for a person
  };

  /// @param session takes the samples; the places of those it has count as taken
  LiveCapture(
    const CameraModel& camera, const Eigen::Vector3d& tip_Stylus, io::Session& session, const LiveCaptureOptions& options = {});

  /// @throws io::FileError where the session cannot be written to: nothing is accepted then, and it can be tried again
  Step add(const PairedFrame& frame);

private:
  std::optional<Eigen::Isometry3d> stylusToMarker(const PairedFrame& frame, std::string& problem) const;
  bool isTaken(const Eigen::Vector3d& tip_Marker) const;
  Step store(const PairedFrame& frame, const Eigen::Vector3d& tip_Marker);

  CameraModel camera_;
  Eigen::Vector3d tip_Stylus_;
  io::Session& session_;
  LiveCaptureOptions options_;
  StillnessDetector stillness_;
  double lastSeenSec_ = -1e300;
  std::map<int, Eigen::Vector3d> places_Marker_;  ///< by sample
};

/// What a session keeps of a paired frame: its poses with their statuses, and how they came together.
io::SessionSample toSessionSample(const PairedFrame& frame);

}  // namespace handeye::devices
