// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "SimulatedRoom.h"

namespace handeye::simulation
{

/// Where everything in the room is, without noise. A function of time alone.
class RoomScript
{
public:
  explicit RoomScript(const RoomOptions& options);

  Eigen::Isometry3d markerToTracker(double timeSec) const;
  Eigen::Isometry3d stylusToTracker(double timeSec) const;
  Eigen::Isometry3d phantomToTracker() const { return phantomToTracker_; }
  bool isHeldStill(double timeSec) const;

private:
  struct Moment
  {
    RoomMotion motion;
    double timeSec;  ///< since this motion began
  };
  Moment momentOf(double timeSec) const;
  Eigen::Vector3d ball_Tracker(const Moment& moment) const;
  Eigen::Vector3d placedBall_Tracker(double timeSec) const;
  Eigen::Matrix3d stylusRotation(const Moment& moment) const;

  RoomOptions options_;
  Eigen::Isometry3d cameraToTracker_;  ///< where the camera rests
  Eigen::Isometry3d phantomToTracker_;
  std::vector<Eigen::Vector3d> places_Tracker_;
};

}  // namespace handeye::simulation
