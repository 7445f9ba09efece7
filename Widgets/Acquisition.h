// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "FramePairing.h"
#include "Source.h"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace handeye
{

/// Sources that are running, and the thread that takes what they deliver: every sample goes to `onSample`, and every frame with
/// the poses of its moment (see devices::FramePairing) to `onFrame`, both in that thread. A second video, that of a stereo rig's
/// right eye, is paired with the same poses and goes to `onRightFrame`.
///
/// Of several sources the times are brought to this computer's clock.
class Acquisition
{
public:
  using SampleHandler = std::function<void(const devices::DeviceSample&)>;
  using FrameHandler = std::function<void(const devices::PairedFrame&)>;

  Acquisition(std::vector<std::shared_ptr<devices::Source>> sources, const devices::FramePairingOptions& pairing,
    SampleHandler onSample, FrameHandler onFrame);
  /// Stops the sources, which may take as long as a camera likes: not for the thread of a window.
  ~Acquisition();
  Acquisition(const Acquisition&) = delete;
  Acquisition& operator=(const Acquisition&) = delete;

  /// No more calls of the handlers once this has returned; the sources still run.
  void disconnect();

  /// The pairing begins anew with other names or another latency.
  void setPairing(const devices::FramePairingOptions& pairing);
  /// The right eye's video, by the name of its images; an empty name: there is none.
  void setRightPairing(const devices::FramePairingOptions& pairing, FrameHandler onRightFrame);

  struct NamedStatus
  {
    std::string source;
    devices::SourceStatus status;
  };
  std::vector<NamedStatus> status() const;

private:
  void run();
  void handle(devices::DeviceSample sample);

  std::vector<std::shared_ptr<devices::Source>> sources_;
  std::vector<devices::ClockOffset> offsets_;
  std::mutex mutex_;  ///< of the handlers and the pairing
  std::unique_ptr<devices::FramePairing> pairing_, rightPairing_;
  SampleHandler onSample_;
  FrameHandler onFrame_, onRightFrame_;
  std::atomic<bool> isEnding_{ false };
  std::thread thread_;
};

}  // namespace handeye
