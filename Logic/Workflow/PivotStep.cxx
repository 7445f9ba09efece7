// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PivotStep.h"

namespace handeye
{

PivotStepResult pivotFromRecording(
  const io::Recording& recording, const std::string& stylusToTrackerName, const PivotCalibrationOptions& options)
{
  recording.requireTransform(stylusToTrackerName);
  PivotStepResult result;
  std::vector<Eigen::Isometry3d> poses;
  std::vector<int> frames;
  for (int frame = 0; frame < recording.frameCount(); ++frame)
  {
    const io::TransformSample stylus = recording.transform(frame, stylusToTrackerName);
    if (!stylus.isUsable())
    {
      result.invalidFrames.push_back(frame);
      continue;
    }
    poses.push_back(stylus.transform);
    frames.push_back(frame);
  }
  result.calibration = calibratePivot(poses, options);
  for (int index : result.calibration.used)
  {
    result.usedFrames.push_back(frames[std::size_t(index)]);
  }
  for (int index : result.calibration.rejected)
  {
    result.rejectedFrames.push_back(frames[std::size_t(index)]);
  }
  return result;
}

}  // namespace handeye
