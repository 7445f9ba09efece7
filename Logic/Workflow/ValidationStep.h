// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Capture.h"
#include "HandEyeValidation.h"

#include <optional>
#include <string>
#include <vector>

namespace handeye
{

struct ValidatedFrame
{
  CapturedFrame captured;
  std::string status;                                ///< that of the capture, or of the projection
  std::optional<HandEyeValidationSample> validated;  ///< where the frame was a sample
};

/// What was validated, for whoever reads the result later; what is not known is left out.
struct ValidationSubject
{
  std::string calibrationFile;
  double ballRadiusMm = 0;  ///< 0: not known
  std::optional<CameraModel> camera;
};

struct ValidationStepResult
{
  std::vector<ValidatedFrame> frames;
  Summary projectionErrorPx;  ///< over the frames with status "ok"
  std::string message;        ///< for a person
  ValidationSubject subject;  ///< the camera is filled in by validateCapture()

  bool isUsable() const { return projectionErrorPx.count > 0; }
};

/// Compares the projected with the segmented ball in every frame of an evaluated capture that was not fitted.
[[nodiscard]] ValidationStepResult validateCapture(
  const std::vector<CapturedFrame>& frames, const CameraModel& camera, const Eigen::Isometry3d& markerToCamera);

}  // namespace handeye
