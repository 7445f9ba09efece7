// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Capture.h"
#include "HandEyeCalibration.h"
#include "HandEyeGuidance.h"

#include <optional>
#include <string>
#include <vector>

namespace handeye
{

/// One frame of a capture after the calibration: what it gave and what became of it.
struct CalibratedFrame
{
  CapturedFrame captured;
  std::string status;  ///< that of the capture, or "disagrees" for a sample that was left out
  bool used = false;
  double residualPx = 0;  ///< meaningful for samples
  double residualMm = 0;
  double deviation = 0;  ///< the residual in multiples of what is expected of it
};

/// A calibration with all that belongs to it. A stereo head adds the right eye.
struct CalibrationStepResult
{
  HandEyeCalibrationResult calibration;  ///< of the left (or only) eye
  CameraModel camera;
  std::vector<CalibratedFrame> frames;
  ToolNames tools;
  Eigen::Vector3d tip_Stylus = Eigen::Vector3d::Zero();
  double ballRadiusMm = 0;

  struct RightEye
  {
    CameraModel camera;
    std::vector<CalibratedFrame> frames;
    Eigen::Isometry3d markerToRightCamera = Eigen::Isometry3d::Identity();  ///< p_RightCamera = markerToRightCamera * p_Marker
    /// Where the eyes' relation was not known: the right eye's own calibration. Otherwise both are one, `calibration` above.
    std::optional<HandEyeCalibrationResult> calibration;
  };
  std::optional<RightEye> right;
  /// Where to hold the ball next, seen with the left (or only) eye.
  std::optional<HandEyeGuidance> guidance;

  bool isUsable() const { return calibration.isUsable() && (!right || !right->calibration || right->calibration->isUsable()); }
  /// Of the first part that is not usable, otherwise of the left eye.
  const HandEyeCalibrationResult& decisive() const;
};

/// The evaluated capture of one eye.
struct EyeCapture
{
  CameraModel camera;  ///< with the image size of the capture
  std::vector<CapturedFrame> frames;
};

/// The tips of a capture for a stylus whose tip is by so much (mm) elsewhere than was thought.
void moveTips(std::vector<CapturedFrame>& frames, const Eigen::Vector3d& correction_Stylus);

/// The depths (mm) between which the ball is to be held; those of the samples where not given.
using DepthRange = std::optional<std::pair<double, double>>;

/// Says where to hold the ball next; sets result.guidance. Where the capture gives no calibration, the balls' apparent sizes tell
/// where they were. Nothing is planned where samples contradict each other (no consensus, wrong scale, a marker that moved): more of them
/// would not help.
void addGuidance(CalibrationStepResult& result, const HandEyeCalibrationOptions& options, const DepthRange& depthsMm);

/// Calibrates one camera from an evaluated capture.
[[nodiscard]] CalibrationStepResult calibrateCapture(const EyeCapture& capture, const HandEyeCalibrationOptions& options = {});

/// Calibrates a stereo head. With the eyes' relation known (p_RightCamera = leftToRight * p_LeftCamera, mm) all samples of both
/// eyes are one registration; without, each eye is calibrated on its own.
[[nodiscard]] CalibrationStepResult calibrateStereoCapture(const EyeCapture& left, const EyeCapture& right,
  const std::optional<Eigen::Isometry3d>& leftToRight, const HandEyeCalibrationOptions& options = {});

}  // namespace handeye
