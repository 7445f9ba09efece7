// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardOptions.h"
#include "CommandOutput.h"
#include "Commands.h"
#include "ExportFormats.h"
#include "NamedTransform.h"

#include <memory>

namespace handeye::cli
{

namespace
{

struct ConvertArguments
{
  std::string camera, format, markerToCamera;
  CommandOutput output;
};

int runConvert(const ConvertArguments& arguments)
{
  io::CameraFile camera = io::readCameraFile(arguments.camera);
  arguments.output.warn(camera.warnings);
  if (!arguments.markerToCamera.empty())
  {
    camera.markerToCamera = io::readTransform(arguments.markerToCamera, "MarkerToCamera");
  }
  std::vector<std::string> warnings;
  const auto written = io::writeCameraFile(arguments.output.file, camera, cameraFormats().at(arguments.format), warnings);
  arguments.output.warn(warnings);
  return finishExport(arguments.output, arguments.format, written);
}

}  // namespace

void addCameraConvertCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* command = cameraGroup(app)->add_subcommand("convert", "Read a camera file of any known kind and write it as another");
  command->add_option("camera", arguments->camera, "OpenCV, ROS, SlicerPinholeCameras, VASST, scikit-surgery or calibration.json")
    ->required()
    ->type_name("CAMERA");
  std::vector<std::string> formats;
  for (const auto& format : cameraFormats())
  {
    formats.push_back(format.first);
  }
  command->add_option("--format", arguments->format, "What to write")
    ->required()
    ->check(CLI::IsMember(formats))
    ->type_name("pinhole-xml|ros|opencv|text|vasst|json");
  command
    ->add_option("--marker-to-camera", arguments->markerToCamera,
      "Take markerToCamera from this file: PLUS configuration, .tfm, MRML scene, 4x4 text or calibration.json")
    ->type_name("FILE");
  arguments->output.addTo(*command);
  command->get_option("--output")->required();
  command->callback([arguments, &exitCode] { exitCode = runConvert(*arguments); });
}

}  // namespace handeye::cli
