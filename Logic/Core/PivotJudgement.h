// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "PivotMethods.h"

namespace handeye
{

/// What calibratePivot() says of a solution. Internal; thread-safe.

/// From how far to how far (rad) the shaft leant, in the two perpendicular directions in which it leant most and least.
Eigen::Vector2d leaningRange(const PivotPoses& poses, const std::vector<int>& used, const Eigen::Vector3d& tip_Stylus);

/// Fills status and message of a result that has everything else. @param different the poses that do not repeat an earlier one
void judgePivot(const PivotPoses& poses, const std::vector<int>& different, const PivotCalibrationOptions& options,
  PivotCalibrationResult& result);

}  // namespace handeye
