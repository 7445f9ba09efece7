// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CalibrationStep.h"
#include "CameraFile.h"
#include "HandEyeGuidance.h"
#include "PivotStep.h"
#include "Recording.h"
#include "ResultFiles.h"
#include "ValidationStep.h"

#include <filesystem>
#include <vector>

/// The demo's recordings carried through pivot, calibration and validation: realistic data for tests of what shows them.
struct DemoResults
{
  std::filesystem::path folder = std::filesystem::path(HANDEYE_RESOURCES_DIR) / "Demo";
  double ballRadiusMm = 15;
  handeye::io::Recording calibrationRecording = handeye::io::Recording::open(folder / "calibration");
  handeye::io::Recording validationRecording = handeye::io::Recording::open(folder / "validation");
  handeye::io::Recording pivotRecording = handeye::io::Recording::open(folder / "pivot.igs.mha");
  handeye::CameraModel camera =
    handeye::cameraForRecording(handeye::io::readCameraFile(folder / "camera.yml").camera, calibrationRecording);
  handeye::PivotStepResult pivot = handeye::pivotFromRecording(pivotRecording, "StylusToTracker");
  std::vector<handeye::CapturedFrame> captured =
    handeye::readCapture(calibrationRecording, {}, camera, pivot.calibration.tip_Stylus, ballRadiusMm);
  handeye::CalibrationStepResult calibration = calibrate();
  handeye::ValidationStepResult validation =
    handeye::validateCapture(handeye::readCapture(validationRecording, {}, camera, pivot.calibration.tip_Stylus, ballRadiusMm),
      camera, calibration.calibration.markerToCamera);

private:
  handeye::CalibrationStepResult calibrate() const
  {
    handeye::CalibrationStepResult result = handeye::calibrateCapture({ camera, captured });
    result.tip_Stylus = pivot.calibration.tip_Stylus;
    result.ballRadiusMm = ballRadiusMm;
    return result;
  }
};
