// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LiveOverlay.h"

#include <cmath>
#include <stdexcept>

namespace handeye
{

namespace
{

LiveOverlayOptions checked(const LiveOverlayOptions& options)
{
  options.check();
  return options;
}

}  // namespace

PoseTrackOptions LiveOverlayOptions::liveTrack()
{
  PoseTrackOptions options;
  options.maximumExtrapolationSec = 0.05;
  return options;
}

void LiveOverlayOptions::check() const
{
  if (!std::isfinite(this->latencySec))
  {
    throw std::invalid_argument("the latency is not a finite number");
  }
  this->smoothing.check();
  this->age.check();
  this->track.check();
}

LiveOverlay::LiveOverlay(const OverlayTransforms& transforms, const LiveOverlayOptions& options)
  : transforms_(transforms)
  , options_(checked(options))
  , marker_(options.track)
  , phantom_(options.track)
  , smoother_(options.smoothing)
{
}

/// A clock that was set, or a recording that begins anew: what was seen before says nothing now.
void LiveOverlay::forgetIfClockWasSet(const PoseTrack& track, double timeSec)
{
  if (!track.isEmpty() && timeSec < track.newestSec() - options_.track.historySec)
  {
    marker_.clear();
    phantom_.clear();
    smoother_.reset();
    markerSeenSec_ = phantomSeenSec_ = placedSec_ = std::nullopt;
    last_.reset();
  }
}

void LiveOverlay::addMarker(double timeSec, const Eigen::Isometry3d& markerToTracker, bool isValid)
{
  forgetIfClockWasSet(marker_, timeSec);
  marker_.add(timeSec, markerToTracker, isValid);
}

void LiveOverlay::addPhantom(double timeSec, const Eigen::Isometry3d& phantomToTracker, bool isValid)
{
  forgetIfClockWasSet(phantom_, timeSec);
  phantom_.add(timeSec, phantomToTracker, isValid);
}

void LiveOverlay::setTransforms(const OverlayTransforms& transforms)
{
  transforms_ = transforms;
  last_.reset();
  placedSec_.reset();
  smoother_.reset();
}

void LiveOverlay::setSmoothing(bool smooth)
{
  options_.smooth = smooth;
  smoother_.reset();
}

LiveOverlayPose LiveOverlay::at(double frameSec)
{
  if (!std::isfinite(frameSec))
  {
    throw std::invalid_argument("the time of a frame is not a finite number");
  }
  const double timeSec = frameSec + options_.latencySec;
  const PoseAtTime marker = marker_.at(timeSec), phantom = phantom_.at(timeSec);
  markerSeenSec_ = marker.isUsable() ? timeSec : markerSeenSec_;
  phantomSeenSec_ = phantom.isUsable() ? timeSec : phantomSeenSec_;
  LiveOverlayPose result;
  const bool placed = marker.isUsable() && phantom.isUsable();
  if (placed)
  {
    last_ = toModelToCamera(transforms_, marker.transform, phantom.transform);
    delaySec_ = 0;
    if (options_.smooth)
    {
      const SmoothedPose smooth = smoother_.add(timeSec, *last_);
      last_ = smooth.transform;
      delaySec_ = smooth.delaySec;
    }
  }
  placedSec_ = placed ? timeSec : placedSec_;
  const std::vector<ToolSight> tools = { { options_.phantomName, phantomSeenSec_ }, { options_.markerName, markerSeenSec_ } };
  const PoseAge age = judgePoseAge(tools, placedSec_, timeSec, options_.age);
  result.status = age.status;
  result.message = age.message;
  result.delaySec = delaySec_;
  if (age.isUsable() && last_)
  {
    result.modelToCamera = last_;
    result.opacity = age.opacity;
  }
  else if (result.message.empty())
  {
    result.message = "the " + options_.phantomName + " and the " + options_.markerName + " have not been seen together yet";
  }
  return result;
}

}  // namespace handeye
