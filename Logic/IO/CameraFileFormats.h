// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraFile.h"

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace handeye::io
{

/// Numbers of a camera file with the key under which they stand; row by row.
struct NumberTable
{
  std::string key;
  int rows = 0;
  int columns = 0;
  std::vector<double> values;
};

/// What every format comes down to.
struct CameraNumbers
{
  int width = 0;
  int height = 0;
  NumberTable cameraMatrix;
  NumberTable coefficients;
};

/// Checks the shapes and makes the camera. @throws FileError naming the key
CameraModel makeCamera(const std::filesystem::path& path, const CameraNumbers& numbers);

/// @throws FileError where the table is not a rigid 4x4 matrix
Eigen::Isometry3d makeRigid(const std::filesystem::path& path, const NumberTable& table);

/// The largest width or height that a camera file may name.
constexpr int LargestImageSide = 1 << 20;

/// A whole number between `smallest` and `largest`. @throws FileError naming the key
int readCount(const std::filesystem::path& path, const std::string& key, const nlohmann::json& node, int smallest, int largest);

/// A matrix as {rows, cols, data} (OpenCV, ROS), as a list of rows, or as a list: nine numbers are 3x3, others one row.
/// @throws FileError naming the key
NumberTable readTable(const std::filesystem::path& path, const std::string& key, const nlohmann::json& node);

/// OpenCV, SlicerPinholeCameras, VASST and ROS files, which differ in their keys.
CameraFile readOpenCVCamera(const std::filesystem::path& path, const nlohmann::json& root);

/// Our own calibration.json: an object with an object `camera`.
CameraFile readCalibrationCamera(const std::filesystem::path& path, const nlohmann::json& root);

/// Rows of numbers: scikit-surgery.
CameraFile readTextCamera(const std::filesystem::path& path, const std::string& text);

}  // namespace handeye::io
