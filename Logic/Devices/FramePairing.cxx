// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FramePairing.h"

#include "NumberText.h"

#include <algorithm>
#include <cmath>

namespace handeye::devices
{

namespace
{

/// A hostile sender may invent tools without end.
constexpr std::size_t LargestTrackCount = 200, LargestOtherCount = 10;

double appliedLatencySec(const DeviceSample& image)
{
  const auto applied = image.metadata.find(AppliedLatencyKey);
  return applied == image.metadata.end() ? 0 : io::parseDouble(applied->second).value_or(0);
}

}  // namespace

FramePairing::FramePairing(const FramePairingOptions& options)
  : options_(options)
{
  options_.track.check();
}

void FramePairing::clear()
{
  tracks_.clear();
  waiting_.clear();
  newestSec_ = 0;
}

bool FramePairing::isWanted(const DeviceSample& sample)
{
  if (sample.pose())
  {
    return options_.toolNames.empty() ||
      std::find(options_.toolNames.begin(), options_.toolNames.end(), sample.name) != options_.toolNames.end();
  }
  if (!sample.frame())
  {
    return false;
  }
  options_.imageName = options_.imageName.empty() ? sample.name : options_.imageName;
  if (sample.name != options_.imageName && otherImages_.size() < LargestOtherCount)
  {
    otherImages_.insert(sample.name);
  }
  return sample.name == options_.imageName;
}

void FramePairing::add(DeviceSample sample)
{
  const TrackedPose* pose = sample.pose();
  if (!isWanted(sample))
  {
    return;
  }
  if (!std::isfinite(sample.timeSec) || sample.timeSec < 0)
  {
    ++refused_;
    return;
  }
  if (sample.timeSec < newestSec_ - options_.clockJumpSec)
  {
    ++clockJumps_;
    clear();
  }
  newestSec_ = std::max(newestSec_, sample.timeSec);
  if (pose)
  {
    if (tracks_.count(sample.name) == 0 && tracks_.size() >= LargestTrackCount)
    {
      ++refused_;
      return;
    }
    PoseTrack& track = tracks_.try_emplace(sample.name, options_.track).first->second;
    refused_ += track.add(sample.timeSec, pose->transform, pose->isValid) ? 0 : 1;
    return;
  }
  waiting_.push_back(std::move(sample));
}

/// Of what is wanted; a latency of 0 is none that was asked for, and what a recording has stays.
double FramePairing::missingLatencySec(const DeviceSample& image) const
{
  return options_.latencySec == 0 ? 0 : options_.latencySec - appliedLatencySec(image);
}

bool FramePairing::isReady(const DeviceSample& image) const
{
  const double poseTimeSec = image.timeSec + missingLatencySec(image);
  if (waiting_.size() > options_.maximumWaiting || newestSec_ > std::max(image.timeSec, poseTimeSec) + options_.maximumWaitSec)
  {
    return true;
  }
  const bool isNamed = !options_.toolNames.empty();
  if (isNamed && tracks_.size() < options_.toolNames.size())
  {
    return false;
  }
  return !tracks_.empty() &&
    std::all_of(tracks_.begin(), tracks_.end(), [&](const auto& track) { return track.second.newestSec() >= poseTimeSec; });
}

PairedFrame FramePairing::pair(DeviceSample image) const
{
  PairedFrame paired;
  paired.latencySec = options_.latencySec == 0 ? appliedLatencySec(image) : options_.latencySec;
  paired.poseTimeSec = image.timeSec + missingLatencySec(image);
  for (const std::string& name : options_.toolNames)
  {
    paired.poses[name].message = "no pose was received";
  }
  for (const auto& [name, track] : tracks_)
  {
    paired.poses[name] = track.at(paired.poseTimeSec);
  }
  paired.image = std::move(image);
  return paired;
}

std::optional<PairedFrame> FramePairing::take()
{
  return !waiting_.empty() && isReady(waiting_.front()) ? takeRest() : std::nullopt;
}

std::optional<PairedFrame> FramePairing::takeRest()
{
  if (waiting_.empty())
  {
    return std::nullopt;
  }
  DeviceSample image = std::move(waiting_.front());
  waiting_.pop_front();
  return pair(std::move(image));
}

double ClockOffset::toLocalSec(double timeSec, double receivedSec)
{
  constexpr std::size_t Remembered = 300;
  differences_.push_back(receivedSec - timeSec);
  if (differences_.size() > Remembered)
  {
    differences_.pop_front();
  }
  return timeSec + *std::min_element(differences_.begin(), differences_.end());
}

}  // namespace handeye::devices
