// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Recording.h"
#include "SpinCalibration.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace handeye
{

/// A spin calibration with the frames of the recording that it rests on.
struct SpinStepResult
{
  SpinCalibrationResult calibration;  ///< its indices count the valid poses
  std::vector<int> usedFrames;
  std::vector<int> rejectedFrames;  ///< they disagree, or repeat an earlier pose
  std::vector<int> invalidFrames;   ///< not tracked
};

/// Spin-calibrates a tool from all frames of a recording in which it is tracked.
/// @throws io::FileError, listing the transforms that there are, where the tool is not in the recording
[[nodiscard]] SpinStepResult spinFromRecording(const io::Recording& recording, const std::string& stylusToTrackerName,
  const Eigen::Vector3d& tip_Stylus, const SpinCalibrationOptions& options = {});

/// A stylus.json with `stylusTipToStylus` and how it was found added to everything that was in it; or why there is none.
nlohmann::json spinJson(const SpinStepResult& step, const nlohmann::json& stylus);

}  // namespace handeye
