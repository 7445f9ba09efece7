// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeResiduals.h"

namespace handeye
{

/// The covariance from the noise that is expected of each used sample, scaled by the scatter that was found if that is more.
/// Samples of one place share one error, and a scatter well above the expected noise is taken to be systematic: it does not
/// average out. Stored in the result, whose samples must be filled in. Internal.
/// @return the scatter in multiples of what was expected
double estimateCovariance(
  const HandEyeSamples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, HandEyeCalibrationResult& result);

/// For each sample the share that it has in its place of the ball: 1 over the number of used samples there. Samples are of one
/// place if their tips are within 2 mm. 0 for samples that are not used.
std::vector<double> placeShares(const HandEyeSamples& samples, const std::vector<int>& used);

}  // namespace handeye
