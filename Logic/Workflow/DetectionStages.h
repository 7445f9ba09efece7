// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Capture.h"

#include <filesystem>
#include <vector>

namespace handeye
{

/// Writes four pictures a frame into a folder, made where it is missing: `0000-1-mask.png`, `-2-smoothed.png`, `-3-edges.png` and
/// `-4-outline.png`; see BallStages.
/// @param frames what detectBalls() found with these options
/// @throws io::FileError where a picture cannot be written
void writeDetectionStages(const std::filesystem::path& folder, const io::Recording& recording, const CameraModel& camera,
  double ballRadiusMm, const BallDetectionOptions& options, const std::vector<CapturedFrame>& frames);

}  // namespace handeye
