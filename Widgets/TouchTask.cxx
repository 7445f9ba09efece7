// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TouchTask.h"

#include <QCoreApplication>

#include <utility>

namespace handeye
{

namespace
{

constexpr double LongestWaitSec = 0.3;  // stream time that a stylus' pose waits for the phantom's
constexpr double ClockJumpSec = 10;     // a time that goes back by more is a clock that was set
constexpr std::chrono::milliseconds Silence(700);

}  // namespace

void TouchTask::follow(
  const std::optional<Eigen::Vector3d>& tip_Stylus, const std::string& stylusToTracker, const std::string& phantomToTracker)
{
  const std::lock_guard lock(mutex_);
  if (tip_Stylus != tip_Stylus_ || stylusToTracker != stylusToTracker_ || phantomToTracker != phantomToTracker_)
  {
    stylusToTracker_ = stylusToTracker;
    phantomToTracker_ = phantomToTracker;
    tip_Stylus_ = tip_Stylus;
    clear();
  }
}

void TouchTask::restart()
{
  const std::lock_guard lock(mutex_);
  clear();
}

void TouchTask::clear()
{
  stylus_.clear();
  phantom_.clear();
  waitingSec_.clear();
  stillness_.reset();
  touch_ = {};
  taken_ = {};
}

void TouchTask::onSample(const devices::DeviceSample& sample)
{
  const std::lock_guard lock(mutex_);
  const bool isStylus = sample.name == stylusToTracker_;
  if (!sample.pose() || !tip_Stylus_ || (!isStylus && sample.name != phantomToTracker_) || !(sample.timeSec >= 0))
  {
    return;
  }
  if (sample.timeSec < std::max(stylus_.newestSec(), phantom_.newestSec()) - ClockJumpSec)
  {
    clear();
  }
  const bool isValid = sample.pose()->isValid && sample.pose()->transform.matrix().allFinite();
  const bool isNew = !isStylus || stylus_.isEmpty() || sample.timeSec > stylus_.newestSec();
  (isStylus ? stylus_ : phantom_).add(sample.timeSec, sample.pose()->transform, isValid);
  if (isStylus && isNew)
  {
    waitingSec_.push_back(sample.timeSec);
  }
  const double newestSec = std::max(stylus_.newestSec(), phantom_.newestSec());
  while (!waitingSec_.empty() && (phantom_.newestSec() >= waitingSec_.front() || newestSec - waitingSec_.front() > LongestWaitSec))
  {
    take(waitingSec_.front());
    waitingSec_.pop_front();
  }
}

/// The moment has all it waits for, or has waited long enough.
void TouchTask::take(double timeSec)
{
  taken_ = std::chrono::steady_clock::now();
  touch_ = {};
  if (!stillness_)
  {
    stillness_.emplace(*tip_Stylus_);
  }
  const PoseAtTime stylusToTracker = stylus_.at(timeSec), phantomToTracker = phantom_.at(timeSec);
  for (const auto& [name, pose] : { std::pair(&stylusToTracker_, &stylusToTracker), { &phantomToTracker_, &phantomToTracker } })
  {
    if (!pose->isUsable())
    {
      touch_.problem = QString::fromStdString(*name + ": " + pose->message);
      (void)stillness_->addInvalid(timeSec);
      return;
    }
  }
  const Eigen::Isometry3d stylusToPhantom = phantomToTracker.transform.inverse() * stylusToTracker.transform;
  touch_.tip_Phantom = stylusToPhantom * *tip_Stylus_;
  (void)stillness_->add(timeSec, stylusToPhantom);
  if (const std::optional<Rest> rest = stillness_->current())
  {
    touch_.rest_Phantom = rest->tip_World;
  }
}

TouchTask::Touch TouchTask::newest() const
{
  const std::lock_guard lock(mutex_);
  Touch touch;
  if (!tip_Stylus_)
  {
    touch.problem = QCoreApplication::translate("handeye::TouchTask", "The stylus is not calibrated yet.");
  }
  else if (std::chrono::steady_clock::now() - taken_ > Silence)
  {
    touch.problem =
      QCoreApplication::translate("handeye::TouchTask", "%1: no pose is received").arg(QString::fromStdString(stylusToTracker_));
  }
  else
  {
    touch = touch_;
  }
  return touch;
}

}  // namespace handeye
