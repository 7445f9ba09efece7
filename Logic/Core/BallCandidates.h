// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "SphereCone.h"

#include <opencv2/core.hpp>

#include <vector>

namespace handeye
{

/// Places in a colour mask where a ball may be: for each connected region the cones that best follow its border, whatever is
/// attached to it. Coarse (about a pixel); internal to the detection.
///
/// @param mask 255 where the colour is the ball's, 0 elsewhere
/// @param minimumRadiusPx smaller regions are passed over
/// @return at most a dozen cones, the best supported first; the same ball may be there more than once
/// Thread-safe and deterministic.
std::vector<SphereCone> findBallCandidates(const cv::Mat& mask, const CameraModel& camera, double minimumRadiusPx);

}  // namespace handeye
