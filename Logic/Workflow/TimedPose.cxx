// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TimedPose.h"

#include "PoseTrack.h"

namespace handeye
{

namespace
{

io::TransformSample without(io::TransformSample::Status status, const std::string& reason)
{
  io::TransformSample sample;
  sample.status = status;
  sample.reason = reason;
  return sample;
}

/// Adds a frame's pose; returns false where it has no time.
bool addPose(const io::Recording& recording, int frame, const std::string& name, PoseTrack& track)
{
  const std::optional<double> timeSec = recording.timestampSec(frame);
  const io::TransformSample pose = recording.transform(frame, name);
  if (timeSec && pose.status != io::TransformSample::Status::Missing)
  {
    track.add(*timeSec, pose.transform, pose.isUsable());
  }
  return timeSec.has_value();
}

}  // namespace

io::TransformSample poseOfFrame(const io::Recording& recording, int frame, const std::string& name, double latencySec)
{
  if (latencySec == 0)
  {
    return recording.transform(frame, name);
  }
  const std::optional<double> frameSec = recording.timestampSec(frame);
  if (!frameSec)
  {
    return without(io::TransformSample::Status::Missing, "the frame has no time, which a latency needs");
  }
  const double timeSec = *frameSec + latencySec;
  PoseTrackOptions options;
  options.maximumRepeatSec = 0;  // judged when it was recorded
  PoseTrack track(options);
  addPose(recording, frame, name, track);
  // From the frame towards the moment, until one frame is beyond it.
  const int step = latencySec > 0 ? 1 : -1;
  for (int other = frame + step; other >= 0 && other < recording.frameCount(); other += step)
  {
    const bool hasTime = addPose(recording, other, name, track);
    if (hasTime && (*recording.timestampSec(other) - timeSec) * step > 0)
    {
      break;
    }
  }
  const PoseAtTime pose = track.at(timeSec);
  if (!pose.isUsable())
  {
    return without(
      pose.status == PoseAtTime::Status::NoPose ? io::TransformSample::Status::Missing : io::TransformSample::Status::Invalid,
      pose.message);
  }
  io::TransformSample sample;
  sample.status = io::TransformSample::Status::Ok;
  sample.transform = pose.transform;
  return sample;
}

}  // namespace handeye
