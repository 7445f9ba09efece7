// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeResiduals.h"

#include <optional>

namespace handeye
{

/// The factor on the focal lengths with which the samples would fit much better (a median residual of less than 0.4 times): the sign of
/// a camera file that is not this camera's, or not of this zoom or focus. Nothing if there is none between 0.75 and 1.33, or for less
/// than eight samples. A diagnosis, not a lens calibration. Internal.
std::optional<double> betterFocalScale(const HandEyeSamples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options);

}  // namespace handeye
