// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LatencyTask.h"

#include "Look.h"
#include "WorkThread.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace handeye
{

LatencyTask::LatencyTask(WorkThread& work, QObject* parent)
  : QObject(parent)
  , work_(work)
{
  silence_.setSingleShot(true);
  silence_.setInterval(5000);
  connect(&silence_, &QTimer::timeout, this, &LatencyTask::endInSilence);
}

void LatencyTask::start(const CameraModel& camera, const Eigen::Vector3d& tip_Stylus, const QString& markerToTracker,
  const QString& stylusToTracker, double seconds)
{
  PoseTrackOptions options;
  options.historySec = 10 * seconds;
  options.maximumRepeatSec = 0;
  {
    const std::lock_guard lock(mutex_);
    collection_ = Collection{ camera, tip_Stylus, markerToTracker.toStdString(), stylusToTracker.toStdString(), PoseTrack(options),
      PoseTrack(options), {}, seconds, -1, ++run_ };
  }
  isRunning_ = true;
  silence_.start();
  emit runningChanged();
}

QString LatencyTask::words(const TemporalCalibrationResult& result)
{
  constexpr double FastMmPerSec = 200;  // a hand that moves the camera briskly
  constexpr double GoodMm = 0.3;        // a tracker's own noise at the tip
  const auto inMs = [](double seconds) { return withUnit(1000 * seconds, 1, tr("ms")); };
  const double latencySec = result.latencySec, offMm = FastMmPerSec * result.sigmaSec;
  const QString exactness = QChar(0x00b1) + QString(QChar(0x00a0)) + inMs(result.sigmaSec);
  const bool isNoise = std::abs(latencySec) < 2 * result.sigmaSec;
  if (isNoise && FastMmPerSec * std::abs(latencySec) > GoodMm)
  {
    return tr(
      "No difference between video and tracker could be told from the noise: %1 %2. That is taken into account from now on, but "
      "measure again with wider, brisker swings.")
      .arg(inMs(std::abs(latencySec)), exactness);
  }
  const QString what = isNoise ? tr("Video and tracker are in time: %1 apart").arg(inMs(std::abs(latencySec)))
    : latencySec < 0           ? tr("The video is %1 later than the tracker").arg(inMs(-latencySec))
                               : tr("The tracker is %1 later than the video").arg(inMs(latencySec));
  const QString off = withUnit(offMm, 1, tr("mm"));
  const QString verdict = offMm <= GoodMm
    ? tr("Good: with a brisk motion (%1 mm/s) that leaves %2.").arg(FastMmPerSec, 0, 'f', 0).arg(off)
    : tr("Usable, but with a brisk motion (%1 mm/s) that leaves %2: measure again with wider swings.")
        .arg(FastMmPerSec, 0, 'f', 0)
        .arg(off);
  return tr("%1 (%2), and that is taken into account from now on. %3").arg(what, exactness, verdict);
}

void LatencyTask::endInSilence()
{
  const double waitedSec = silence_.interval() / 1000.0;
  cancel();
  emit refused(tr("The latency was not measured: no picture has come for %1 s. Is the video still connected?").arg(waitedSec));
}

void LatencyTask::cancel()
{
  {
    const std::lock_guard lock(mutex_);
    collection_.reset();
  }
  silence_.stop();
  if (std::exchange(isRunning_, false))
  {
    emit runningChanged();
  }
}

void LatencyTask::onSample(const devices::DeviceSample& sample)
{
  const std::lock_guard lock(mutex_);
  if (!collection_ || !sample.pose())
  {
    return;
  }
  for (const auto& [name, track] : { std::pair{ collection_->markerToTracker, &collection_->marker },
         std::pair{ collection_->stylusToTracker, &collection_->stylus } })
  {
    if (sample.name == name)
    {
      track->add(sample.timeSec, sample.pose()->transform, sample.pose()->isValid);
    }
  }
}

void LatencyTask::onFrame(const devices::PairedFrame& frame, const std::optional<BallDetection>& ball)
{
  bool isDone = false;
  double share = 0;
  int run = 0;
  {
    const std::lock_guard lock(mutex_);
    if (!collection_)
    {
      return;
    }
    const double timeSec = frame.image.timeSec;
    collection_->beginSec = collection_->beginSec < 0 ? timeSec : collection_->beginSec;
    if (ball && ball->isFound() && ball->distanceMm > 0)
    {
      collection_->sightings.push_back({ timeSec, ball->ray_Camera, ball->distanceMm });
    }
    share = std::clamp((timeSec - collection_->beginSec) / collection_->seconds, 0.0, 1.0);
    isDone = share >= 1;
    run = collection_->run;
  }
  QMetaObject::invokeMethod(
    this,
    [this, share, isDone, run]
    {
      if (!isRunning_ || run != run_)
      {
        return;  // cancelled meanwhile, or measured again
      }
      isDone ? silence_.stop() : silence_.start();
      emit progressed(share);
    },
    Qt::QueuedConnection);
  if (isDone)
  {
    evaluate(run);
  }
}

/// In the work's thread.
void LatencyTask::evaluate(int run)
{
  std::optional<Collection> collection;
  {
    const std::lock_guard lock(mutex_);
    if (!collection_ || collection_->run != run)
    {
      return;  // cancelled at this moment, or measured again
    }
    collection = std::exchange(collection_, std::nullopt);
  }
  TemporalCalibrationResult result;
  try
  {
    result =
      calibrateLatency(collection->sightings, collection->marker, collection->stylus, collection->tip_Stylus, collection->camera);
  }
  catch (const std::exception& error)
  {
    result.message = error.what();
  }
  QMetaObject::invokeMethod(
    this,
    [this, result, run]
    {
      if (!isRunning_ || run != run_)
      {
        return;
      }
      isRunning_ = false;
      emit runningChanged();
      if (result.isUsable())
      {
        emit measured(result);
      }
      else
      {
        emit refused(tr("The latency was not measured: %1.").arg(QString::fromStdString(result.message)));
      }
    },
    Qt::QueuedConnection);
}

}  // namespace handeye
