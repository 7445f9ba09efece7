// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraFile.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace handeye::io
{

/// The kinds of camera file that are written; readCameraFile() reads each of them back, number for number.
enum class CameraFormat
{
  OpenCV,       ///< FileStorage: YAML, or XML if the file's name ends in .xml
  PinholeXml,   ///< SlicerPinholeCameras
  Vasst,        ///< the older VASST XML
  Ros,          ///< camera_info YAML
  SurgeryText,  ///< scikit-surgery: 3x3 and the coefficients; markerToCamera as 4x4 in a second file
  Json          ///< `camera` and `markerToCamera` as calibration.json has them
};

/// What is written beside the lens.
struct CameraFileExtras
{
  std::optional<double> reprojectionErrorPx;
  std::optional<double> registrationErrorMm;
};

/// Writes a camera file.
///
/// The convention (`p_Camera = markerToCamera * p_Marker`, mm; OpenCV's camera frame and pixel centres) stands in a comment where
/// the
/// format has comments. `CameraPlaneOffset` is written as zero, since a pinhole camera has none.
/// @param path the file; for SurgeryText "<name>.intrinsics.txt" or any other name, the second file being "<name>.handeye.txt"
/// @param warnings sentences for the user are appended: what the format cannot hold, what its readers are known to do
/// @return the files that were written
/// @throws FileError where it cannot be written, or where the format cannot hold this camera (no image size for ROS and OpenCV,
/// more
/// than 8 coefficients for ROS, no markerToCamera for SlicerPinholeCameras)
std::vector<std::filesystem::path> writeCameraFile(const std::filesystem::path& path, const CameraFile& file, CameraFormat format,
  std::vector<std::string>& warnings, const CameraFileExtras& extras = {});

}  // namespace handeye::io
