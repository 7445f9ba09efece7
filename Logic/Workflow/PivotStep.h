// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "PivotCalibration.h"
#include "Recording.h"

#include <string>
#include <vector>

namespace handeye
{

/// A pivot calibration with the frames of the recording that it rests on.
struct PivotStepResult
{
  PivotCalibrationResult calibration;  ///< its indices count the valid poses
  std::vector<int> usedFrames;
  std::vector<int> rejectedFrames;  ///< thrown out because they disagree
  std::vector<int> invalidFrames;   ///< not tracked
  std::vector<int> repeatedFrames;  ///< the tracker repeated an earlier pose
  std::vector<int> poseFrames;      ///< the frame of each valid pose
};

/// Pivot-calibrates a tool from all frames of a recording in which it is tracked.
/// @throws io::FileError, listing the transforms that there are, where the tool is not in the recording
[[nodiscard]] PivotStepResult pivotFromRecording(
  const io::Recording& recording, const std::string& stylusToTrackerName, const PivotCalibrationOptions& options = {});

}  // namespace handeye
