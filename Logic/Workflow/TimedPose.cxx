// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TimedPose.h"

#include "NumberText.h"
#include "PoseTrack.h"

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

/// A gap over which poses are interpolated: what is usual between the frames of a recording (from nearby: enough of them for a
/// median) and half as much, at least 0.1 s; at most 0.5 s, beyond which nobody knows where the tool was.
double largestGapSec(const io::Recording& recording, int frame)
{
  constexpr int Nearby = 15;
  constexpr double LeastSec = 0.1, MostSec = 0.5, Slack = 1.5;
  std::vector<double> spacings;
  for (int i = std::max(1, frame - Nearby); i < std::min(recording.frameCount(), frame + Nearby); ++i)
  {
    const std::optional<double> before = recording.timestampSec(i - 1), after = recording.timestampSec(i);
    if (before && after && *after > *before)
    {
      spacings.push_back(*after - *before);
    }
  }
  if (spacings.empty())
  {
    return LeastSec;
  }
  const auto middle = spacings.begin() + std::ptrdiff_t(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  return std::clamp(Slack * *middle, LeastSec, MostSec);
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
