// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeResiduals.h"

namespace handeye
{

/// The covariance from the noise that is expected of each used sample, scaled by the scatter that was found if that is more; stored
/// in the result, whose samples must be filled in. Internal.
/// @return that scatter in multiples of what was expected
double estimateCovariance(
  const HandEyeSamples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, HandEyeCalibrationResult& result);

}  // namespace handeye
