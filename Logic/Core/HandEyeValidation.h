// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "HandEyeCalibration.h"
#include "Statistics.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <vector>

namespace handeye
{

/// What became of one held-out placement of the ball.
struct HandEyeValidationSample
{
  int frame = 0;
  CameraModel::Status status = CameraModel::Status::BehindCamera;  ///< of the projection; the rest is meaningful if Ok
  Eigen::Vector2d projected_Image = Eigen::Vector2d::Zero();       ///< px, where the calibration puts the tracked ball
  double errorPx = 0;                                              ///< its distance to the segmented ball
  double distanceMm = 0;                                           ///< of the tracked ball from the camera
};

struct HandEyeValidationResult
{
  std::vector<HandEyeValidationSample> samples;  ///< one per sample given
  Summary projectionErrorPx;                     ///< over the samples that project
};

/// Projects the tracked ball of captures that were not fitted and compares with the segmented ball:
/// tip_Camera = markerToCamera * tip_Marker, projected through the lens, against ball_Image.
///
/// @param samples of one eye, the head's camera
/// Thread-safe.
[[nodiscard]] HandEyeValidationResult validateHandEye(
  const std::vector<HandEyeSample>& samples, const CameraModel& camera, const Eigen::Isometry3d& markerToCamera);

}  // namespace handeye
