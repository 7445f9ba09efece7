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
#include "ResultFiles.h"
#include "vtkHandEyeOverlayPipeline.h"

#include <opencv2/core.hpp>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <filesystem>
#include <memory>
#include <optional>

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
  CommandOutput output;
};

/// Where the model is in this frame, or why that is not known.
struct ModelPose
{
  std::optional<Eigen::Isometry3d> modelToCamera;
  std::string status = "ok";
  std::string message;
};

ModelPose modelPose(const io::Recording& recording, int frame, const OverlayArguments& arguments, const StoredCalibration& stored,
  const Eigen::Isometry3d& modelToPhantom)
{
  ModelPose pose;
  const std::string markerName = arguments.markerTransform.empty() ? stored.tools.markerToTracker : arguments.markerTransform;
  const io::TransformSample marker = recording.transform(frame, markerName);
  const io::TransformSample phantom = recording.transform(frame, arguments.phantomTransform);
  if (!marker.isUsable() || !phantom.isUsable())
  {
    const io::TransformSample& lost = marker.isUsable() ? phantom : marker;
    pose.status = std::string(marker.isUsable() ? "phantom" : "marker") +
      (lost.status == io::TransformSample::Status::Missing ? "_missing" : "_invalid");
    pose.message = lost.reason;
    return pose;
  }
  const Eigen::Isometry3d trackerToCamera = stored.markerToCamera * marker.transform.inverse();
  const Eigen::Isometry3d phantomToCamera = trackerToCamera * phantom.transform;
  pose.modelToCamera = phantomToCamera * modelToPhantom;
  return pose;
}

cv::Mat toEightBit(const cv::Mat& image)
{
  cv::Mat eight;
  image.convertTo(eight, CV_8U, image.depth() == CV_16U ? 1.0 / 257 : 1.0);
  return eight;
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
  command->add_flag("--mask", arguments->mask, "White where the model is, black elsewhere");
  command->add_option("-o,--output", arguments->folder, "Folder for the pictures, 0000.png and so on")
    ->required()
    ->type_name("DIR");
  arguments->output.addTo(*command, false);
  command->callback([arguments, &exitCode] { exitCode = runOverlay(*arguments); });
}

}  // namespace handeye::cli
