// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFileFormats.h"

#include "FileError.h"

namespace handeye::io
{

CameraFile readCalibrationCamera(const std::filesystem::path& path, const nlohmann::json& root)
{
  const nlohmann::json& camera = root["camera"];
  const auto member = [&](const char* key) { return camera.contains(key) ? camera[key] : nlohmann::json(); };
  CameraNumbers numbers;
  numbers.width = readCount(path, "camera.width", member("width"), 1, LargestImageSide);
  numbers.height = readCount(path, "camera.height", member("height"), 1, LargestImageSide);
  numbers.cameraMatrix = readTable(path, "camera.cameraMatrix", member("cameraMatrix"));
  numbers.coefficients = readTable(path, "camera.distortionCoefficients", member("distortionCoefficients"));

  CameraFile file{ makeCamera(path, numbers), std::nullopt, "calibration.json", {} };
  if (root.contains("markerToCamera") && !root["markerToCamera"].is_null())
  {
    file.markerToCamera = makeRigid(path, readTable(path, "markerToCamera", root["markerToCamera"]));
  }
  return file;
}

}  // namespace handeye::io
