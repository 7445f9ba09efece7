// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace handeye
{

/// A pose from points and their pixels, refined. Internal.
struct RefinedPose
{
  Eigen::Isometry3d boardToCamera = Eigen::Isometry3d::Identity();  ///< p_Camera = boardToCamera * p_Board
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<double> residualsPx;
  double rmsPx = 0;
};

/// Levenberg and Marquardt's iteration on the squared pixel residuals; nothing where a point leaves the lens model or the start
/// has one behind the camera.
std::optional<RefinedPose> refinePose(const std::vector<Eigen::Vector3d>& points_Board,
  const std::vector<Eigen::Vector2d>& points_Image, const CameraModel& camera, const Eigen::Isometry3d& start);

}  // namespace handeye
