// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "SampleBuffer.h"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace handeye::devices
{

enum class SourceState
{
  Stopped,     ///< not started, or stopped
  Connecting,  ///< not there (yet); it is tried again and again
  Streaming,   ///< connected
  Finished     ///< a recording came to its end
};

/// What is streamed under one name.
struct StreamInfo
{
  std::string name;
  std::string type;  ///< "pose", "image", "text", "status"
  std::uint64_t count = 0;
  double lastReceivedSec = 0;  ///< seconds since 1970
  bool isValid = true;         ///< of a pose: the last one
};

/// What a window shows of a source.
struct SourceStatus
{
  SourceState state = SourceState::Stopped;
  std::string message;                ///< for a person: what it does, or what went wrong last
  std::string lastProblem;            ///< what went wrong last; stays when it has gone on
  std::uint64_t connectionCount = 0;  ///< how often it was connected; more than once: it came back
  std::uint64_t refusedCount = 0;     ///< messages that were damaged or made no sense
  std::uint64_t droppedCount = 0;     ///< samples that gave way because nobody took them
  std::vector<StreamInfo> streams;    ///< by name
};

/// Something that delivers samples: a tracker's server, a camera, a recording. Each has its own thread, from start() to stop(),
/// and a
/// bounded buffer that pop() takes from. A source that is lost (server gone, cable pulled) says so in its status and is tried again
/// until stop(); it never throws from its thread.
///
/// All functions are safe to call from any thread; start() and stop() one at a time.
class Source
{
public:
  explicit Source(const SampleBufferOptions& buffer = {});
  virtual ~Source();
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  /// What a person calls it: "127.0.0.1:18944", "camera 0", a file's name.
  virtual std::string name() const = 0;

  /// Again after stop(), or after it came to its end: with an empty buffer.
  void start();
  /// Returns when the thread has ended; samples in the buffer can still be taken.
  void stop();

  /// The next sample; waits for one at most this long.
  std::optional<DeviceSample> pop(double timeoutSec) { return buffer_.pop(timeoutSec); }

  SourceStatus status() const;
  const SampleBuffer& buffer() const { return buffer_; }

protected:
  /// Runs in the thread until isStopping(); exceptions that leave it are shown, and it is called again after a while.
  virtual void run() = 0;
  /// Called by stop() from another thread: wakes what run() waits for.
  virtual void wake() {}

  bool isStopping() const { return isStopping_; }
  /// @return false if it was woken by stop()
  bool sleepFor(double seconds);

  /// Nothing more can come, and why: what cannot be read today will not be tomorrow. The last problem, too.
  void finish(const std::string& message);
  /// Connecting again, and why: the message, and the last problem.
  void setProblem(const std::string& message);
  void setState(SourceState state, const std::string& message);
  void countConnection();
  void countRefused(const std::string& message);
  bool deliver(DeviceSample sample);

  /// Every derived class calls this first in its destructor, since the thread uses its members.
  void stopThread();

private:
  void runThread();

  SampleBuffer buffer_;
  std::thread thread_;
  std::atomic<bool> isStopping_{ false };
  mutable std::mutex mutex_;
  std::condition_variable stopping_;
  SourceStatus status_;
  std::map<std::string, StreamInfo> streams_;
};

/// "stopped", "connecting", "streaming", "finished"
std::string toString(SourceState state);

}  // namespace handeye::devices
