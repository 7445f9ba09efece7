// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PivotStep.h"

namespace handeye
{

namespace
{

std::vector<int> framesOf(const std::vector<int>& indices, const std::vector<int>& poseFrames)
{
  std::vector<int> frames;
  frames.reserve(indices.size());
  for (int index : indices)
  {
    frames.push_back(poseFrames[std::size_t(index)]);
  }
  return frames;
}

}  // namespace

PivotStepResult pivotFromRecording(
  const io::Recording& recording, const std::string& stylusToTrackerName, const PivotCalibrationOptions& options)
{
  recording.requireTransform(stylusToTrackerName);
  PivotStepResult result;
  std::vector<Eigen::Isometry3d> poses;
  for (int frame = 0; frame < recording.frameCount(); ++frame)
  {
    const io::TransformSample stylus = recording.transform(frame, stylusToTrackerName);
    if (!stylus.isUsable())
    {
      result.invalidFrames.push_back(frame);
      continue;
    }
    poses.push_back(stylus.transform);
    result.poseFrames.push_back(frame);
  }
  result.calibration = calibratePivot(poses, options);
  result.usedFrames = framesOf(result.calibration.used, result.poseFrames);
  result.rejectedFrames = framesOf(result.calibration.rejected, result.poseFrames);
  result.repeatedFrames = framesOf(result.calibration.repeated, result.poseFrames);
  return result;
}

}  // namespace handeye
