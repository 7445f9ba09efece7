// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CalibrationStep.h"
#include "LandmarkRegistration.h"
#include "PivotStep.h"
#include "ResultFiles.h"
#include "ValidationStep.h"
#include "vtkSlicerHandEyeCalibrationLogic.h"

#include <nlohmann/json.hpp>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkTable.h>

#include <atomic>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

/// How a step ended, with what it has to say.
struct vtkSlicerHandEyeCalibrationLogic::StepEnd
{
  bool isUsable = false;
  std::string message;
};

/// Private to vtkSlicerHandEyeCalibrationLogic: its results. What is kept is usable; `document` is what the result's file holds,
/// for a
/// result of a step as for a loaded one; `step` is empty for a loaded one.
class vtkSlicerHandEyeCalibrationLogic::Internals
{
public:
  struct KeptStylus
  {
    Eigen::Vector3d tip_Stylus;
    nlohmann::json document;  ///< null for a tip that was set
    std::optional<handeye::PivotStepResult> step;
    std::string recording;
  };

  struct KeptCalibration
  {
    handeye::StoredCalibration stored;
    vtkSmartPointer<vtkMatrix4x4> markerToCamera;
    nlohmann::json document;
    std::optional<handeye::CalibrationStepResult> step;
    std::string recording;
  };

  struct KeptValidation
  {
    handeye::ValidationStepResult step;
    std::string recording;
  };

  struct KeptPhantom
  {
    Eigen::Isometry3d modelToPhantom;
    vtkSmartPointer<vtkMatrix4x4> matrix;
    nlohmann::json document;
    std::optional<handeye::LandmarkRegistrationResult> step;
  };

  /// What Recalibrate() needs: the balls that were found, and whom the user left out.
  struct EvaluatedCapture
  {
    handeye::EyeCapture eye;
    handeye::ToolNames tools;
    Eigen::Vector3d tip_Stylus;
    double ballRadiusMm = 0;
    std::string recording;
    std::set<int> excluded;                                 ///< frames
    std::optional<handeye::CalibrationStepResult> attempt;  ///< the last one, usable or not
  };

  std::optional<KeptStylus> Stylus;
  std::optional<KeptCalibration> Calibration;
  std::optional<KeptValidation> Validation;
  std::optional<KeptPhantom> Phantom;
  std::optional<EvaluatedCapture> Capture;

  std::string LastMessage;
  std::vector<std::string> LastWarnings;
  bool IsRunning = false;
  std::vector<std::function<bool()>> Forgetting;  ///< asked for while a step was running
  std::atomic<bool> CancelRequested{ false };

  vtkNew<vtkTable> SampleTable;
  vtkNew<vtkTable> ValidationTable;

  void Warn(const std::vector<std::string>& warnings)
  {
    this->LastWarnings.insert(this->LastWarnings.end(), warnings.begin(), warnings.end());
  }

  /// Calibrates from the capture without its excluded samples; the capture becomes the evaluated one, the result the calibration if
  /// it is
  /// usable.
  StepEnd Calibrate(EvaluatedCapture capture, SolverMethods method);

  void UpdateSampleTable();
  void ForgetCalibration();
  void UpdateValidationTable();
};
