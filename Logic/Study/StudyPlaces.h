// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "StudyCamera.h"
#include "StudyRandom.h"

namespace handeye::study
{

/// A place (mm, camera) of the ball, all of it in view: anywhere in the image, at any depth of the camera's range. Internal.
Eigen::Vector3d drawBallPlace(const StudyCamera& camera, const StudyEye& eye, StudyRandom& random);

/// A pose of the board with all of its points in view, seen from up to `tiltRad` off its normal, turned by up to `rollRad`.
/// Internal.
/// @throws std::runtime_error where the board is too large for the camera
Eigen::Isometry3d drawBoardPose(
  const StudyCamera& camera, const StudyEye& eye, double tiltRad, double rollRad, StudyRandom& random);

}  // namespace handeye::study
