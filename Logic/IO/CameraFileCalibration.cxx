// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFileFormats.h"

#include "FileError.h"

namespace handeye::io
{

namespace
{

CameraModel readEye(const std::filesystem::path& path, const nlohmann::json& root, const std::string& name)
{
  const nlohmann::json& camera = root[name];
  const auto member = [&](const char* key) { return camera.contains(key) ? camera[key] : nlohmann::json(); };
  CameraNumbers numbers;
  numbers.width = readCount(path, name + ".width", member("width"), 1, LargestImageSide);
  numbers.height = readCount(path, name + ".height", member("height"), 1, LargestImageSide);
  numbers.cameraMatrix = readTable(path, name + ".cameraMatrix", member("cameraMatrix"));
  numbers.coefficients = readTable(path, name + ".distortionCoefficients", member("distortionCoefficients"));
  return makeCamera(path, numbers);
}

}  // namespace

CameraFile readCalibrationCamera(const std::filesystem::path& path, const nlohmann::json& root)
{
  CameraFile file{ readEye(path, root, "camera"), std::nullopt, "calibration.json", {} };
  if (root.contains("rightCamera") && root["rightCamera"].is_object())
  {
    file.rightCamera = readEye(path, root, "rightCamera");
  }
  if (root.contains("markerToCamera") && !root["markerToCamera"].is_null())
  {
    file.markerToCamera = makeRigid(path, readTable(path, "markerToCamera", root["markerToCamera"]));
  }
  return file;
}

}  // namespace handeye::io
