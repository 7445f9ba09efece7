// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampleBuffer.h"

#include <chrono>
#include <stdexcept>

namespace handeye::devices
{

SampleBuffer::SampleBuffer(const SampleBufferOptions& options)
  : options_(options)
{
  if (options.maximumCount == 0 || options.maximumBytes == 0)
  {
    throw std::invalid_argument("sample buffer: room for at least one sample is expected");
  }
}

bool SampleBuffer::hasRoomFor(std::size_t bytes) const
{
  return samples_.empty() || (samples_.size() < options_.maximumCount && bytes_ + bytes <= options_.maximumBytes);
}

bool SampleBuffer::push(DeviceSample sample)
{
  const std::size_t bytes = sample.bytes();
  std::unique_lock lock(mutex_);
  if (options_.waitsForRoom)
  {
    emptied_.wait(lock, [&] { return isClosed_ || hasRoomFor(bytes); });
  }
  if (isClosed_)
  {
    return false;
  }
  while (!hasRoomFor(bytes))
  {
    bytes_ -= samples_.front().bytes();
    samples_.pop_front();
    ++dropped_;
  }
  bytes_ += bytes;
  samples_.push_back(std::move(sample));
  ++pushed_;
  lock.unlock();
  filled_.notify_one();
  return true;
}

std::optional<DeviceSample> SampleBuffer::pop(double timeoutSec)
{
  std::unique_lock lock(mutex_);
  filled_.wait_for(lock, std::chrono::duration<double>(timeoutSec), [&] { return isClosed_ || !samples_.empty(); });
  if (samples_.empty())
  {
    return std::nullopt;
  }
  DeviceSample sample = std::move(samples_.front());
  samples_.pop_front();
  bytes_ -= sample.bytes();
  lock.unlock();
  emptied_.notify_one();
  return sample;
}

void SampleBuffer::close()
{
  const std::lock_guard lock(mutex_);
  isClosed_ = true;
  filled_.notify_all();
  emptied_.notify_all();
}

void SampleBuffer::reopen()
{
  const std::lock_guard lock(mutex_);
  samples_.clear();
  bytes_ = 0;
  isClosed_ = false;
}

std::size_t SampleBuffer::size() const
{
  const std::lock_guard lock(mutex_);
  return samples_.size();
}

std::size_t SampleBuffer::bytes() const
{
  const std::lock_guard lock(mutex_);
  return bytes_;
}

std::uint64_t SampleBuffer::pushedCount() const
{
  const std::lock_guard lock(mutex_);
  return pushed_;
}

std::uint64_t SampleBuffer::droppedCount() const
{
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace handeye::devices
