// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"

#include <Eigen/Geometry>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace handeye::io
{

/// What a camera file holds.
struct CameraFile
{
  CameraModel camera;                               ///< width and height are 0 where the file does not say
  std::optional<Eigen::Isometry3d> markerToCamera;  ///< p_Camera = markerToCamera * p_Marker, mm; where the file has it
  std::string format;                 ///< "OpenCV", "SlicerPinholeCameras", "VASST", "ROS", "text", "calibration.json"
  std::vector<std::string> warnings;  ///< sentences for the user
  std::optional<CameraModel> rightCamera = std::nullopt;  ///< of a stereo rig's calibration.json
};

/// Reads a camera file of any of these kinds, told apart by what is in it and not by its name:
///
/// - OpenCV FileStorage (YAML, XML or JSON) as OpenCV's samples write it: `camera_matrix` 3x3, `distortion_coefficients`,
///   `image_width`, `image_height`; also `Camera_Matrix`, `Distortion_Coefficients`, `image_Width`, `image_Height`;
/// - SlicerPinholeCameras XML: `IntrinsicMatrix`, `DistortionCoefficients`, optionally `MarkerToSensor` 4x4 (mm) and
///   `CameraPlaneOffset` (not part of a pinhole model: reported if it is not zero);
/// - the older VASST XML: `Intrinsics`, `Distortion_Parameters`;
/// - ROS camera_info YAML: `camera_matrix` and `distortion_coefficients` with rows, cols and data, `distortion_model` plumb_bob or
///   rational_polynomial; the message's own spelling (`K`, `D`, `width`, `height`, or lower case) too;
/// - scikit-surgery text: three rows of three numbers, then the coefficients;
/// - our own calibration.json (see DESIGN.md): `camera` and `markerToCamera`, of a stereo rig also `rightCamera`.
///
/// Coefficients come in OpenCV's order, as a row or a column: 0, 4, 5, 8, 12 or 14 of them. Any other count is refused.
/// @throws FileError naming the file, the key and what was expected there, for anything else than a good camera file
[[nodiscard]] CameraFile readCameraFile(const std::filesystem::path& path);

}  // namespace handeye::io
