// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OverlayWriter.h"

#include "CameraFile.h"
#include "CommonOptions.h"
#include "EigenVtk.h"
#include "EightBitImage.h"
#include "FileError.h"
#include "ImageFile.h"
#include "MeshReader.h"
#include "OffscreenRendering.h"
#include "SpinCalibration.h"
#include "TimedPose.h"

#include <opencv2/core.hpp>
#include <vtkMatrix4x4.h>

#include <cstdio>
#include <filesystem>

namespace handeye::cli
{

namespace
{

io::SequenceMetafileWriterOptions transformsOnly()
{
  io::SequenceMetafileWriterOptions options;
  options.transformsOnly = true;
  return options;
}

io::SequenceFrame sequenceFrame(double timeSec, const OverlayTransformSet& transforms)
{
  io::SequenceFrame frame;
  frame.timestampSec = timeSec;
  for (const auto& [name, transform] : transforms)
  {
    const Eigen::Matrix4d matrix = transform ? transform->matrix() : Eigen::Matrix4d(Eigen::Matrix4d::Identity());
    frame.transforms[name] = { matrix, transform ? "OK" : "INVALID" };
  }
  return frame;
}

/// Colour, opacity and looks, where the person asked for others than the pipeline's own.
void setLook(const OverlayArguments& arguments, vtkHandEyeOverlayPipeline* pipeline)
{
  pipeline->SetMaskMode(arguments.mask);
  pipeline->SetLook(overlayLookOf(arguments));
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

}  // namespace

OverlayEye::OverlayEye(const OverlayArguments& arguments, const StoredCalibration& stored, const io::Recording& recording,
  const CalibratedEye& eye, vtkPolyData* model, vtkHandEyeOverlayPipeline* pipeline)
  : arguments_(arguments)
  , recording_(recording)
  , camera_(cameraForRecording(eye.camera, recording))
  , transformsOfRig_{ eye.markerToCamera, readPhantomRegistration(arguments.registration) }
  , tools_(stored.tools)
  , latencySec_(chooseLatency(arguments.latencySec, stored.tools.latencySec, arguments.output))
  , model_(model)
  , pipeline_(pipeline)
{
  tools_.markerToTracker = arguments.markerTransform.empty() ? tools_.markerToTracker : arguments.markerTransform;
  tools_.stylusToTracker = arguments.stylusTransform.empty() ? tools_.stylusToTracker : arguments.stylusTransform;
  arguments.output.warn(latencyNotes(recording, latencySec_));
  recording.requireTransform(arguments.phantomTransform);
  recording.requireTransform(tools_.markerToTracker);
  pipeline->SetCameraModel(camera_);
  pipeline->SetModel(model);
  pipeline->SetCalibrationCovariance(eye.covariance);
  setLook(arguments, pipeline);
  if (arguments.stylus.empty())
  {
    return;
  }
  recording.requireTransform(tools_.stylusToTracker);
  const std::optional<Eigen::Isometry3d> frame = readStylusTipFrame(arguments.stylus);
  Eigen::Isometry3d tipAlone = Eigen::Isometry3d::Identity();
  tipAlone.translation() = readStylusTip(arguments.stylus);
  stylusTipToStylus_ = frame.value_or(tipAlone);
  StylusShape shape;
  shape.ballRadiusMm = stored.ballRadiusMm;
  shape.shaftRadiusMm = arguments.shaftRadiusMm;
  shape.shaftLengthMm = arguments.shaftLengthMm;
  shape.rayLengthMm = arguments.rayLengthMm;
  shape.hasShaft = frame.has_value();
  pipeline->SetStylusShape(shape);
}

std::optional<Eigen::Isometry3d> OverlayEye::fadedPose(const OverlayPose& pose, int frame, double timeSec, nlohmann::json& row)
{
  const auto look = [&](const std::string& name, std::optional<double>& seenSec)
  {
    if (poseOfFrame(recording_, frame, name, latencySec_).isUsable())
    {
      seenSec = timeSec;
    }
  };
  look(tools_.markerToTracker, markerSeenSec_);
  look(arguments_.phantomTransform, phantomSeenSec_);
  placedSec_ = pose.isUsable() ? timeSec : placedSec_;
  const std::vector<ToolSight> tools = { { "phantom", phantomSeenSec_ }, { "camera's marker", markerSeenSec_ } };
  const PoseAge age = judgePoseAge(tools, placedSec_, timeSec);
  // A model that was never placed (the tools were seen, but never together) is not there to fade.
  const bool shown = age.isUsable() && (pose.isUsable() || lastModelToCamera_);
  pipeline_->SetFade(age.opacity);
  const std::string sentence = age.message.empty() ? pose.message : age.message;
  pipeline_->SetNotice(pose.isUsable() ? std::string() : sentence);
  row["opacity"] = shown ? age.opacity : 0.0;
  row["poseAge"] = toString(age.status);
  return pose.isUsable() ? pose.modelToCamera : (shown ? lastModelToCamera_ : std::nullopt);
}

void OverlayEye::setStylus(int frame)
{
  if (!stylusTipToStylus_)
  {
    return;
  }
  const io::TransformSample marker = poseOfFrame(recording_, frame, tools_.markerToTracker, latencySec_);
  const io::TransformSample stylus = poseOfFrame(recording_, frame, tools_.stylusToTracker, latencySec_);
  transforms_["StylusTipToCamera"].reset();
  pipeline_->SetStylusTipToCamera(nullptr);
  if (marker.isUsable() && stylus.isUsable())
  {
    transforms_["StylusTipToCamera"] =
      toStylusTipToCamera(transformsOfRig_.markerToCamera, marker.transform, stylus.transform, *stylusTipToStylus_);
    pipeline_->SetStylusTipToCamera(toVtk(*transforms_["StylusTipToCamera"]));
  }
}

nlohmann::json OverlayEye::set(int frame, double timeSec)
{
  nlohmann::json row;
  OverlayPose pose =
    overlayPose(recording_, frame, tools_.markerToTracker, arguments_.phantomTransform, transformsOfRig_, latencySec_);
  if (pose.modelToCamera && arguments_.smooth)
  {
    const SmoothedPose smooth = smoother_.add(timeSec, *pose.modelToCamera);
    pose.modelToCamera = smooth.transform;
    row["smoothingDelaySec"] = smooth.delaySec;
  }
  std::optional<Eigen::Isometry3d> shown = pose.modelToCamera;
  if (arguments_.fade)
  {
    shown = fadedPose(pose, frame, timeSec, row);
  }
  pipeline_->SetVideoFrame(toEightBit(recording_.image(frame)));
  pipeline_->SetModelVisible(shown.has_value());
  row["status"] = pose.status;
  row["message"] = pose.message;
  isDrawn_ = false;
  transforms_["ModelToCamera"] = shown;
  if (shown)
  {
    pipeline_->SetModelToCamera(toVtk(*shown));
    isDrawn_ = isInView(*shown);
    if (!isDrawn_ && pose.isUsable())
    {
      row["status"] = "out_of_view";
      row["message"] = "no point of the model is in the picture";
    }
  }
  if (pose.isUsable())
  {
    lastModelToCamera_ = pose.modelToCamera;
  }
  setStylus(frame);
  if (const std::optional<double> errorPx = pipeline_->GetPredictedErrorPx(); errorPx && isDrawn_)
  {
    row["predictedErrorPx"] = *errorPx;
  }
  return row;
}

bool OverlayEye::isInView(const Eigen::Isometry3d& modelToCamera) const
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

OverlayWriter::OverlayWriter(const OverlayArguments& arguments, const StoredCalibration& stored, const io::Recording& recording)
  : arguments_(arguments)
  , recording_(recording)
  , model_(readMesh(arguments.model))
{
  registerOffscreenRendering();
  vtkHandEyeOverlayPipeline* left = arguments.isStereo() ? stereo_->GetLeft() : pipeline_.Get();
  leftEye_ = std::make_unique<OverlayEye>(arguments, stored, recording,
    CalibratedEye{ stored.camera, stored.markerToCamera, readCalibrationCovariance(arguments.calibration) }, model_, left);
  if (arguments.isStereo())
  {
    setUpRight(stored);
  }
  metafile_ =
    std::make_unique<io::SequenceMetafileWriter>(std::filesystem::path(arguments.folder) / "transforms.igs.mha", transformsOnly());
  if (!arguments.video.empty())
  {
    OverlayRecorderOptions options;
    options.framesPerSec = arguments.framesPerSec;
    video_ = std::make_unique<OverlayRecorder>(arguments.video, options);
  }
}

void OverlayWriter::setUpRight(const StoredCalibration& stored)
{
  right_ = io::Recording::open(arguments_.right);
  const std::optional<Eigen::Isometry3d> markerToRightCamera = readMarkerToRightCamera(arguments_.calibration);
  if (!markerToRightCamera)
  {
    throw io::FileError(arguments_.calibration, "\"markerToRightCamera\": the calibration is of one camera, not of a stereo rig");
  }
  if (right_->frameCount() != recording_.frameCount())
  {
    throw io::FileError(arguments_.right,
      "the right eye has " + std::to_string(right_->frameCount()) + " frames, the left one " +
        std::to_string(recording_.frameCount()));
  }
  const std::optional<CameraModel> camera = arguments_.rightCamera.empty() ? io::readCameraFile(arguments_.calibration).rightCamera
                                                                           : io::readCameraFile(arguments_.rightCamera).camera;
  if (!camera)
  {
    throw CLI::ValidationError("--right-camera", "the calibration does not hold the right eye's lens, a camera file is expected");
  }
  const CalibratedEye eye{ *camera, *markerToRightCamera, readRightCalibrationCovariance(arguments_.calibration) };
  rightEye_ = std::make_unique<OverlayEye>(arguments_, stored, *right_, eye, model_, stereo_->GetRight());
  stereo_->SetLayout(stereoLayoutOf(arguments_.stereo));
  stereo_->SetSwapped(arguments_.swapped);
}

nlohmann::json OverlayWriter::draw(int frame)
{
  const double timeSec = recording_.timestampSec(frame).value_or(frame / arguments_.framesPerSec);
  if (!recording_.hasImage(frame) || (right_ && !right_->hasImage(frame)))
  {
    metafile_->append(sequenceFrame(timeSec, { { "ModelToCamera", std::nullopt } }));  // frames keep their numbers
    return { { "frame", frame }, { "status", "image_missing" } };
  }
  nlohmann::json row = leftEye_->set(frame, timeSec);
  OverlayTransformSet transforms = leftEye_->transforms();
  bool isDrawn = leftEye_->isDrawn();
  cv::Mat picture;
  if (rightEye_)
  {
    row["right"] = rightEye_->set(frame, timeSec);
    transforms["ModelToRightCamera"] = rightEye_->transforms().at("ModelToCamera");
    isDrawn = isDrawn || rightEye_->isDrawn();
    stereo_->RenderToImage(picture);
  }
  else
  {
    pipeline_->RenderToImage(picture);
  }
  drawn_ += isDrawn ? 1 : 0;
  char name[32];
  std::snprintf(name, sizeof(name), "%04d.png", frame);
  const std::filesystem::path file = std::filesystem::path(arguments_.folder) / name;
  io::writePng(file, picture);
  metafile_->append(sequenceFrame(timeSec, transforms));
  if (video_)
  {
    video_->append(picture, timeSec, transforms);
  }
  row["frame"] = frame;
  row["file"] = file.string();
  return say(frame, std::move(row));
}

nlohmann::json OverlayWriter::say(int frame, nlohmann::json row) const
{
  const std::string status = row.at("status"), message = row.at("message");
  if (status == "ok")
  {
    row.erase("message");
  }
  else
  {
    const bool faded = row.value("opacity", 0.0) > 0;
    arguments_.output.say(
      "frame " + std::to_string(frame) + (faded ? " has a fading model: " : " has no model: ") + status + " (" + message + ")");
  }
  return row;
}

void OverlayWriter::close()
{
  metafile_->close();
  if (video_)
  {
    const std::string encoder = video_->encoder();
    video_->close();
    arguments_.output.say("video (" + encoder + ") in " + arguments_.video);
  }
}

}  // namespace handeye::cli
