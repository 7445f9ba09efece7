// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Recording.h"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace handeye
{

/// The valid poses of one tool in a recording, and the frames that they are of. Internal.
struct TrackedPoses
{
  std::vector<Eigen::Isometry3d> toolToTracker;
  std::vector<int> frames;         ///< one per pose, ascending
  std::vector<int> invalidFrames;  ///< not tracked

  /// The frames of some of the poses.
  std::vector<int> framesOf(const std::vector<int>& poses) const;
};

/// @throws io::FileError, listing the transforms that there are, where the tool is not in the recording
TrackedPoses readTrackedPoses(const io::Recording& recording, const std::string& toolToTrackerName);

}  // namespace handeye
