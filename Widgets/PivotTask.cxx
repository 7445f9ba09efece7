// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PivotTask.h"

#include "WorkThread.h"

#include <numeric>
#include <utility>

namespace handeye
{

PivotTask::PivotTask(WorkThread& work, QObject* parent)
  : QObject(parent)
  , work_(work)
{
  timer_.setInterval(100);
  connect(&timer_, &QTimer::timeout, this, &PivotTask::poll);
}

void PivotTask::start(const QString& stylusToTracker)
{
  {
    const std::lock_guard lock(mutex_);
    collector_ = std::make_shared<PivotCollector>();
    name_ = stylusToTracker.toStdString();
  }
  state_ = {};
  isCollecting_ = true;
  timer_.start();
  emit collectingChanged();
}

void PivotTask::cancel()
{
  {
    const std::lock_guard lock(mutex_);
    collector_.reset();
  }
  timer_.stop();
  if (std::exchange(isCollecting_, false))
  {
    emit collectingChanged();
  }
}

void PivotTask::finish()
{
  std::shared_ptr<PivotCollector> collector;
  {
    const std::lock_guard lock(mutex_);
    collector = collector_;
  }
  cancel();
  if (!collector)
  {
    return;
  }
  work_.post(
    [this, collector]
    {
      PivotStepResult result;
      result.calibration = collector->calibrate();
      result.usedFrames = result.calibration.used;
      result.rejectedFrames = result.calibration.rejected;
      result.repeatedFrames = result.calibration.repeated;
      result.poseFrames.resize(collector->poses().size());
      std::iota(result.poseFrames.begin(), result.poseFrames.end(), 0);
      tell(result);
    });
}

void PivotTask::calibrateRecording(const QString& path, const QString& stylusToTracker)
{
  work_.post(
    [this, file = path.toStdString(), name = stylusToTracker.toStdString()]
    {
      try
      {
        tell(pivotFromRecording(io::Recording::open(file), name));
      }
      catch (const std::exception& error)
      {
        QMetaObject::invokeMethod(
          this, [this, message = QString::fromUtf8(error.what())] { emit refused(message); }, Qt::QueuedConnection);
      }
    });
}

/// From the work's thread.
void PivotTask::tell(const PivotStepResult& result)
{
  QMetaObject::invokeMethod(
    this,
    [this, result]
    {
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
}

void PivotTask::onSample(const devices::DeviceSample& sample)
{
  if (!sample.pose())
  {
    return;
  }
  const std::lock_guard lock(mutex_);
  if (!collector_ || sample.name != name_)
  {
    return;
  }
  sample.pose()->isValid ? collector_->add(sample.pose()->transform) : collector_->addInvalid();
}

void PivotTask::poll()
{
  {
    const std::lock_guard lock(mutex_);
    if (!collector_)
    {
      return;
    }
    state_.counts = collector_->counts();
    state_.estimate = collector_->estimate();
    state_.coverage = collector_->coverage();
    state_.predictedTipErrorMm = collector_->predictedTipErrorMm();
    state_.hasTipMoved = collector_->hasTipMoved();
    state_.isEnough = collector_->isEnough();
  }
  emit progressed();
}

}  // namespace handeye
