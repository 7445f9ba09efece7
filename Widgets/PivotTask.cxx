// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PivotTask.h"

#include "WorkThread.h"

#include <cmath>
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

QString PivotTask::wordsOf(const PivotCollector::Counts& counts)
{
  const long long spare = counts.redundant + counts.repeated;
  const QString words =
    tr("%1 used of %2: %3 hidden, %4 disagree").arg(counts.kept).arg(counts.total()).arg(counts.invalid).arg(counts.disagreeing);
  return spare > 0 ? tr("%1, %2 tell nothing new").arg(words).arg(spare) : words;
}

void PivotTask::start(const QString& stylusToTracker)
{
  {
    const std::lock_guard lock(mutex_);
    collector_ = std::make_shared<PivotCollector>();
    name_ = stylusToTracker.toStdString();
  }
  ++run_;
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

void PivotTask::forget()
{
  cancel();
  ++run_;
  state_ = {};
  emit progressed();
}

void PivotTask::finish()
{
  finishAs(End::ByPerson);
}

void PivotTask::finishAs(End end)
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
    [this, collector, end, run = run_]
    {
      PivotStepResult result;
      result.calibration = collector->calibrate();
      result.usedFrames = result.calibration.used;
      result.rejectedFrames = result.calibration.rejected;
      result.repeatedFrames = result.calibration.repeated;
      result.poseFrames.resize(collector->poses().size());
      std::iota(result.poseFrames.begin(), result.poseFrames.end(), 0);
      State state;
      state.counts = collector->countsWith(result.calibration);
      state.estimate = result.calibration;
      state.coverage = collector->coverage();
      state.predictedTipErrorMm = std::sqrt(result.calibration.tipCovariance.trace());
      state.hasTipMoved = collector->hasTipMoved();
      state.isExact = result.calibration.isUsable() && state.predictedTipErrorMm <= enoughTipErrorMm();
      state.end = !result.calibration.isUsable() ? End::None : state.isExact ? end : End::ByPerson;
      if (result.calibration.isUsable())
      {
        // What was never kept counts as well.
        result.calibration.message = tr("Tip found with %1 mm RMS. Poses: %2.")
                                       .arg(result.calibration.rmsMm, 0, 'f', 2)
                                       .arg(wordsOf(state.counts))
                                       .toStdString();
      }
      QMetaObject::invokeMethod(
        this,
        [this, state, run]
        {
          if (run == run_)
          {
            state_ = state;
            emit progressed();
          }
        },
        Qt::QueuedConnection);
      tell(result, run);
    });
}

void PivotTask::calibrateRecording(const QString& path, const QString& stylusToTracker)
{
  forget();
  work_.post(
    [this, file = path.toStdString(), name = stylusToTracker.toStdString(), run = run_]
    {
      try
      {
        tell(pivotFromRecording(io::Recording::open(file), name), run);
      }
      catch (const std::exception& error)
      {
        QMetaObject::invokeMethod(
          this,
          [this, run, message = QString::fromUtf8(error.what())]
          {
            if (run == run_)
            {
              emit refused(message);
            }
          },
          Qt::QueuedConnection);
      }
    });
}

/// From the work's thread. What is found late, of an earlier pivoting or another session, is nobody's.
void PivotTask::tell(const PivotStepResult& result, int run)
{
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
    state_.isExact = collector_->isEnough();
  }
  emit progressed();
  if (state_.isExact && state_.coverage.isEnough())
  {
    finishAs(End::Enough);
  }
}

}  // namespace handeye
