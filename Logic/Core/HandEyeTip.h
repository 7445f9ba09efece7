// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeResiduals.h"

namespace handeye
{

/// Maximum likelihood of pose and tip together, the tip's covariance being the prior:
/// tip_Marker = sample.tip_Marker + stylusToMarker * correction_Stylus. Where the used samples say at least as much of each
/// direction of the tip as the prior does, the result's pose, tip correction and remaining covariance are set; otherwise the result
/// keeps its pose. What became of it is in result.tipMessage. Internal.
void refineTip(
  const HandEyeSamples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, HandEyeCalibrationResult& result);

}  // namespace handeye
