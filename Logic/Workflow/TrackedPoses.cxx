// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TrackedPoses.h"

namespace handeye
{

std::vector<int> TrackedPoses::framesOf(const std::vector<int>& poses) const
{
  std::vector<int> chosen;
  chosen.reserve(poses.size());
  for (int pose : poses)
  {
    chosen.push_back(frames[std::size_t(pose)]);
  }
  return chosen;
}

TrackedPoses readTrackedPoses(const io::Recording& recording, const std::string& toolToTrackerName)
{
  recording.requireTransform(toolToTrackerName);
  TrackedPoses tracked;
  for (int frame = 0; frame < recording.frameCount(); ++frame)
  {
    const io::TransformSample tool = recording.transform(frame, toolToTrackerName);
    if (!tool.isUsable())
    {
      tracked.invalidFrames.push_back(frame);
      continue;
    }
    tracked.toolToTracker.push_back(tool.transform);
    tracked.frames.push_back(frame);
  }
  return tracked;
}

}  // namespace handeye
