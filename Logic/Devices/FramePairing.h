// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "DeviceSample.h"
#include "PoseTrack.h"

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace handeye::devices
{

struct FramePairingOptions
{
  std::vector<std::string> toolNames;  ///< "StylusToTracker", ...; empty: every tool that was seen
  std::string imageName;               ///< of the video; empty: the first that comes
  /// The poses belong to an image at its own time plus this. Positive: the tracker's times run ahead of (are later than) the
  /// video's.
  double latencySec = 0;
  double maximumWaitSec = 0.3;      ///< stream time that an image waits for poses on both sides of it
  std::size_t maximumWaiting = 60;  ///< images that wait; more, and the oldest goes as it is
  double clockJumpSec = 10;         ///< a time that goes back by more than this is a clock that was set, not a late message
  PoseTrackOptions track;
};

/// An image with the poses of its moment.
struct PairedFrame
{
  DeviceSample image;
  double poseTimeSec = 0;                   ///< the moment of the poses, by the tracker's times
  double latencySec = 0;                    ///< that is in them: the one asked for, or the one that a recording was made with
  std::map<std::string, PoseAtTime> poses;  ///< by tool; each says itself whether and why (not) it is usable
};

/// Brings images and poses together by time and not by the order in which they arrive: the poses of a frame are interpolated at the
/// frame's time plus the latency, as soon as poses from both sides of that moment have come.
///
/// Times of one server are by one clock. Of a source with another clock (a camera beside a tracker's server), map the times first,
/// see
/// ClockOffset.
///
/// Images of a recording that was made with a latency say so in their metadata (AppliedLatencyKey): of the latency asked for only what
/// is missing is applied.
///
/// Not safe to share between threads.
class FramePairing
{
public:
  explicit FramePairing(const FramePairingOptions& options = {});

  /// Takes a sample: poses and images, others are ignored. Samples with times that are not finite or before 0 are refused.
  void add(DeviceSample sample);

  /// The next image that has all it waits for, or has waited long enough.
  std::optional<PairedFrame> take();
  /// The same for the end of a stream: nothing more will come.
  std::optional<PairedFrame> takeRest();

  void setLatency(double latencySec) { options_.latencySec = latencySec; }
  /// Forgets everything, for instance after a source came back.
  void clear();

  /// Other videos than the one that is taken, at most ten: they are left out, since two cameras are not one.
  const std::set<std::string>& otherImages() const { return otherImages_; }
  /// The video that is taken; empty before the first image.
  const std::string& imageName() const { return options_.imageName; }

  std::uint64_t refusedCount() const { return refused_; }  ///< samples that were too old or without a sensible time
  std::uint64_t clockJumpCount() const { return clockJumps_; }

private:
  bool isWanted(const DeviceSample& sample);
  bool isReady(const DeviceSample& image) const;
  double missingLatencySec(const DeviceSample& image) const;
  PairedFrame pair(DeviceSample image) const;

  FramePairingOptions options_;
  std::map<std::string, PoseTrack> tracks_;
  std::deque<DeviceSample> waiting_;
  std::set<std::string> otherImages_;
  double newestSec_ = 0;
  std::uint64_t refused_ = 0, clockJumps_ = 0;
};

/// How far a source's clock is from this computer's: the smallest of (received - measured) over the last samples, since transport
/// can
/// only delay.
class ClockOffset
{
public:
  /// @return the source's time by this computer's clock
  double toLocalSec(double timeSec, double receivedSec);

private:
  std::deque<double> differences_;
};

}  // namespace handeye::devices
