// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Source.h"

#include <chrono>
#include <exception>

namespace handeye::devices
{

namespace
{

constexpr double RetrySec = 0.5;

/// A hostile sender may invent names without end.
constexpr std::size_t LargestStreamCount = 1000;

const char* typeOf(const DeviceSample& sample)
{
  return sample.pose() ? "pose" : sample.frame() ? "image" : sample.text() ? "text" : "status";
}

}  // namespace

Source::Source(const SampleBufferOptions& buffer)
  : buffer_(buffer)
{
}

Source::~Source() = default;

void Source::start()
{
  if (thread_.joinable() && status().state != SourceState::Finished)
  {
    return;
  }
  stopThread();
  isStopping_ = false;
  buffer_.reopen();
  setState(SourceState::Connecting, "connecting to " + name());
  thread_ = std::thread([this] { runThread(); });
}

void Source::stop()
{
  stopThread();
}

void Source::stopThread()
{
  if (!thread_.joinable())
  {
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    isStopping_ = true;
  }
  stopping_.notify_all();
  buffer_.close();
  wake();
  thread_.join();
  const std::lock_guard lock(mutex_);
  if (status_.state != SourceState::Finished)
  {
    status_.state = SourceState::Stopped;
    status_.message = "stopped";
  }
}

void Source::runThread()
{
  while (!isStopping_ && status().state != SourceState::Finished)
  {
    try
    {
      run();
    }
    catch (const std::exception& error)
    {
      setProblem(error.what());
    }
    if (status().state != SourceState::Finished && !sleepFor(RetrySec))
    {
      return;
    }
  }
  buffer_.close();
}

bool Source::sleepFor(double seconds)
{
  std::unique_lock lock(mutex_);
  return !stopping_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return isStopping_.load(); });
}

void Source::setState(SourceState state, const std::string& message)
{
  const std::lock_guard lock(mutex_);
  status_.state = state;
  status_.message = message;
}

void Source::setProblem(const std::string& message)
{
  const std::lock_guard lock(mutex_);
  status_.state = SourceState::Connecting;
  status_.message = status_.lastProblem = message;
}

void Source::finish(const std::string& message)
{
  const std::lock_guard lock(mutex_);
  status_.state = SourceState::Finished;
  status_.message = status_.lastProblem = message;
}

void Source::countConnection()
{
  const std::lock_guard lock(mutex_);
  ++status_.connectionCount;
}

void Source::countRefused(const std::string& message)
{
  const std::lock_guard lock(mutex_);
  ++status_.refusedCount;
  status_.message = message;
  status_.lastProblem = message;
}

bool Source::deliver(DeviceSample sample)
{
  sample.receivedSec = systemTimeSec();
  {
    const std::lock_guard lock(mutex_);
    if (streams_.size() < LargestStreamCount || streams_.count(sample.name) > 0)
    {
      StreamInfo& stream = streams_[sample.name];
      stream.name = sample.name;
      stream.type = typeOf(sample);
      ++stream.count;
      stream.lastReceivedSec = sample.receivedSec;
      stream.isValid = !sample.pose() || sample.pose()->isValid;
    }
  }
  return buffer_.push(std::move(sample));
}

SourceStatus Source::status() const
{
  const std::lock_guard lock(mutex_);
  SourceStatus status = status_;
  status.droppedCount = buffer_.droppedCount();
  for (const auto& stream : streams_)
  {
    status.streams.push_back(stream.second);
  }
  return status;
}

std::string toString(SourceState state)
{
  switch (state)
  {
    case SourceState::Stopped:
      return "stopped";
    case SourceState::Connecting:
      return "connecting";
    case SourceState::Streaming:
      return "streaming";
    case SourceState::Finished:
      return "finished";
  }
  return "stopped";
}

}  // namespace handeye::devices
