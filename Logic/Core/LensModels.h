// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LensFit.h"

namespace handeye
{

/// Fits the models with 4, 5 and 8 coefficients to the same views, and says which one the data support. Internal.
/// @param own the fit of the model that was asked for; its numbers are taken
void compareLensModels(const std::vector<const LensView*>& views, int width, int height, const LensCalibrationOptions& options,
  const LensFit& own, LensCalibrationResult& result);

}  // namespace handeye
