// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReplaySource.h"

#include "NumberText.h"
#include "Recording.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace handeye::devices
{

void ReplayOptions::check() const
{
  if (!(speed >= 0) || !std::isfinite(speed) || !(framesPerSec > 0))
  {
    throw std::invalid_argument("replay: a speed of 0 or more, and a positive number of frames a second are expected");
  }
}

ReplaySource::ReplaySource(const ReplayOptions& options)
  : Source(options.buffer)
  , options_(options)
{
  options_.check();
}

ReplaySource::~ReplaySource()
{
  stopThread();
}

void ReplaySource::wake()
{
  const std::lock_guard lock(stepMutex_);
  stepped_.notify_all();
}

void ReplaySource::step()
{
  const std::lock_guard lock(stepMutex_);
  ++steps_;
  stepped_.notify_all();
}

/// @param streamSec since the beginning of the replay, by the recording's times
bool ReplaySource::waitForTurn(double streamSec, double startSec)
{
  if (options_.isStepwise)
  {
    std::unique_lock lock(stepMutex_);
    stepped_.wait(lock, [this] { return isStopping() || steps_ > 0; });
    steps_ -= isStopping() ? 0 : 1;
    return !isStopping();
  }
  return options_.speed > 0 ? sleepFor(std::max(0.0, startSec + streamSec / options_.speed - systemTimeSec())) : !isStopping();
}

void ReplaySource::deliverFrame(const io::Recording& recording, int frame, double timeSec)
{
  for (const std::string& tool : recording.transformNames())
  {
    const io::TransformSample pose = recording.transform(frame, tool);
    if (pose.status == io::TransformSample::Status::Missing)
    {
      continue;
    }
    TrackedPose tracked;
    tracked.isValid = pose.isUsable();
    tracked.transform = pose.transform;
    tracked.received = pose.transform.matrix();
    tracked.reason = pose.reason;
    deliver({ tool, timeSec, 0, {}, std::move(tracked) });
  }
  if (recording.hasImage(frame))
  {
    VideoFrame video;
    video.image = recording.image(frame);
    std::map<std::string, std::string> metadata;
    if (recording.appliedLatencySec() != 0)
    {
      metadata[AppliedLatencyKey] = io::formatDouble(recording.appliedLatencySec());
    }
    deliver({ options_.imageName, timeSec, 0, std::move(metadata), std::move(video) });
  }
}

/// @return the stream time that it took; nothing if it was stopped
std::optional<double> ReplaySource::playOnce(const io::Recording& recording, double startSec, double loopOffsetSec)
{
  const double firstSec = recording.frameCount() > 0 ? recording.timestampSec(0).value_or(0) : 0;
  double timeSec = firstSec;
  for (int frame = 0; frame < recording.frameCount(); ++frame)
  {
    timeSec = recording.timestampSec(frame).value_or(firstSec + frame / options_.framesPerSec);
    if (!waitForTurn(timeSec - firstSec + loopOffsetSec, startSec))
    {
      return std::nullopt;
    }
    try
    {
      deliverFrame(recording, frame, timeSec + loopOffsetSec);
    }
    catch (const std::exception& error)
    {
      countRefused("frame " + std::to_string(frame) + " is left out: " + error.what());
    }
  }
  return timeSec - firstSec + 1 / options_.framesPerSec;
}

void ReplaySource::play(const io::Recording& recording)
{
  const double startSec = systemTimeSec();
  double loopOffsetSec = 0;
  do
  {
    const std::optional<double> durationSec = playOnce(recording, startSec, loopOffsetSec);
    if (!durationSec)
    {
      return;
    }
    loopOffsetSec += *durationSec;
  } while (options_.isLooping && recording.frameCount() > 0 && !isStopping());
  if (!isStopping())
  {
    setState(SourceState::Finished, name() + " has come to its end");
  }
}

void ReplaySource::run()
{
  try
  {
    const io::Recording recording =
      options_.needsTracking ? io::Recording::open(options_.recording) : io::Recording::openImages(options_.recording);
    countConnection();
    setState(SourceState::Streaming, "playing " + name());
    play(recording);
  }
  catch (const std::exception& error)
  {
    finish(error.what());
  }
}

}  // namespace handeye::devices
