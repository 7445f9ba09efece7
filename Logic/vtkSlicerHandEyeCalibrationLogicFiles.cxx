// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EigenVtk.h"
#include "Recording.h"
#include "ValidationReport.h"
#include "vtkSlicerHandEyeCalibrationLogic.h"
#include "vtkSlicerHandEyeCalibrationLogicInternals.h"

#include <fstream>

namespace
{

/// All that the file holds; its reader has checked it already.
nlohmann::json readDocument(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  return nlohmann::json::parse(stream);
}

}  // namespace

bool vtkSlicerHandEyeCalibrationLogic::LoadStylus(const std::string& file)
{
  return this->RunStep(StylusCalibratedEvent,
    [&]() -> StepEnd
    {
      const Eigen::Vector3d tip_Stylus = handeye::readStylusTip(file);
      this->Internal->Stylus = { tip_Stylus, readDocument(file), {}, {} };
      return { true, "the stylus' tip is that of " + file };
    });
}

bool vtkSlicerHandEyeCalibrationLogic::LoadCalibration(const std::string& file)
{
  return this->RunStep(CameraCalibratedEvent,
    [&]() -> StepEnd
    {
      const handeye::StoredCalibration stored = handeye::readCalibration(file);
      this->Internal->Calibration = { stored, handeye::toVtk(stored.markerToCamera), readDocument(file), {}, {} };
      this->Internal->Capture.reset();
      this->Internal->Validation.reset();
      this->Internal->UpdateSampleTable();
      this->Internal->UpdateValidationTable();
      this->StylusTransform = stored.tools.stylusToTracker;
      this->MarkerTransform = stored.tools.markerToTracker;
      return { true, "the calibration is that of " + file };
    });
}

bool vtkSlicerHandEyeCalibrationLogic::LoadPhantomRegistration(const std::string& file)
{
  return this->RunStep(PhantomRegisteredEvent,
    [&]() -> StepEnd
    {
      const Eigen::Isometry3d modelToPhantom = handeye::readPhantomRegistration(file);
      this->Internal->Phantom = { modelToPhantom, handeye::toVtk(modelToPhantom), readDocument(file), {} };
      return { true, "the phantom's registration is that of " + file };
    });
}

bool vtkSlicerHandEyeCalibrationLogic::SaveStylus(const std::string& file)
{
  return this->RunStep(vtkCommand::NoEvent,
    [&]() -> StepEnd
    {
      if (!this->Internal->Stylus || this->Internal->Stylus->document.is_null())
      {
        return { false, "there is no calibration of the stylus to write to " + file };
      }
      handeye::writeJson(file, this->Internal->Stylus->document);
      return { true, "the stylus was written to " + file };
    });
}

bool vtkSlicerHandEyeCalibrationLogic::SaveCalibration(const std::string& file)
{
  return this->RunStep(vtkCommand::NoEvent,
    [&]() -> StepEnd
    {
      if (!this->Internal->Calibration)
      {
        return { false, "there is no calibration to write to " + file };
      }
      handeye::writeJson(file, this->Internal->Calibration->document);
      return { true, "the calibration was written to " + file };
    });
}

bool vtkSlicerHandEyeCalibrationLogic::SaveValidation(const std::string& file)
{
  return this->RunStep(vtkCommand::NoEvent,
    [&]() -> StepEnd
    {
      if (!this->Internal->Validation)
      {
        return { false, "there is no validation to write to " + file };
      }
      handeye::writeJson(file, handeye::validationJson(this->Internal->Validation->step));
      return { true, "the validation was written to " + file };
    });
}

bool vtkSlicerHandEyeCalibrationLogic::SavePhantomRegistration(const std::string& file)
{
  return this->RunStep(vtkCommand::NoEvent,
    [&]() -> StepEnd
    {
      if (!this->Internal->Phantom)
      {
        return { false, "there is no registration of the phantom to write to " + file };
      }
      handeye::writeJson(file, this->Internal->Phantom->document);
      return { true, "the phantom's registration was written to " + file };
    });
}

bool vtkSlicerHandEyeCalibrationLogic::SaveValidationReport(const std::string& folder)
{
  return this->RunStep(vtkCommand::NoEvent,
    [&]() -> StepEnd
    {
      if (!this->Internal->Validation)
      {
        return { false, "there is no validation to report in " + folder };
      }
      const auto recording = handeye::io::Recording::open(this->Internal->Validation->recording);
      handeye::writeValidationReport(folder, this->Internal->Validation->step, recording);
      return { true, "the report was written to " + folder };
    });
}
