// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SpinStep.h"

#include "JsonEigen.h"
#include "TrackedPoses.h"

namespace handeye
{

SpinStepResult spinFromRecording(const io::Recording& recording, const std::string& stylusToTrackerName,
  const Eigen::Vector3d& tip_Stylus, const SpinCalibrationOptions& options)
{
  const TrackedPoses tracked = readTrackedPoses(recording, stylusToTrackerName);
  SpinStepResult result;
  result.calibration = calibrateSpin(tracked.toolToTracker, tip_Stylus, options);
  result.invalidFrames = tracked.invalidFrames;
  result.usedFrames = tracked.framesOf(result.calibration.used);
  result.rejectedFrames = tracked.framesOf(result.calibration.rejected);
  return result;
}

nlohmann::json spinJson(const SpinStepResult& step, const nlohmann::json& stylus)
{
  const SpinCalibrationResult& calibration = step.calibration;
  nlohmann::json spin = { { "usedFrames", step.usedFrames.size() }, { "rejectedFrames", step.rejectedFrames },
    { "invalidFrames", step.invalidFrames }, { "spin_Rad", calibration.spin }, { "wobble_Rad", calibration.wobble } };
  if (calibration.tipToAxisMm)
  {
    spin["tipToAxisMm"] = *calibration.tipToAxisMm;
  }
  if (!calibration.isUsable())
  {
    return { { "schema", "handeye-stylus/1" }, { "status", toString(calibration.status) }, { "message", calibration.message },
      { "spin", spin } };
  }
  spin["message"] = calibration.message;
  spin["shaftSigma_Rad"] = calibration.shaftSigma;
  nlohmann::json object = stylus;
  object["status"] = "ok";
  object["spin"] = spin;
  object["shaft_Stylus"] = toJson(calibration.shaft_Stylus);
  object["stylusTipToStylus"] = toJson(calibration.stylusTipToStylus);
  return object;
}

}  // namespace handeye
