// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Acquisition.h"

#include <chrono>
#include <utility>

namespace handeye
{

Acquisition::Acquisition(std::vector<std::shared_ptr<devices::Source>> sources, const devices::FramePairingOptions& pairing,
  SampleHandler onSample, FrameHandler onFrame)
  : sources_(std::move(sources))
  , offsets_(sources_.size())
  , pairing_(std::make_unique<devices::FramePairing>(pairing))
  , onSample_(std::move(onSample))
  , onFrame_(std::move(onFrame))
{
  for (const auto& source : sources_)
  {
    source->start();
  }
  thread_ = std::thread([this] { run(); });
}

Acquisition::~Acquisition()
{
  isEnding_ = true;
  for (const auto& source : sources_)
  {
    source->stop();
  }
  thread_.join();
}

void Acquisition::disconnect()
{
  const std::lock_guard lock(mutex_);
  onSample_ = nullptr;
  onFrame_ = nullptr;
  onRightFrame_ = nullptr;
}

void Acquisition::setPairing(const devices::FramePairingOptions& pairing)
{
  const std::lock_guard lock(mutex_);
  pairing_ = std::make_unique<devices::FramePairing>(pairing);
}

void Acquisition::setRightPairing(const devices::FramePairingOptions& pairing, FrameHandler onRightFrame)
{
  const std::lock_guard lock(mutex_);
  rightPairing_ = pairing.imageName.empty() ? nullptr : std::make_unique<devices::FramePairing>(pairing);
  onRightFrame_ = std::move(onRightFrame);
}

std::vector<Acquisition::NamedStatus> Acquisition::status() const
{
  std::vector<NamedStatus> list;
  for (const auto& source : sources_)
  {
    list.push_back({ source->name(), source->status() });
  }
  return list;
}

void Acquisition::run()
{
  constexpr double waitSec = 0.02;
  while (!isEnding_)
  {
    bool isIdle = true;
    for (std::size_t i = 0; i < sources_.size(); ++i)
    {
      std::optional<devices::DeviceSample> sample = sources_[i]->pop(sources_.size() > 1 ? 0 : waitSec);
      if (!sample)
      {
        continue;
      }
      if (sources_.size() > 1)
      {
        sample->timeSec = offsets_[i].toLocalSec(sample->timeSec, sample->receivedSec);
      }
      handle(std::move(*sample));
      isIdle = false;
    }
    if (isIdle)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(4));
    }
  }
}

void Acquisition::handle(devices::DeviceSample sample)
{
  const std::lock_guard lock(mutex_);
  if (!onSample_)
  {
    return;
  }
  onSample_(sample);
  if (rightPairing_ && onRightFrame_)
  {
    rightPairing_->add(sample);
    while (std::optional<devices::PairedFrame> frame = rightPairing_->take())
    {
      onRightFrame_(*frame);
    }
  }
  pairing_->add(std::move(sample));
  while (std::optional<devices::PairedFrame> frame = pairing_->take())
  {
    onFrame_(*frame);
  }
}

}  // namespace handeye
