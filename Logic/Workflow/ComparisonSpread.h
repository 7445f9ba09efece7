// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "MethodComparison.h"

#include <vector>

namespace handeye
{

/// Spread of calibrations about their mean, root mean squares (n - 1): the rotations' angle from the mean rotation, the
/// translations, and where the validation set's tracked balls are put in the image. Sets `calibrations` and, from 2 on, the
/// spreads. Internal.
void measureSpread(const std::vector<Eigen::Isometry3d>& markerToCamera, const std::vector<HandEyeSample>& validation,
  const CameraModel& camera, Repeatability& result);

}  // namespace handeye
