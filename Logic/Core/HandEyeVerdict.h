// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeResiduals.h"

namespace handeye
{

/// What is to be said of a solution, and whether it is usable at all: sets status and message of a result whose samples, sums,
/// covariance and prediction are filled in. A result that is not usable stays so; see blameLens(). Internal.
/// @param misfit the residuals over what their noise explains
void giveVerdict(const HandEyeSamples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, double misfit,
  HandEyeCalibrationResult& result);

/// Adds to the message of a solution that is not usable, or of samples that agree on none, if a wrong lens explains it. Internal.
void blameLens(
  const HandEyeSamples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, HandEyeCalibrationResult& result);

}  // namespace handeye
