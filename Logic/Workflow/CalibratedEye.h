// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"

#include <Eigen/Geometry>

#include <filesystem>
#include <optional>

namespace handeye
{

/// What drawing with one eye of a calibration.json needs: p_Camera = markerToCamera * p_Marker, mm; the covariance (rotation
/// vector rad, translation mm) in this eye's own camera frame, nothing where it is not known.
struct CalibratedEye
{
  CameraModel camera;
  Eigen::Isometry3d markerToCamera = Eigen::Isometry3d::Identity();
  std::optional<Eigen::Matrix<double, 6, 6>> covariance;
};

/// The right eye of a stereo rig's calibration.json, with the lens that the file holds; nothing where it has one camera, or no
/// lens of the right one. @throws io::FileError naming the key
std::optional<CalibratedEye> readRightEye(const std::filesystem::path& path);

/// The covariance of a stereo rig's right eye, in its own camera frame: of its own calibration, where each eye has one (`right`),
/// otherwise that of both eyes' one registration, brought over by the eyes' relation, which such a registration takes as known.
/// @throws io::FileError as readCalibrationCovariance(); also where the calibration is of one camera
std::optional<Eigen::Matrix<double, 6, 6>> readRightCalibrationCovariance(const std::filesystem::path& path);

}  // namespace handeye
