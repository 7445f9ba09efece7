// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EigenVtk.h"
#include "OverlayPose.h"
#include "vtkSlicerHandEyeCalibrationLogic.h"
#include "vtkSlicerHandEyeCalibrationLogicInternals.h"

#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkStringArray.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace
{

constexpr double NotKnown = std::numeric_limits<double>::quiet_NaN();

/// A number of a result's file, NaN if it is not there.
double numberIn(const nlohmann::json& document, const char* pointer)
{
  const nlohmann::json::json_pointer place(pointer);
  return document.contains(place) && document[place].is_number() ? document[place].get<double>() : NotKnown;
}

/// Fills a table column by column, and keeps the columns' order.
class TableFiller
{
public:
  explicit TableFiller(vtkTable* table)
    : Table(table)
  {
    this->Table->Initialize();
  }

  template<typename Array, typename Rows, typename Value> void add(const char* name, const Rows& rows, Value value)
  {
    vtkNew<Array> column;
    column->SetName(name);
    for (const auto& row : rows)
    {
      column->InsertNextValue(value(row));
    }
    this->Table->AddColumn(column);
  }

private:
  vtkTable* Table;
};

/// What is known of the ball in the image, whatever became of the frame.
template<typename Rows> void addBall(TableFiller& table, const Rows& rows)
{
  const auto coordinate = [](int axis)
  { return [axis](const auto& row) { return row.captured.ball.isFound() ? row.captured.ball.ball_Image(axis) : NotKnown; }; };
  table.add<vtkDoubleArray>("ballXPx", rows, coordinate(0));
  table.add<vtkDoubleArray>("ballYPx", rows, coordinate(1));
}

template<typename Kept> std::string recordingOf(const std::optional<Kept>& kept)
{
  return kept ? kept->recording : std::string();
}

template<typename Kept> auto stepOf(const std::optional<Kept>& kept) -> decltype(&*kept->step)
{
  return kept && kept->step ? &*kept->step : nullptr;
}

/// A number of a kept result's document.
template<typename Kept> double numberOf(const std::optional<Kept>& kept, const char* pointer)
{
  return kept ? numberIn(kept->document, pointer) : NotKnown;
}

}  // namespace

void vtkSlicerHandEyeCalibrationLogic::Internals::UpdateSampleTable()
{
  using handeye::CalibratedFrame;
  const bool hasAttempt = this->Capture && this->Capture->attempt;
  const std::vector<CalibratedFrame> rows = hasAttempt ? this->Capture->attempt->frames : std::vector<CalibratedFrame>();
  const bool hasResiduals = hasAttempt && this->Capture->attempt->calibration.isUsable();
  const auto hasResidual = [&](const CalibratedFrame& row) { return hasResiduals && row.captured.isSample(); };
  TableFiller table(this->SampleTable);
  table.add<vtkIntArray>("frame", rows, [](const CalibratedFrame& row) { return row.captured.frame; });
  table.add<vtkStringArray>("status", rows, [](const CalibratedFrame& row) { return row.status; });
  table.add<vtkIntArray>("used", rows, [](const CalibratedFrame& row) { return row.used ? 1 : 0; });
  table.add<vtkIntArray>(
    "excluded", rows, [&](const CalibratedFrame& row) { return this->Capture->excluded.count(row.captured.frame) > 0 ? 1 : 0; });
  table.add<vtkDoubleArray>(
    "residualPx", rows, [&](const CalibratedFrame& row) { return hasResidual(row) ? row.residualPx : NotKnown; });
  table.add<vtkDoubleArray>(
    "residualMm", rows, [&](const CalibratedFrame& row) { return hasResidual(row) ? row.residualMm : NotKnown; });
  table.add<vtkDoubleArray>("distanceMm", rows,
    [](const CalibratedFrame& row) { return row.captured.ball.isFound() ? row.captured.ball.distanceMm : NotKnown; });
  addBall(table, rows);
  table.add<vtkStringArray>("message", rows,
    [](const CalibratedFrame& row)
    { return row.status == "disagrees" ? std::string("disagrees with the other samples") : row.captured.message; });
}

void vtkSlicerHandEyeCalibrationLogic::Internals::UpdateValidationTable()
{
  using handeye::ValidatedFrame;
  const std::vector<ValidatedFrame> rows = this->Validation ? this->Validation->step.frames : std::vector<ValidatedFrame>();
  const auto isProjected = [](const ValidatedFrame& row)
  { return row.validated && row.validated->status == handeye::CameraModel::Status::Ok; };
  const auto projected = [&](int axis)
  { return [&, axis](const ValidatedFrame& row) { return isProjected(row) ? row.validated->projected_Image(axis) : NotKnown; }; };
  TableFiller table(this->ValidationTable);
  table.add<vtkIntArray>("frame", rows, [](const ValidatedFrame& row) { return row.captured.frame; });
  table.add<vtkStringArray>("status", rows, [](const ValidatedFrame& row) { return row.status; });
  table.add<vtkDoubleArray>(
    "errorPx", rows, [&](const ValidatedFrame& row) { return isProjected(row) ? row.validated->errorPx : NotKnown; });
  table.add<vtkDoubleArray>(
    "distanceMm", rows, [](const ValidatedFrame& row) { return row.validated ? row.validated->distanceMm : NotKnown; });
  addBall(table, rows);
  table.add<vtkDoubleArray>("projectedXPx", rows, projected(0));
  table.add<vtkDoubleArray>("projectedYPx", rows, projected(1));
  table.add<vtkStringArray>("message", rows, [](const ValidatedFrame& row) { return row.captured.message; });
}

const std::string& vtkSlicerHandEyeCalibrationLogic::GetLastMessage() const
{
  return this->Internal->LastMessage;
}

const std::vector<std::string>& vtkSlicerHandEyeCalibrationLogic::GetLastWarnings() const
{
  return this->Internal->LastWarnings;
}

void vtkSlicerHandEyeCalibrationLogic::SetStylusTip(double x, double y, double z)
{
  const Eigen::Vector3d tip_Stylus(x, y, z);
  if (!tip_Stylus.allFinite())
  {
    throw std::invalid_argument("the stylus' tip must be three finite numbers");
  }
  if (!this->Internal->Stylus || this->Internal->Stylus->tip_Stylus != tip_Stylus)
  {
    this->Internal->Stylus = { tip_Stylus, {}, {}, {} };
    this->Modified();
    this->InvokeEvent(StylusCalibratedEvent);
  }
}

/// At once, or when the step that is running has ended.
void vtkSlicerHandEyeCalibrationLogic::Forget(const std::function<bool()>& forget)
{
  if (this->Internal->IsRunning)
  {
    this->Internal->Forgetting.push_back(forget);
  }
  else if (forget())
  {
    this->Modified();
    this->InvokeEvent(ResultsForgottenEvent);
  }
}

void vtkSlicerHandEyeCalibrationLogic::ForgetResults()
{
  this->Forget(
    [internal = this->Internal.get()]
    {
      internal->Stylus.reset();
      internal->Phantom.reset();
      internal->ForgetCalibration();
      internal->LastMessage.clear();
      internal->LastWarnings.clear();
      return true;
    });
}

void vtkSlicerHandEyeCalibrationLogic::ForgetCalibration()
{
  this->Forget(
    [internal = this->Internal.get()]
    {
      const bool was = internal->Calibration.has_value();
      if (was)
      {
        internal->ForgetCalibration();
      }
      return was;
    });
}

void vtkSlicerHandEyeCalibrationLogic::ForgetPhantomRegistration()
{
  this->Forget(
    [internal = this->Internal.get()]
    {
      const bool was = internal->Phantom.has_value();
      internal->Phantom.reset();
      return was;
    });
}

void vtkSlicerHandEyeCalibrationLogic::Internals::ForgetCalibration()
{
  this->Calibration.reset();
  this->Validation.reset();
  this->Capture.reset();
  this->UpdateSampleTable();
  this->UpdateValidationTable();
}

bool vtkSlicerHandEyeCalibrationLogic::HasStylusDocument()
{
  return this->Internal->Stylus && !this->Internal->Stylus->document.is_null();
}

bool vtkSlicerHandEyeCalibrationLogic::GetStylusTip(double tip_Stylus[3])
{
  if (!this->Internal->Stylus)
  {
    return false;
  }
  Eigen::Map<Eigen::Vector3d> tip(tip_Stylus);
  tip = this->Internal->Stylus->tip_Stylus;
  return true;
}

bool vtkSlicerHandEyeCalibrationLogic::GetStylusShaft(double shaft_Stylus[3])
{
  if (!this->HasStylusDocument())
  {
    return false;
  }
  const nlohmann::json& document = this->Internal->Stylus->document;
  // The frame of the tip has -Z along the shaft.
  const Eigen::Vector3d known = -Eigen::Vector3d(numberIn(document, "/stylusTipToStylus/0/2"),
    numberIn(document, "/stylusTipToStylus/1/2"), numberIn(document, "/stylusTipToStylus/2/2"));
  if (!known.allFinite())
  {
    return false;
  }
  Eigen::Map<Eigen::Vector3d> shaft(shaft_Stylus);
  shaft = known;
  return true;
}

double vtkSlicerHandEyeCalibrationLogic::GetStylusRmsMm()
{
  return numberOf(this->Internal->Stylus, "/rmsMm");
}

vtkMatrix4x4* vtkSlicerHandEyeCalibrationLogic::GetMarkerToCamera()
{
  return this->Internal->Calibration ? this->Internal->Calibration->markerToCamera : nullptr;
}

vtkMatrix4x4* vtkSlicerHandEyeCalibrationLogic::GetModelToPhantom()
{
  return this->Internal->Phantom ? this->Internal->Phantom->matrix : nullptr;
}

double vtkSlicerHandEyeCalibrationLogic::GetPredictedMeanPx()
{
  return numberOf(this->Internal->Calibration, "/predictedErrorPx/mean");
}

double vtkSlicerHandEyeCalibrationLogic::GetPredictedMaximumPx()
{
  return numberOf(this->Internal->Calibration, "/predictedErrorPx/max");
}

double vtkSlicerHandEyeCalibrationLogic::GetReprojectionRmsPx()
{
  return numberOf(this->Internal->Calibration, "/reprojectionRmsPx");
}

double vtkSlicerHandEyeCalibrationLogic::GetValidationMeanPx()
{
  return this->Internal->Validation ? this->Internal->Validation->step.projectionErrorPx.mean : NotKnown;
}

double vtkSlicerHandEyeCalibrationLogic::GetValidationStandardDeviationPx()
{
  return this->Internal->Validation ? this->Internal->Validation->step.projectionErrorPx.standardDeviation : NotKnown;
}

double vtkSlicerHandEyeCalibrationLogic::GetValidationMinimumPx()
{
  return this->Internal->Validation ? this->Internal->Validation->step.projectionErrorPx.minimum : NotKnown;
}

double vtkSlicerHandEyeCalibrationLogic::GetValidationMaximumPx()
{
  return this->Internal->Validation ? this->Internal->Validation->step.projectionErrorPx.maximum : NotKnown;
}

double vtkSlicerHandEyeCalibrationLogic::GetValidationRmsPx()
{
  return this->Internal->Validation ? this->Internal->Validation->step.projectionErrorPx.rms : NotKnown;
}

int vtkSlicerHandEyeCalibrationLogic::GetValidationCount()
{
  return this->Internal->Validation ? this->Internal->Validation->step.projectionErrorPx.count : 0;
}

double vtkSlicerHandEyeCalibrationLogic::GetPhantomRmsMm()
{
  return numberOf(this->Internal->Phantom, "/rmsMm");
}

vtkTable* vtkSlicerHandEyeCalibrationLogic::GetSampleTable()
{
  return this->Internal->SampleTable;
}

vtkTable* vtkSlicerHandEyeCalibrationLogic::GetValidationTable()
{
  return this->Internal->ValidationTable;
}

std::string vtkSlicerHandEyeCalibrationLogic::GetStylusRecording()
{
  return recordingOf(this->Internal->Stylus);
}

std::string vtkSlicerHandEyeCalibrationLogic::GetCalibrationRecording()
{
  return recordingOf(this->Internal->Calibration);
}

std::string vtkSlicerHandEyeCalibrationLogic::GetValidationRecording()
{
  return recordingOf(this->Internal->Validation);
}

const handeye::PivotStepResult* vtkSlicerHandEyeCalibrationLogic::GetStylusResult()
{
  return stepOf(this->Internal->Stylus);
}

const handeye::CalibrationStepResult* vtkSlicerHandEyeCalibrationLogic::GetCalibrationResult()
{
  return stepOf(this->Internal->Calibration);
}

const handeye::ValidationStepResult* vtkSlicerHandEyeCalibrationLogic::GetValidationResult()
{
  return this->Internal->Validation ? &this->Internal->Validation->step : nullptr;
}

const handeye::LandmarkRegistrationResult* vtkSlicerHandEyeCalibrationLogic::GetPhantomResult()
{
  return stepOf(this->Internal->Phantom);
}

const handeye::CalibrationStepResult* vtkSlicerHandEyeCalibrationLogic::GetLastCalibrationAttempt()
{
  return this->Internal->Capture && this->Internal->Capture->attempt ? &*this->Internal->Capture->attempt : nullptr;
}

const handeye::StoredCalibration* vtkSlicerHandEyeCalibrationLogic::GetCalibration()
{
  return this->Internal->Calibration ? &this->Internal->Calibration->stored : nullptr;
}

bool vtkSlicerHandEyeCalibrationLogic::ComputeModelToCamera(
  vtkMatrix4x4* markerToTracker, vtkMatrix4x4* phantomToTracker, vtkMatrix4x4* modelToCamera, std::string* reason)
{
  std::string problem;
  if (!this->Internal->Calibration)
  {
    problem = "there is no calibration of the camera";
  }
  else if (!this->Internal->Phantom)
  {
    problem = "the phantom is not registered";
  }
  else
  {
    const handeye::OverlayTransforms transforms{ this->Internal->Calibration->stored.markerToCamera,
      this->Internal->Phantom->modelToPhantom };
    try
    {
      const Eigen::Isometry3d marker = handeye::toIsometry(markerToTracker), phantom = handeye::toIsometry(phantomToTracker);
      handeye::toVtk(handeye::toModelToCamera(transforms, marker, phantom), modelToCamera);
    }
    catch (const std::invalid_argument& error)
    {
      problem = error.what();
    }
  }
  if (reason)
  {
    *reason = problem;
  }
  return problem.empty();
}
