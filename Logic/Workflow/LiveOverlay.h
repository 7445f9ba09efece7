// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "OverlayPose.h"
#include "PoseAge.h"
#include "PoseSmoother.h"
#include "PoseTrack.h"

#include <Eigen/Geometry>

#include <optional>
#include <string>

namespace handeye
{

struct LiveOverlayOptions
{
  double latencySec = 0;  ///< the poses of a frame are those at its time plus this, see calibrateLatency()
  bool smooth = false;    ///< take the tracker's jitter out; costs a delay
  PoseSmootherOptions smoothing;
  PoseAgeOptions age;
  PoseTrackOptions track = liveTrack();
  std::string markerName = "camera's marker";  ///< for a person
  std::string phantomName = "phantom";

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;

  /// A live frame comes before the tracker's next pose: the newest is taken for up to 50 ms.
  static PoseTrackOptions liveTrack();
};

/// Where a model is in one frame of a live video, and how much of it may be shown.
struct LiveOverlayPose
{
  std::optional<Eigen::Isometry3d> modelToCamera;  ///< p_Camera = modelToCamera * p_Model, mm; nothing if nothing may be shown
  double opacity = 0;                              ///< 0 to 1: vtkHandEyeOverlayPipeline::SetFade()
  std::string message;                             ///< vtkHandEyeOverlayPipeline::SetNotice(); empty while all tools are seen
  PoseAge::Status status = PoseAge::Status::NeverSeen;
  double delaySec = 0;  ///< of the smoothing, for a steady motion

  bool isUsable() const { return modelToCamera.has_value(); }
};

/// The overlay's pose for live video: poses of the camera's marker and of the phantom go in as they come, and for each frame the
/// model's place comes out, at the frame's time plus the latency. While a tool is hidden the model stays where it was last, paler
/// and paler, and a sentence says which tool it is; then it is gone.
///
///     modelToCamera = markerToCamera * inverse(markerToTracker(t)) * phantomToTracker(t) * modelToPhantom
///     t = frame time + latency
///
/// Times in s, of one clock, the frames in ascending order. Not safe to share between threads.
class LiveOverlay
{
public:
  /// @throws std::invalid_argument where the options do not check
  explicit LiveOverlay(const OverlayTransforms& transforms, const LiveOverlayOptions& options = {});

  /// @param isValid false where the tracker did not see the tool
  /// @throws std::invalid_argument for a time or a valid transform that is not finite
  void addMarker(double timeSec, const Eigen::Isometry3d& markerToTracker, bool isValid = true);
  void addPhantom(double timeSec, const Eigen::Isometry3d& phantomToTracker, bool isValid = true);

  /// @throws std::invalid_argument for a time that is not finite
  [[nodiscard]] LiveOverlayPose at(double frameSec);

  /// What a person changes while it runs: another calibration, the smoothing on or off.
  void setTransforms(const OverlayTransforms& transforms);
  void setSmoothing(bool smooth);

private:
  void forgetIfClockWasSet(const PoseTrack& track, double timeSec);

  OverlayTransforms transforms_;
  LiveOverlayOptions options_;
  PoseTrack marker_, phantom_;
  PoseSmoother smoother_;
  std::optional<double> markerSeenSec_, phantomSeenSec_, placedSec_;  ///< placed: both at once
  std::optional<Eigen::Isometry3d> last_;
  double delaySec_ = 0;
};

}  // namespace handeye
