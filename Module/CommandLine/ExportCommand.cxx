// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFileWriter.h"
#include "CommandOutput.h"
#include "Commands.h"
#include "ExportFormats.h"
#include "FileError.h"
#include "NamedTransform.h"
#include "ResultFiles.h"

#include <ctime>
#include <fstream>
#include <iostream>
#include <memory>

namespace handeye::cli
{

namespace
{

struct ExportArguments
{
  std::string calibration, format, stylus, registration, model;
  CommandOutput output;
};

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
nlohmann::json entry(const std::string& path, const char* key)
{
  std::ifstream file(path, std::ios::binary);
  const nlohmann::json object = nlohmann::json::parse(file, nullptr, false);
  return object.is_object() ? object.value(key, nlohmann::json()) : nlohmann::json();
}

/// A figure that a calibration.json carries, where the file is one.
std::optional<double> figure(const std::string& path, const char* key)
{
  const nlohmann::json value = entry(path, key);
  return value.is_number() ? std::optional<double>(value.get<double>()) : std::nullopt;
}

/// The transforms that do not move: where the camera, the stylus' tip and the model sit on their markers.
std::vector<io::NamedTransform> fixedTransforms(const ExportArguments& arguments, const Eigen::Isometry3d& markerToCamera)
{
  const std::string date = dateNow();
  std::vector<io::NamedTransform> transforms = { { "Marker", "Camera", markerToCamera,
    figure(arguments.calibration, "pointToLineRmsMm"), date } };
  if (!entry(arguments.calibration, "markerToRightCamera").is_null())
  {
    transforms.push_back({ "Marker", "RightCamera", *readMarkerToRightCamera(arguments.calibration), std::nullopt, date });
  }
  if (!arguments.stylus.empty())
  {
    Eigen::Isometry3d stylusTipToStylus = Eigen::Isometry3d::Identity();
    stylusTipToStylus.translation() = readStylusTip(arguments.stylus);
    const std::optional<Eigen::Isometry3d> known = readStylusTipFrame(arguments.stylus);
    stylusTipToStylus = known.value_or(stylusTipToStylus);
    if (!known)
    {
      arguments.output.warn({ arguments.stylus +
        ": the direction of the shaft is not known; StylusTipToStylus has the axes of the marker. `handeye spin` finds it" });
    }
    transforms.push_back({ "StylusTip", "Stylus", stylusTipToStylus, figure(arguments.stylus, "rmsMm"), date });
  }
  if (!arguments.registration.empty())
  {
    transforms.push_back(
      { "Model", "Phantom", readPhantomRegistration(arguments.registration), figure(arguments.registration, "rmsMm"), date });
  }
  return transforms;
}

std::vector<io::SceneModel> sceneModels(const ExportArguments& arguments)
{
  if (arguments.model.empty())
  {
    return {};
  }
  const std::filesystem::path mesh = std::filesystem::absolute(arguments.model);
  if (!std::filesystem::is_regular_file(mesh))
  {
    throw io::FileError(arguments.model, "there is no such file; a mesh was expected");
  }
  const std::filesystem::path folder = std::filesystem::absolute(arguments.output.file).parent_path();
  return { { mesh.stem().string(), std::filesystem::relative(mesh, folder),
    arguments.registration.empty() ? "" : "ModelToPhantom" } };
}

int runExport(ExportArguments& arguments)
{
  const io::CameraFile camera = io::readCameraFile(arguments.calibration);
  arguments.output.warn(camera.warnings);
  if (!camera.markerToCamera)
  {
    throw io::FileError(arguments.calibration,
      "holds no usable markerToCamera; a calibration.json with the status \"ok\", or a camera "
      "file with the marker's place, was expected");
  }
  const std::string file = arguments.output.file;
  std::vector<std::filesystem::path> written = { file };
  const std::vector<io::NamedTransform> transforms = fixedTransforms(arguments, *camera.markerToCamera);
  const bool isOneCamera = arguments.format != "plus" && arguments.format != "mrml";
  if (isOneCamera && !entry(arguments.calibration, "markerToRightCamera").is_null())
  {
    arguments.output.warn({ "a file of the format " + arguments.format +
      " has one camera: the left one is written; the right one is left out (plus and mrml take both)" });
  }
  if (arguments.format == "plus")
  {
    io::writePlusConfiguration(file, transforms);
  }
  else if (arguments.format == "tfm")
  {
    io::writeItkTransform(file, transforms[0]);
  }
  else if (arguments.format == "mrml")
  {
    io::writeMrmlScene(file, transforms, sceneModels(arguments));
  }
  else
  {
    std::vector<std::string> warnings;
    written = io::writeCameraFile(file, camera, cameraFormats().at(arguments.format), warnings,
      { figure(arguments.calibration, "reprojectionRmsPx"), figure(arguments.calibration, "pointToLineRmsMm") });
    arguments.output.warn(warnings);
  }
  return finishExport(arguments.output, arguments.format, written);
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

int finishExport(const CommandOutput& output, const std::string& format, const std::vector<std::filesystem::path>& written)
{
  nlohmann::json result = { { "schema", "handeye-export/1" }, { "status", "ok" }, { "message", "written as " + format } };
  for (const std::filesystem::path& path : written)
  {
    result["files"].push_back(path.string());
    output.say("written to " + path.string());
  }
  if (output.json)
  {
    std::cout << result.dump(2) << std::endl;
  }
  return Good;
}

void addExportCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand("export", "Write a calibration in the formats of other programs");
  command->add_option("calibration", arguments->calibration, "calibration.json, or another file with a lens and the marker's place")
    ->required()
    ->type_name("CALIBRATION");
  std::vector<std::string> formats = { "plus", "tfm", "mrml" };
  for (const auto& format : cameraFormats())
  {
    formats.push_back(format.first);
  }
  command->add_option("--format", arguments->format, "What to write")
    ->required()
    ->check(CLI::IsMember(formats))
    ->type_name("plus|tfm|mrml|pinhole-xml|ros|opencv|text|vasst|json");
  command->add_option("--stylus", arguments->stylus, "stylus.json: adds StylusTipToStylus (plus, mrml)")->type_name("FILE");
  CLI::Option* registration =
    command->add_option("--registration", arguments->registration, "phantom.json: adds ModelToPhantom (plus, mrml)")
      ->type_name("FILE");
  command->add_option("--model", arguments->model, "Mesh that the scene shows (mrml)")->type_name("MESH")->needs(registration);
  arguments->output.addTo(*command);
  command->get_option("--output")->required();
  command->callback([arguments, &exitCode] { exitCode = runExport(*arguments); });
}

}  // namespace handeye::cli
