// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeResiduals.h"

#include <vector>

namespace handeye
{

/// Samples that belong together: those that agree with the best minimal set, then with their own common solution. Internal.
/// @return ascending indices; empty if no set of samples has a solution
std::vector<int> findConsensus(const HandEyeSamples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options);

}  // namespace handeye
