// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SpinTask.h"

#include "WorkThread.h"

#include <algorithm>
#include <utility>

namespace handeye
{

namespace
{

constexpr int PollMs = 250;
constexpr std::size_t Capacity = 800;

/// Every second one is left out.
template<typename Value> void thin(std::vector<Value>& values)
{
  for (std::size_t i = 0; 2 * i < values.size(); ++i)
  {
    values[i] = values[2 * i];
  }
  values.resize((values.size() + 1) / 2);
}

}  // namespace

double SpinTask::State::share() const
{
  const double ofPoses = double(estimate.used.size()) / EnoughPoses, ofSpin = estimate.spin / EnoughSpin;
  return std::clamp(std::min(ofPoses, ofSpin), 0.0, 1.0);
}

bool SpinTask::State::isEnough() const
{
  return estimate.isUsable() && share() >= 1 && estimate.shaftSigma <= EnoughSigma;
}

SpinTask::SpinTask(WorkThread& work, QObject* parent)
  : QObject(parent)
  , work_(work)
{
  timer_.setInterval(PollMs);
  connect(&timer_, &QTimer::timeout, this, &SpinTask::poll);
}

void SpinTask::start(const QString& stylusToTracker, const Eigen::Vector3d& tip_Stylus)
{
  {
    const std::lock_guard lock(mutex_);
    collection_ = {};
    name_ = stylusToTracker.toStdString();
  }
  ++run_;
  tip_Stylus_ = tip_Stylus;
  state_ = {};
  isEstimating_ = false;
  isCollecting_ = true;
  timer_.start();
  emit collectingChanged();
}

/// Nothing more is collected, and an estimate that is still under way is nobody's.
void SpinTask::end()
{
  {
    const std::lock_guard lock(mutex_);
    name_.clear();
  }
  ++run_;
  timer_.stop();
  if (std::exchange(isCollecting_, false))
  {
    emit collectingChanged();
  }
}

void SpinTask::cancel()
{
  state_ = {};
  end();
}

void SpinTask::finish()
{
  if (!isCollecting_)
  {
    return;
  }
  end();
  Collection collection;
  {
    const std::lock_guard lock(mutex_);
    collection = std::exchange(collection_, {});
  }
  work_.post(
    [this, collection = std::move(collection), tip_Stylus = tip_Stylus_, run = run_]
    {
      const SpinStepResult result = calibrate(collection, tip_Stylus);
      QMetaObject::invokeMethod(
        this,
        [this, result, run]
        {
          if (run != run_)
          {
            return;
          }
          if (result.calibration.isUsable())
          {
            emit calibrated(result);
          }
          else
          {
            emit refused(QString::fromStdString(result.calibration.message));
          }
        },
        Qt::QueuedConnection);
    });
}

SpinStepResult SpinTask::calibrate(const Collection& collection, const Eigen::Vector3d& tip_Stylus)
{
  SpinStepResult result;
  result.calibration = calibrateSpin(collection.stylusToTracker, tip_Stylus);
  for (const auto& [indices, frames] :
    { std::pair(&result.calibration.used, &result.usedFrames), std::pair(&result.calibration.rejected, &result.rejectedFrames) })
  {
    for (const int index : *indices)
    {
      frames->push_back(collection.frames[std::size_t(index)]);
    }
  }
  result.invalidFrames = collection.invalidFrames;
  return result;
}

void SpinTask::onSample(const devices::DeviceSample& sample)
{
  if (!sample.pose())
  {
    return;
  }
  const std::lock_guard lock(mutex_);
  if (name_.empty() || sample.name != name_)
  {
    return;
  }
  const int frame = collection_.next++;
  if (frame % collection_.each != 0)
  {
    return;
  }
  if (sample.pose()->isValid && sample.pose()->transform.matrix().allFinite())
  {
    collection_.stylusToTracker.push_back(sample.pose()->transform);
    collection_.frames.push_back(frame);
  }
  else
  {
    collection_.invalidFrames.push_back(frame);
  }
  if (std::max(collection_.frames.size(), collection_.invalidFrames.size()) >= Capacity)
  {
    thin(collection_.stylusToTracker);
    thin(collection_.frames);
    thin(collection_.invalidFrames);
    collection_.each *= 2;
  }
}

/// The estimate is made beside the window, one at a time.
void SpinTask::poll()
{
  if (std::exchange(isEstimating_, true))
  {
    return;
  }
  Collection collection;
  {
    const std::lock_guard lock(mutex_);
    collection = collection_;
  }
  work_.post(
    [this, collection = std::move(collection), tip_Stylus = tip_Stylus_, run = run_]
    {
      State state;
      state.poses = int(collection.frames.size());
      state.hidden = int(collection.invalidFrames.size());
      state.estimate = calibrate(collection, tip_Stylus).calibration;
      QMetaObject::invokeMethod(
        this,
        [this, state, run]
        {
          if (run != run_)
          {
            return;
          }
          isEstimating_ = false;
          state_ = state;
          emit progressed();
          if (state_.isEnough())
          {
            finish();
          }
        },
        Qt::QueuedConnection);
    });
}

}  // namespace handeye
