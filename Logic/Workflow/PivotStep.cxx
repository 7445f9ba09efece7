// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PivotStep.h"

#include "TrackedPoses.h"

namespace handeye
{

PivotStepResult pivotFromRecording(
  const io::Recording& recording, const std::string& stylusToTrackerName, const PivotCalibrationOptions& options)
{
  const TrackedPoses tracked = readTrackedPoses(recording, stylusToTrackerName);
  PivotStepResult result;
  result.calibration = calibratePivot(tracked.toolToTracker, options);
  result.poseFrames = tracked.frames;
  result.invalidFrames = tracked.invalidFrames;
  result.usedFrames = tracked.framesOf(result.calibration.used);
  result.rejectedFrames = tracked.framesOf(result.calibration.rejected);
  result.repeatedFrames = tracked.framesOf(result.calibration.repeated);
  return result;
}

}  // namespace handeye
