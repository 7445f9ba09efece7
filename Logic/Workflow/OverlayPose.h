// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Recording.h"

#include <Eigen/Geometry>

#include <optional>
#include <string>

namespace handeye
{

/// What stays the same from frame to frame of an overlay, mm: a calibration and the phantom's registration.
struct OverlayTransforms
{
  Eigen::Isometry3d markerToCamera = Eigen::Isometry3d::Identity();  ///< p_Camera = markerToCamera * p_Marker
  Eigen::Isometry3d modelToPhantom = Eigen::Isometry3d::Identity();  ///< p_Phantom = modelToPhantom * p_Model
};

/// modelToCamera = markerToCamera * inverse(markerToTracker) * phantomToTracker * modelToPhantom;  p_Camera = modelToCamera *
/// p_Model, mm.
Eigen::Isometry3d toModelToCamera(
  const OverlayTransforms& transforms, const Eigen::Isometry3d& markerToTracker, const Eigen::Isometry3d& phantomToTracker);

/// stylusTipToCamera = markerToCamera * inverse(markerToTracker) * stylusToTracker * stylusTipToStylus, mm.
Eigen::Isometry3d toStylusTipToCamera(const Eigen::Isometry3d& markerToCamera, const Eigen::Isometry3d& markerToTracker,
  const Eigen::Isometry3d& stylusToTracker, const Eigen::Isometry3d& stylusTipToStylus);

/// Where the model is in one frame of a recording, or why that is not known.
struct OverlayPose
{
  std::optional<Eigen::Isometry3d> modelToCamera;  ///< p_Camera = modelToCamera * p_Model, mm; set if the status is "ok"
  std::string status = "ok";                       ///< or "marker_missing", "marker_invalid", "phantom_missing", "phantom_invalid"
  std::string message;                             ///< for a person; empty if the status is "ok"

  bool isUsable() const { return modelToCamera.has_value(); }
};

/// @param frame of the recording; @throws std::out_of_range for a frame that there is not
/// @param latencySec the poses are those at the frame's time plus this, see calibrateLatency()
/// @param markerToTrackerName,phantomToTrackerName the poses in the recording; of a tool that is not in it every frame is missing
[[nodiscard]] OverlayPose overlayPose(const io::Recording& recording, int frame, const std::string& markerToTrackerName,
  const std::string& phantomToTrackerName, const OverlayTransforms& transforms, double latencySec = 0);

}  // namespace handeye
