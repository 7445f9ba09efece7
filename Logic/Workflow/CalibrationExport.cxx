// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CalibrationExport.h"

#include "CameraFileWriter.h"
#include "FileError.h"
#include "NamedTransform.h"
#include "ResultFiles.h"

#include <algorithm>
#include <ctime>
#include <fstream>
#include <stdexcept>

namespace handeye
{

namespace
{

/// As PLUS writes dates: "2024.05.17 13:45:01"
std::string dateNow()
{
  const std::time_t now = std::time(nullptr);
  std::tm local = {};
  localtime_r(&now, &local);
  char text[64];
  std::strftime(text, sizeof(text), "%Y.%m.%d %X", &local);
  return text;
}

/// What a JSON file has under a key; null where it is no such file, or has nothing there.
nlohmann::json entry(const std::filesystem::path& path, const char* key)
{
  std::ifstream file(path, std::ios::binary);
  const nlohmann::json object = nlohmann::json::parse(file, nullptr, false);
  return object.is_object() ? object.value(key, nlohmann::json()) : nlohmann::json();
}

/// A figure that a calibration.json carries, where the file is one.
std::optional<double> figure(const std::filesystem::path& path, const char* key)
{
  const nlohmann::json value = entry(path, key);
  return value.is_number() ? std::optional<double>(value.get<double>()) : std::nullopt;
}

/// The transforms that do not move: where the camera, the stylus' tip and the model sit on their markers.
std::vector<io::NamedTransform> fixedTransforms(
  const ExportSources& sources, const Eigen::Isometry3d& markerToCamera, std::vector<std::string>& warnings)
{
  const std::string date = dateNow();
  std::vector<io::NamedTransform> transforms = { { "Marker", "Camera", markerToCamera,
    figure(sources.calibration, "pointToLineRmsMm"), date } };
  if (!entry(sources.calibration, "markerToRightCamera").is_null())
  {
    transforms.push_back({ "Marker", "RightCamera", *readMarkerToRightCamera(sources.calibration), std::nullopt, date });
  }
  if (!sources.stylus.empty())
  {
    Eigen::Isometry3d stylusTipToStylus = Eigen::Isometry3d::Identity();
    stylusTipToStylus.translation() = readStylusTip(sources.stylus);
    const std::optional<Eigen::Isometry3d> known = readStylusTipFrame(sources.stylus);
    stylusTipToStylus = known.value_or(stylusTipToStylus);
    if (!known)
    {
      warnings.push_back(sources.stylus.string() +
        ": the direction of the shaft is not known; StylusTipToStylus has the axes of the marker (the wizard's page Stylus and "
        "`handeye spin` find the shaft)");
    }
    transforms.push_back({ "StylusTip", "Stylus", stylusTipToStylus, figure(sources.stylus, "rmsMm"), date });
  }
  if (!sources.registration.empty())
  {
    transforms.push_back(
      { "Model", "Phantom", readPhantomRegistration(sources.registration), figure(sources.registration, "rmsMm"), date });
  }
  return transforms;
}

std::vector<io::SceneModel> sceneModels(const ExportSources& sources, const std::filesystem::path& scene)
{
  if (sources.model.empty())
  {
    return {};
  }
  const std::filesystem::path mesh = std::filesystem::absolute(sources.model);
  if (!std::filesystem::is_regular_file(mesh))
  {
    throw io::FileError(sources.model, "there is no such file; a mesh was expected");
  }
  const std::filesystem::path folder = std::filesystem::absolute(scene).parent_path();
  return { { mesh.stem().string(), std::filesystem::relative(mesh, folder),
    sources.registration.empty() ? "" : "ModelToPhantom" } };
}

const ExportFormat& formatOf(const std::string& word)
{
  const std::vector<ExportFormat>& formats = exportFormats();
  const auto found = std::find_if(formats.begin(), formats.end(), [&](const ExportFormat& format) { return format.word == word; });
  if (found == formats.end())
  {
    throw std::invalid_argument("there is no export format \"" + word + "\"");
  }
  return *found;
}

}  // namespace

const std::map<std::string, io::CameraFormat>& cameraFormats()
{
  using io::CameraFormat;
  static const std::map<std::string, CameraFormat> formats = { { "opencv", CameraFormat::OpenCV },
    { "pinhole-xml", CameraFormat::PinholeXml }, { "ros", CameraFormat::Ros }, { "text", CameraFormat::SurgeryText },
    { "vasst", CameraFormat::Vasst }, { "json", CameraFormat::Json } };
  return formats;
}

const std::vector<ExportFormat>& exportFormats()
{
  static const std::vector<ExportFormat> formats = {
    { "plus", "PLUS configuration", "PlusCoordinateDefinitions.xml", false },
    { "tfm", "3D Slicer transform (ITK)", "MarkerToCamera.tfm", true },
    { "mrml", "3D Slicer scene (MRML)", "HandEyeCalibration.mrml", false },
    { "pinhole-xml", "SlicerPinholeCameras XML", "PinholeCamera.xml", true },
    { "opencv", "OpenCV camera file (YAML)", "camera_opencv.yml", true },
    { "ros", "ROS camera_info (YAML)", "camera_info_ros.yaml", true },
    { "text", "scikit-surgery text", "calib.left.intrinsics.txt", true },
    { "vasst", "VASST camera XML", "camera_vasst.xml", true },
    { "json", "JSON", "camera_handeye.json", true },
  };
  return formats;
}

ExportResult exportCalibration(const ExportSources& sources, const std::string& format, const std::filesystem::path& file)
{
  const ExportFormat& wanted = formatOf(format);
  const nlohmann::json status = entry(sources.calibration, "status");
  if (!status.is_null() && status != "ok")
  {
    throw io::FileError(sources.calibration, "is not exported: its status is " + status.dump() + ", \"ok\" was expected");
  }
  const io::CameraFile camera = io::readCameraFile(sources.calibration);
  ExportResult result;
  result.files = { file };
  result.warnings = camera.warnings;
  if (!camera.markerToCamera)
  {
    throw io::FileError(sources.calibration,
      "holds no usable markerToCamera; a calibration.json with the status \"ok\", or a camera file with the marker's place, was "
      "expected");
  }
  const std::vector<io::NamedTransform> transforms = fixedTransforms(sources, *camera.markerToCamera, result.warnings);
  if (wanted.isOneCamera && !entry(sources.calibration, "markerToRightCamera").is_null())
  {
    result.warnings.push_back("a file of the format " + format +
      " has one camera: the left one is written; the right one is left out (plus and mrml take both)");
  }
  const auto cameraKind = cameraFormats().find(format);
  if (cameraKind != cameraFormats().end())
  {
    result.files = io::writeCameraFile(file, camera, cameraKind->second, result.warnings,
      { figure(sources.calibration, "reprojectionRmsPx"), figure(sources.calibration, "pointToLineRmsMm") });
  }
  else if (format == "plus")
  {
    io::writePlusConfiguration(file, transforms);
  }
  else if (format == "tfm")
  {
    io::writeItkTransform(file, transforms[0]);
  }
  else
  {
    io::writeMrmlScene(file, transforms, sceneModels(sources, file));
  }
  return result;
}

}  // namespace handeye
