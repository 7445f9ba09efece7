// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SpinStep.h"

#include "JsonEigen.h"

namespace handeye
{

SpinStepResult spinFromRecording(const io::Recording& recording, const std::string& stylusToTrackerName,
  const Eigen::Vector3d& tip_Stylus, const SpinCalibrationOptions& options)
{
  recording.requireTransform(stylusToTrackerName);
  SpinStepResult result;
  std::vector<Eigen::Isometry3d> poses;
  std::vector<int> poseFrames;
  for (int frame = 0; frame < recording.frameCount(); ++frame)
  {
    const io::TransformSample stylus = recording.transform(frame, stylusToTrackerName);
    if (!stylus.isUsable())
    {
      result.invalidFrames.push_back(frame);
      continue;
    }
    poses.push_back(stylus.transform);
    poseFrames.push_back(frame);
  }
  result.calibration = calibrateSpin(poses, tip_Stylus, options);
  for (int index : result.calibration.used)
  {
    result.usedFrames.push_back(poseFrames[std::size_t(index)]);
  }
  for (int index : result.calibration.rejected)
  {
    result.rejectedFrames.push_back(poseFrames[std::size_t(index)]);
  }
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
