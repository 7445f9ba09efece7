// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSlicerHandEyeCalibrationLogic.h"

#include "CameraFile.h"
#include "EigenVtk.h"
#include "Recording.h"
#include "vtkSlicerHandEyeCalibrationLogicInternals.h"

#include <vtkObjectFactory.h>
#include <vtkPoints.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

vtkStandardNewMacro(vtkSlicerHandEyeCalibrationLogic);

namespace
{

using handeye::io::Recording;

handeye::EyeCapture withoutExcluded(handeye::EyeCapture eye, const std::set<int>& excluded)
{
  for (handeye::CapturedFrame& captured : eye.frames)
  {
    if (captured.isSample() && excluded.count(captured.frame) > 0)
    {
      captured.status = "excluded";
      captured.message = "left out by the user";
    }
  }
  return eye;
}

bool isSamePlace(const std::string& a, const std::string& b)
{
  std::error_code error;
  return std::filesystem::equivalent(a, b, error) && !error;
}

std::string stoppedAfter(std::size_t done, const Recording& recording)
{
  return "stopped on request after " + std::to_string(done) + " of " + std::to_string(recording.frameCount()) +
    " frames; nothing was changed";
}

}  // namespace

vtkSlicerHandEyeCalibrationLogic::vtkSlicerHandEyeCalibrationLogic()
  : StylusTransform(handeye::ToolNames().stylusToTracker)
  , MarkerTransform(handeye::ToolNames().markerToTracker)
  , Internal(std::make_unique<Internals>())
{
  this->Internal->UpdateSampleTable();
  this->Internal->UpdateValidationTable();
}

vtkSlicerHandEyeCalibrationLogic::~vtkSlicerHandEyeCalibrationLogic() = default;

void vtkSlicerHandEyeCalibrationLogic::PrintSelf(std::ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "CameraFile: " << this->CameraFile << "\n";
  os << indent << "BallRadiusMm: " << this->BallRadiusMm << "\n";
  os << indent << "SegmentationMethod: " << (this->SegmentationMethod == HoughSegmentation ? "hough" : "exact") << "\n";
  os << indent << "SolverMethod: " << (this->SolverMethod == ProcrustesSolver ? "procrustes" : "global") << "\n";
  os << indent << "StylusTransform: " << this->StylusTransform << "\n";
  os << indent << "MarkerTransform: " << this->MarkerTransform << "\n";
  os << indent << "Stylus: " << (this->Internal->Stylus ? "known" : "none") << "\n";
  os << indent << "Calibration: " << (this->Internal->Calibration ? "known" : "none") << "\n";
  os << indent << "Validation: " << (this->Internal->Validation ? "known" : "none") << "\n";
  os << indent << "Phantom: " << (this->Internal->Phantom ? "known" : "none") << "\n";
  os << indent << "LastMessage: " << this->Internal->LastMessage << "\n";
}

void vtkSlicerHandEyeCalibrationLogic::SetMRMLSceneInternal(vtkMRMLScene* newScene)
{
  this->Superclass::SetMRMLSceneInternal(newScene);
}

void vtkSlicerHandEyeCalibrationLogic::RegisterNodes()
{
  this->Superclass::RegisterNodes();
}

void vtkSlicerHandEyeCalibrationLogic::UpdateFromMRMLScene()
{
  this->Superclass::UpdateFromMRMLScene();
}

void vtkSlicerHandEyeCalibrationLogic::OnMRMLSceneNodeAdded(vtkMRMLNode* node)
{
  this->Superclass::OnMRMLSceneNodeAdded(node);
}

void vtkSlicerHandEyeCalibrationLogic::OnMRMLSceneNodeRemoved(vtkMRMLNode* node)
{
  this->Superclass::OnMRMLSceneNodeRemoved(node);
}

bool vtkSlicerHandEyeCalibrationLogic::RunStep(unsigned long event, const std::function<StepEnd()>& step)
{
  StepEnd end;
  if (this->Internal->IsRunning)
  {
    end.message = "another step is still running";
  }
  else
  {
    this->Internal->IsRunning = true;
    this->Internal->CancelRequested = false;
    this->Internal->LastWarnings.clear();
    try
    {
      end = step();
    }
    catch (const std::exception& error)
    {
      end = { false, error.what() };
    }
    // Before the event, so that its observers may go on with the next step.
    this->Internal->IsRunning = false;
  }
  this->Internal->LastMessage = end.message;
  this->Modified();
  if (!end.isUsable)
  {
    this->InvokeEvent(StepFailedEvent);
  }
  else if (event != vtkCommand::NoEvent)
  {
    this->InvokeEvent(event);
  }
  if (!this->Internal->IsRunning)
  {
    for (const std::function<bool()>& forget : std::exchange(this->Internal->Forgetting, {}))
    {
      this->Forget(forget);
    }
  }
  return end.isUsable;
}

bool vtkSlicerHandEyeCalibrationLogic::ReportProgress(int done, int total)
{
  double share = double(done) / std::max(total, 1);
  this->InvokeEvent(ProgressEvent, &share);
  return !this->Internal->CancelRequested;
}

void vtkSlicerHandEyeCalibrationLogic::RequestCancel()
{
  this->Internal->CancelRequested = true;
}

bool vtkSlicerHandEyeCalibrationLogic::CalibrateStylus(const std::string& recording)
{
  return this->RunStep(StylusCalibratedEvent,
    [&]() -> StepEnd
    {
      const Recording opened = Recording::open(recording);
      this->Internal->Warn(opened.warnings());
      const handeye::PivotStepResult result = handeye::pivotFromRecording(opened, this->StylusTransform);
      const handeye::PivotCalibrationResult& calibration = result.calibration;
      if (calibration.isUsable())
      {
        this->Internal->Stylus = { calibration.tip_Stylus, handeye::stylusJson(result), result, recording };
      }
      return { calibration.isUsable(), calibration.message };
    });
}

bool vtkSlicerHandEyeCalibrationLogic::CalibrateCamera(const std::string& recording)
{
  return this->RunStep(CameraCalibratedEvent,
    [&]() -> StepEnd
    {
      if (!this->Internal->Stylus)
      {
        return { false, "the stylus' tip is not known: calibrate the stylus or load its calibration first" };
      }
      if (this->CameraFile.empty())
      {
        return { false, "the camera's lens is not known: no camera file is set" };
      }
      if (!(this->BallRadiusMm > 0))
      {
        return { false, "the ball's radius is not known: a number of millimetres above zero is expected" };
      }
      const handeye::io::CameraFile file = handeye::io::readCameraFile(this->CameraFile);
      const Recording opened = Recording::open(recording);
      this->Internal->Warn(file.warnings);
      this->Internal->Warn(opened.warnings());
      handeye::BallDetectionOptions options;
      options.method = this->SegmentationMethod == HoughSegmentation ? handeye::BallDetectionOptions::Method::Hough
                                                                     : handeye::BallDetectionOptions::Method::Exact;
      Internals::EvaluatedCapture capture{ { handeye::cameraForRecording(file.camera, opened), {} },
        { this->StylusTransform, this->MarkerTransform }, this->Internal->Stylus->tip_Stylus, this->BallRadiusMm, recording, {},
        {} };
      capture.eye.frames = handeye::readCapture(opened, capture.tools, capture.eye.camera, capture.tip_Stylus, capture.ballRadiusMm,
        options, [this](int done, int total) { return this->ReportProgress(done, total); });
      if (this->Internal->CancelRequested)
      {
        return { false, stoppedAfter(capture.eye.frames.size(), opened) };
      }
      return this->Internal->Calibrate(std::move(capture), this->SolverMethod);
    });
}

bool vtkSlicerHandEyeCalibrationLogic::Recalibrate()
{
  return this->RunStep(CameraCalibratedEvent,
    [&]() -> StepEnd
    {
      if (!this->Internal->Capture)
      {
        return { false, "there is no capture to calibrate from again: calibrate the camera first" };
      }
      return this->Internal->Calibrate(*this->Internal->Capture, this->SolverMethod);
    });
}

vtkSlicerHandEyeCalibrationLogic::StepEnd vtkSlicerHandEyeCalibrationLogic::Internals::Calibrate(
  EvaluatedCapture capture, SolverMethods method)
{
  handeye::HandEyeCalibrationOptions options;
  options.method = method == ProcrustesSolver ? handeye::PointLineOptions::Method::Procrustes
                                              : handeye::PointLineOptions::Method::MaximumLikelihood;
  handeye::CalibrationStepResult result = handeye::calibrateCapture(withoutExcluded(capture.eye, capture.excluded), options);
  result.tip_Stylus = capture.tip_Stylus;
  result.ballRadiusMm = capture.ballRadiusMm;
  result.tools = capture.tools;
  const handeye::HandEyeCalibrationResult& calibration = result.calibration;
  if (calibration.isUsable())
  {
    this->Calibration = { { calibration.markerToCamera, result.camera, result.tip_Stylus, result.ballRadiusMm, result.tools },
      handeye::toVtk(calibration.markerToCamera), handeye::calibrationJson(result), result, capture.recording };
    this->Validation.reset();
    this->UpdateValidationTable();
  }
  StepEnd end{ calibration.isUsable(), calibration.message };
  capture.attempt = std::move(result);
  this->Capture = std::move(capture);
  this->UpdateSampleTable();
  return end;
}

bool vtkSlicerHandEyeCalibrationLogic::SetSampleExcluded(int frame, bool excluded)
{
  if (!this->Internal->Capture)
  {
    return false;
  }
  const std::vector<handeye::CapturedFrame>& frames = this->Internal->Capture->eye.frames;
  const bool isSample = std::any_of(frames.begin(), frames.end(),
    [frame](const handeye::CapturedFrame& captured) { return captured.frame == frame && captured.isSample(); });
  if (!isSample)
  {
    return false;
  }
  if (excluded != this->GetSampleExcluded(frame))
  {
    std::set<int>& leftOut = this->Internal->Capture->excluded;
    if (excluded)
    {
      leftOut.insert(frame);
    }
    else
    {
      leftOut.erase(frame);
    }
    this->Internal->UpdateSampleTable();
    this->Modified();
  }
  return true;
}

bool vtkSlicerHandEyeCalibrationLogic::GetSampleExcluded(int frame)
{
  return this->Internal->Capture && this->Internal->Capture->excluded.count(frame) > 0;
}

bool vtkSlicerHandEyeCalibrationLogic::Validate(const std::string& recording)
{
  return this->RunStep(ValidatedEvent,
    [&]() -> StepEnd
    {
      if (!this->Internal->Calibration)
      {
        return { false, "there is no calibration to validate: calibrate the camera or load a calibration first" };
      }
      const handeye::StoredCalibration stored = this->Internal->Calibration->stored;
      const Recording opened = Recording::open(recording);
      this->Internal->Warn(opened.warnings());
      if (isSamePlace(recording, this->Internal->Calibration->recording))
      {
        this->Internal->Warn({ "this is the capture that was calibrated from, which says little: validate on another one" });
      }
      const handeye::CameraModel camera = handeye::cameraForRecording(stored.camera, opened);
      const std::vector<handeye::CapturedFrame> frames =
        handeye::readCapture(opened, { this->StylusTransform, this->MarkerTransform }, camera, stored.tip_Stylus,
          stored.ballRadiusMm, {}, [this](int done, int total) { return this->ReportProgress(done, total); });
      if (this->Internal->CancelRequested)
      {
        return { false, stoppedAfter(frames.size(), opened) };
      }
      handeye::ValidationStepResult result = handeye::validateCapture(frames, camera, stored.markerToCamera);
      result.subject.ballRadiusMm = stored.ballRadiusMm;
      if (result.isUsable())
      {
        this->Internal->Validation = { result, recording };
        this->Internal->UpdateValidationTable();
      }
      return { result.isUsable(), result.message };
    });
}

bool vtkSlicerHandEyeCalibrationLogic::RegisterPhantom(vtkPoints* points_Model, vtkPoints* points_Phantom)
{
  return this->RunStep(PhantomRegisteredEvent,
    [&]() -> StepEnd
    {
      const handeye::LandmarkRegistrationResult result =
        handeye::registerLandmarks(handeye::toEigen(points_Model), handeye::toEigen(points_Phantom));
      if (result.isUsable())
      {
        this->Internal->Phantom = { result.modelToPhantom, handeye::toVtk(result.modelToPhantom), handeye::phantomJson(result),
          result };
      }
      return { result.isUsable(), result.message };
    });
}
