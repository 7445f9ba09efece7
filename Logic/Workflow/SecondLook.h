// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Capture.h"

#include <Eigen/Geometry>

#include <vector>

namespace handeye
{

/// Looks again into the frames in which several things looked like the ball, now that a first calibration and the tracker say where it
/// is. The first calibration is made without them, so that it does not depend on what it decides; frames with one ball are left as
/// they are, since to prefer what agrees would hide errors.
///
/// @param frames of readCapture() with these options; those that are decided become samples
/// @param markerToCamera the first calibration, p_Camera = markerToCamera * p_Marker
/// @param sigmaPx how well it says where the ball is seen, px
/// @return the numbers of the frames that were decided
/// @throws as readCapture()
std::vector<int> lookAgain(const io::Recording& recording, const CameraModel& camera, double ballRadiusMm,
  const BallDetectionOptions& options, const Eigen::Isometry3d& markerToCamera, double sigmaPx, std::vector<CapturedFrame>& frames);

}  // namespace handeye
