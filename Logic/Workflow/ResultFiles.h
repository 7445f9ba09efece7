// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CalibrationStep.h"
#include "LandmarkRegistration.h"
#include "PivotStep.h"
#include "PointLineRegistration.h"
#include "ValidationStep.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <vector>

namespace handeye
{

/// The result files, keys as other programs rely on them (millimetres, pixels; matrices as lists of rows). Every object has
/// `schema` (the kind of file and its version), `status` and `message`. A result that is not usable carries no transform and no
/// tip: there is no identity to mistake for an answer.

nlohmann::json stylusJson(const PivotStepResult& result);                ///< stylus.json
nlohmann::json calibrationJson(const CalibrationStepResult& result);     ///< calibration.json
nlohmann::json validationJson(const ValidationStepResult& result);       ///< validation.json
nlohmann::json phantomJson(const LandmarkRegistrationResult& result);    ///< phantom.json
nlohmann::json detectionJson(const std::vector<CapturedFrame>& frames);  ///< what `handeye detect` prints
nlohmann::json registrationJson(const PointLineResult& result);          ///< what `handeye register` prints

/// Writes a result with two spaces of indentation, atomically. @throws io::FileError
void writeJson(const std::filesystem::path& path, const nlohmann::json& json);

/// All of a result file, to be kept as it is. @param key one that its kind has: "tip_Stylus_Mm"
/// @throws io::FileError if it is no such file, or its status is not "ok"
nlohmann::json readResult(const std::filesystem::path& path, const char* key);

/// What later steps need of a stylus.json. @throws io::FileError naming the key; also where the file's status is not "ok"
Eigen::Vector3d readStylusTip(const std::filesystem::path& path);

/// The tip's covariance (mm^2) of a stylus.json, zero where the file does not hold it. @throws io::FileError where it is none
Eigen::Matrix3d readStylusTipCovariance(const std::filesystem::path& path);

/// stylusTipToStylus of a stylus.json (p_Stylus = stylusTipToStylus * p_StylusTip, mm): with the shaft's direction where `handeye
/// spin` has added it, nothing otherwise. @throws io::FileError naming the key
std::optional<Eigen::Isometry3d> readStylusTipFrame(const std::filesystem::path& path);

/// All of a stylus.json, to be written again with more in it. @throws io::FileError as readStylusTip()
nlohmann::json readStylus(const std::filesystem::path& path);

/// What later steps need of a calibration.json.
struct StoredCalibration
{
  Eigen::Isometry3d markerToCamera = Eigen::Isometry3d::Identity();
  CameraModel camera;
  Eigen::Vector3d tip_Stylus = Eigen::Vector3d::Zero();
  double ballRadiusMm = 0;
  ToolNames tools;
};

/// @throws io::FileError naming the key; also where the file's status is not "ok"
StoredCalibration readCalibration(const std::filesystem::path& path);

/// The covariance (rotation vector rad, translation mm; camera frame) of a calibration.json; nothing where the file does not hold
/// it.
/// @throws io::FileError where it is none
std::optional<Eigen::Matrix<double, 6, 6>> readCalibrationCovariance(const std::filesystem::path& path);

/// markerToRightCamera of a stereo rig's calibration.json; nothing where it has one camera. @throws io::FileError naming the key
std::optional<Eigen::Isometry3d> readMarkerToRightCamera(const std::filesystem::path& path);

/// modelToPhantom of a phantom.json. @throws io::FileError naming the key; also where the file's status is not "ok"
Eigen::Isometry3d readPhantomRegistration(const std::filesystem::path& path);

}  // namespace handeye
