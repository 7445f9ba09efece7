// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OverlayPose.h"

#include "TimedPose.h"

namespace handeye
{

Eigen::Isometry3d toStylusTipToCamera(const Eigen::Isometry3d& markerToCamera, const Eigen::Isometry3d& markerToTracker,
  const Eigen::Isometry3d& stylusToTracker, const Eigen::Isometry3d& stylusTipToStylus)
{
  const Eigen::Isometry3d trackerToCamera = markerToCamera * markerToTracker.inverse();
  const Eigen::Isometry3d stylusToCamera = trackerToCamera * stylusToTracker;
  return stylusToCamera * stylusTipToStylus;
}

Eigen::Isometry3d toModelToCamera(
  const OverlayTransforms& transforms, const Eigen::Isometry3d& markerToTracker, const Eigen::Isometry3d& phantomToTracker)
{
  const Eigen::Isometry3d trackerToCamera = transforms.markerToCamera * markerToTracker.inverse();
  const Eigen::Isometry3d phantomToCamera = trackerToCamera * phantomToTracker;
  return phantomToCamera * transforms.modelToPhantom;
}

OverlayPose overlayPose(const io::Recording& recording, int frame, const std::string& markerToTrackerName,
  const std::string& phantomToTrackerName, const OverlayTransforms& transforms, double latencySec)
{
  OverlayPose pose;
  const io::TransformSample marker = poseOfFrame(recording, frame, markerToTrackerName, latencySec);
  const io::TransformSample phantom = poseOfFrame(recording, frame, phantomToTrackerName, latencySec);
  if (!marker.isUsable() || !phantom.isUsable())
  {
    const io::TransformSample& lost = marker.isUsable() ? phantom : marker;
    pose.status = std::string(marker.isUsable() ? "phantom" : "marker") +
      (lost.status == io::TransformSample::Status::Missing ? "_missing" : "_invalid");
    pose.message = lost.reason;
    return pose;
  }
  pose.modelToCamera = toModelToCamera(transforms, marker.transform, phantom.transform);
  return pose;
}

}  // namespace handeye
