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
#include "TimedPose.h"
#include "vtkHandEyeOverlayPipeline.h"

#include <opencv2/core.hpp>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <cstdio>
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
  std::optional<double> latencySec;
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

void makeFolder(const std::filesystem::path& folder)
{
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
  {
    throw io::FileError(folder, "the folder cannot be made: " + error.message());
  }
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

/// Draws the model onto the frames of a recording, one PNG a frame.
class OverlayWriter
{
public:
  OverlayWriter(const OverlayArguments& arguments, const StoredCalibration& stored, const io::Recording& recording)
    : arguments_(arguments)
    , recording_(recording)
    , transforms_{ stored.markerToCamera, readPhantomRegistration(arguments.registration) }
    , camera_(cameraForRecording(stored.camera, recording))
    , markerTransform_(arguments.markerTransform.empty() ? stored.tools.markerToTracker : arguments.markerTransform)
    , latencySec_(chooseLatency(arguments.latencySec, stored.tools.latencySec, arguments.output))
  {
    arguments.output.warn(latencyNotes(recording, latencySec_));
    recording.requireTransform(arguments.phantomTransform);
    recording.requireTransform(markerTransform_);
    model_ = readMesh(arguments.model);
    registerOffscreenRendering();
    pipeline_->SetCameraModel(camera_);
    pipeline_->SetModel(model_);
    pipeline_->SetMaskMode(arguments.mask);
    setLook(arguments, pipeline_);
  }

  /// @return what became of the frame, for the result
  nlohmann::json draw(int frame)
  {
    if (!recording_.hasImage(frame))
    {
      return { { "frame", frame }, { "status", "image_missing" } };
    }
    const OverlayPose pose =
      overlayPose(recording_, frame, markerTransform_, arguments_.phantomTransform, transforms_, latencySec_);
    pipeline_->SetVideoFrame(toEightBit(recording_.image(frame)));
    pipeline_->SetModelVisible(pose.isUsable());
    std::string status = pose.status, message = pose.message;
    if (pose.modelToCamera)
    {
      pipeline_->SetModelToCamera(toVtk(*pose.modelToCamera));
      const bool inView = isInView(*pose.modelToCamera);
      status = inView ? status : "out_of_view";
      message = inView ? message : "no point of the model is in the picture";
      drawn_ += inView ? 1 : 0;
    }
    cv::Mat picture;
    pipeline_->RenderToImage(picture);
    char name[32];
    std::snprintf(name, sizeof(name), "%04d.png", frame);
    const std::filesystem::path file = std::filesystem::path(arguments_.folder) / name;
    io::writePng(file, picture);
    nlohmann::json row = { { "frame", frame }, { "status", status }, { "file", file.string() } };
    if (status != "ok")
    {
      row["message"] = message;
      arguments_.output.say("frame " + std::to_string(frame) + " has no model: " + status + " (" + message + ")");
    }
    return row;
  }

  int drawn() const { return drawn_; }

private:
  /// Whether any point of the model projects into the picture.
  bool isInView(const Eigen::Isometry3d& modelToCamera) const
  {
    for (vtkIdType i = 0; i < model_->GetNumberOfPoints(); ++i)
    {
      const Eigen::Vector3d point_Camera = modelToCamera * Eigen::Map<const Eigen::Vector3d>(model_->GetPoint(i));
      const CameraModel::Projection seen = camera_.project(point_Camera);
      const Eigen::Vector2d& pixel = seen.point_Image;
      if (seen.isUsable() && pixel.x() > -0.5 && pixel.y() > -0.5 && pixel.x() < camera_.width() - 0.5 &&
        pixel.y() < camera_.height() - 0.5)
      {
        return true;
      }
    }
    return false;
  }

  const OverlayArguments& arguments_;
  const io::Recording& recording_;
  OverlayTransforms transforms_;
  CameraModel camera_;
  std::string markerTransform_;
  double latencySec_;
  vtkSmartPointer<vtkPolyData> model_;
  vtkNew<vtkHandEyeOverlayPipeline> pipeline_;
  int drawn_ = 0;
};

int runOverlay(const OverlayArguments& arguments)
{
  const StoredCalibration stored = readCalibration(arguments.calibration);
  const io::Recording recording = io::Recording::open(arguments.recording);
  arguments.output.warn(recording.warnings());
  OverlayWriter writer(arguments, stored, recording);
  makeFolder(arguments.folder);
  nlohmann::json frames = nlohmann::json::array();
  const Progress progress = arguments.output.progress("drawing, frame");
  for (int frame = 0; frame < recording.frameCount(); ++frame)
  {
    frames.push_back(writer.draw(frame));
    if (progress)
    {
      progress(frame + 1, recording.frameCount());
    }
  }
  const std::string message =
    "model drawn on " + std::to_string(writer.drawn()) + " of " + std::to_string(recording.frameCount()) + " frames";
  arguments.output.say(message + ", pictures in " + arguments.folder);
  return arguments.output.finish({ { "schema", "handeye-overlay/1" }, { "status", writer.drawn() > 0 ? "ok" : "nothing_drawn" },
    { "message", message }, { "frames", frames } });
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
  addLatencyOption(*command, arguments->latencySec);
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
