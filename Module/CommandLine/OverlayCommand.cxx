// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CommandOutput.h"
#include "Commands.h"
#include "CommonOptions.h"
#include "EigenVtk.h"
#include "FileError.h"
#include "ImageFile.h"
#include "MeshReader.h"
#include "OffscreenRendering.h"
#include "OverlayPose.h"
#include "ResultFiles.h"
#include "vtkHandEyeOverlayPipeline.h"

#include <opencv2/core.hpp>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <filesystem>
#include <memory>

namespace handeye::cli
{

namespace
{

struct OverlayArguments
{
  std::string recording, calibration, model, registration, folder;
  std::string phantomTransform = "PhantomToTracker";
  std::string markerTransform;
  bool mask = false;
  std::string color;
  double opacity = -1;
  CommandOutput output;
};

cv::Mat toEightBit(const cv::Mat& image)
{
  cv::Mat eight;
  image.convertTo(eight, CV_8U, image.depth() == CV_16U ? 1.0 / 257 : 1.0);
  return eight;
}

/// Colour and opacity, where the person asked for others than the pipeline's own.
void setLook(const OverlayArguments& arguments, vtkHandEyeOverlayPipeline* pipeline)
{
  if (!arguments.color.empty())
  {
    const unsigned long rgb = std::stoul(arguments.color, nullptr, 16);
    pipeline->SetModelColor(double(rgb >> 16) / 255, double(rgb >> 8 & 0xff) / 255, double(rgb & 0xff) / 255);
  }
  if (arguments.opacity >= 0)
  {
    pipeline->SetModelOpacity(arguments.opacity);
  }
}

std::string checkColor(const std::string& text)
{
  const bool good = text.size() == 6 && text.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
  return good ? std::string() : "'" + text + "' is not a colour, six hexadecimal digits such as 30b0ff are expected";
}

std::string checkOpacity(const std::string& text)
{
  double opacity = -1;
  const bool good = CLI::detail::lexical_cast(text, opacity) && opacity >= 0 && opacity <= 1;
  return good ? std::string() : "'" + text + "' is not an opacity, a number from 0 to 1 is expected";
}

int runOverlay(const OverlayArguments& arguments)
{
  const StoredCalibration stored = readCalibration(arguments.calibration);
  const Eigen::Isometry3d modelToPhantom = readPhantomRegistration(arguments.registration);
  const vtkSmartPointer<vtkPolyData> model = readMesh(arguments.model);
  const io::Recording recording = io::Recording::open(arguments.recording);
  arguments.output.warn(recording.warnings());
  recording.requireTransform(arguments.phantomTransform);
  recording.requireTransform(arguments.markerTransform.empty() ? stored.tools.markerToTracker : arguments.markerTransform);
  const CameraModel camera = cameraForRecording(stored.camera, recording);
  std::error_code error;
  std::filesystem::create_directories(arguments.folder, error);
  if (error)
  {
    throw io::FileError(arguments.folder, "the folder cannot be made: " + error.message());
  }

  registerOffscreenRendering();
  vtkNew<vtkHandEyeOverlayPipeline> pipeline;
  pipeline->SetCameraModel(camera);
  pipeline->SetModel(model);
  pipeline->SetMaskMode(arguments.mask);
  setLook(arguments, pipeline);
  nlohmann::json frames = nlohmann::json::array();
  int drawn = 0;
  const Progress progress = arguments.output.progress("drawing, frame");
  for (int frame = 0; frame < recording.frameCount(); ++frame)
  {
    nlohmann::json row = { { "frame", frame } };
    if (!recording.hasImage(frame))
    {
      row["status"] = "image_missing";
      frames.push_back(std::move(row));
      continue;
    }
    const ModelPose pose = modelPose(recording, frame, arguments, stored, modelToPhantom);
    pipeline->SetVideoFrame(toEightBit(recording.image(frame)));
    pipeline->SetModelVisible(pose.modelToCamera.has_value());
    if (pose.modelToCamera)
    {
      vtkNew<vtkMatrix4x4> modelToCamera;
      toVtk(*pose.modelToCamera, modelToCamera);
      pipeline->SetModelToCamera(modelToCamera);
      ++drawn;
    }
    cv::Mat picture;
    pipeline->RenderToImage(picture);
    char name[32];
    std::snprintf(name, sizeof(name), "%04d.png", frame);
    const std::filesystem::path file = std::filesystem::path(arguments.folder) / name;
    io::writePng(file, picture);
    row["status"] = pose.status;
    row["file"] = file.string();
    if (!pose.modelToCamera)
    {
      row["message"] = pose.message;
      arguments.output.say("frame " + std::to_string(frame) + " has no model: " + pose.status + " (" + pose.message + ")");
    }
    frames.push_back(std::move(row));
    if (progress)
    {
      progress(frame + 1, recording.frameCount());
    }
  }
  const nlohmann::json result = { { "schema", "handeye-overlay/1" }, { "status", drawn > 0 ? "ok" : "nothing_drawn" },
    { "message", "model drawn on " + std::to_string(drawn) + " of " + std::to_string(recording.frameCount()) + " frames" },
    { "frames", frames } };
  arguments.output.say(result["message"].get<std::string>() + ", pictures in " + arguments.folder);
  return arguments.output.finish(result);
}

}  // namespace

void addOverlayCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<OverlayArguments>();
  CLI::App* command =
    app.add_subcommand("overlay", "Draw a model onto the video where the phantom is: one PNG a frame, lens distortion included");
  addRecordingArgument(*command, arguments->recording, "Images, and the poses of the camera's marker and the phantom");
  addCalibrationOption(*command, arguments->calibration);
  command->add_option("--model", arguments->model, "Surface mesh: STL, PLY, OBJ, VTP or legacy VTK, mm")
    ->required()
    ->type_name("MESH");
  command->add_option("--registration", arguments->registration, "What `handeye landmarks` wrote")
    ->required()
    ->type_name("phantom.json");
  addTransformOption(*command, "--phantom-transform", arguments->phantomTransform, "phantom's marker");
  addTransformOption(*command, "--marker-transform", arguments->markerTransform, "camera's marker");
  command->add_option("--color", arguments->color, "Colour of the model, red green blue; ivory if not given")
    ->check(CLI::Validator(checkColor, std::string()))
    ->type_name("RRGGBB");
  command->add_option("--opacity", arguments->opacity, "Opacity of the model, 0 to 1; 0.65 if not given")
    ->check(CLI::Validator(checkOpacity, std::string()))
    ->type_name("SHARE");
  command->add_flag("--mask", arguments->mask, "White where the model is, black elsewhere");
  command->add_option("-o,--output", arguments->folder, "Folder for the pictures, 0000.png and so on")
    ->required()
    ->type_name("DIR");
  arguments->output.addTo(*command, false);
  command->callback([arguments, &exitCode] { exitCode = runOverlay(*arguments); });
}

}  // namespace handeye::cli
