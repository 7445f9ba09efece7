// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TimedPose.h"

#include "FileError.h"
#include "NumberText.h"
#include "NumberWords.h"
#include "PoseTrack.h"
#include "Statistics.h"

#include <algorithm>
#include <cmath>

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

/// What has not been applied yet; what is below a microsecond is the rounding of a text.
double missingLatency(const io::Recording& recording, double latencySec)
{
  const double missingSec = latencySec == 0 ? 0 : latencySec - recording.appliedLatencySec();
  return std::abs(missingSec) < 1e-6 ? 0 : missingSec;
}

/// Beyond this nobody knows where the tool was between two frames.
constexpr double MostGapSec = 0.5;

/// The time that is usual between the frames of a recording, from nearby: enough of them for a median. 0 without times.
double usualSpacingSec(const io::Recording& recording, int frame)
{
  constexpr int Nearby = 15;
  std::vector<double> spacings;
  for (int i = std::max(1, frame - Nearby); i < std::min(recording.frameCount(), frame + Nearby); ++i)
  {
    const std::optional<double> before = recording.timestampSec(i - 1), after = recording.timestampSec(i);
    if (before && after && *after > *before)
    {
      spacings.push_back(*after - *before);
    }
  }
  return spacings.empty() ? 0 : median(spacings);
}

/// A gap over which poses are interpolated: what is usual and half as much, at least 0.1 s.
double largestGapSec(const io::Recording& recording, int frame)
{
  constexpr double LeastSec = 0.1, Slack = 1.5;
  return std::clamp(Slack * usualSpacingSec(recording, frame), LeastSec, MostGapSec);
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

io::TransformSample poseOfFrame(const io::Recording& recording, int frame, const std::string& name, double wantedLatencySec)
{
  const double latencySec = missingLatency(recording, wantedLatencySec);
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
  options.maximumGapSec = largestGapSec(recording, frame);
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

std::vector<std::string> latencyNotes(const io::Recording& recording, double latencySec)
{
  const double appliedSec = recording.appliedLatencySec(), missingSec = missingLatency(recording, latencySec);
  const double spacingSec = missingSec == 0 ? 0 : usualSpacingSec(recording, recording.frameCount() / 2);
  if (spacingSec > MostGapSec)
  {
    throw io::FileError(recording.path(),
      "its frames are " + fixedDigits(spacingSec, 1) +
        " s apart (single placements, a session): a latency cannot be applied to poses " +
        "that far apart. Give --latency when they are taken, to `handeye capture` or `handeye record`");
  }
  if (appliedSec == 0)
  {
    return {};
  }
  const std::string note = recording.path().string() + ": its poses were recorded with a latency of " +
    io::formatDouble(std::round(1e6 * appliedSec) / 1e3) + " ms";
  return { note +
    (missingSec == 0
        ? ", which is not applied again"
        : "; " + io::formatDouble(std::round(1e6 * missingSec) / 1e3) + " ms are added to make it what is asked for") };
}

}  // namespace handeye
