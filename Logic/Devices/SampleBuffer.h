// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "DeviceSample.h"

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

namespace handeye::devices
{

struct SampleBufferOptions
{
  std::size_t maximumCount = 4096;
  std::size_t maximumBytes = std::size_t(256) << 20;
  /// What happens when it is full: the oldest samples give way (a live source must not wait), or push() waits for room (a file
  /// can).
  bool waitsForRoom = false;
};

/// Samples on their way from a source's thread to who uses them; bounded in number and memory. A sample that had to give way is
/// counted, never lost in silence. One larger than the whole buffer still goes through, alone.
///
/// Safe to share between threads.
class SampleBuffer
{
public:
  explicit SampleBuffer(const SampleBufferOptions& options = {});

  /// @return false after close()
  bool push(DeviceSample sample);

  /// The oldest sample; waits for one at most this long.
  std::optional<DeviceSample> pop(double timeoutSec);

  /// No more samples: who waits returns. What is in the buffer can still be taken.
  void close();
  void reopen();

  std::size_t size() const;
  std::size_t bytes() const;
  std::uint64_t pushedCount() const;
  std::uint64_t droppedCount() const;  ///< gave way

private:
  bool hasRoomFor(std::size_t bytes) const;

  SampleBufferOptions options_;
  mutable std::mutex mutex_;
  std::condition_variable filled_, emptied_;
  std::deque<DeviceSample> samples_;
  std::size_t bytes_ = 0;
  std::uint64_t pushed_ = 0, dropped_ = 0;
  bool isClosed_ = false;
};

}  // namespace handeye::devices
