// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OverlayRecordingTask.h"

#include <QDateTime>
#include <QDir>

namespace handeye
{

namespace
{

using Phase = OverlayRecordingState::Phase;

constexpr int PollMs = 250;

}  // namespace

OverlayRecordingTask::OverlayRecordingTask(QObject* parent)
  : QObject(parent)
{
  timer_.setInterval(PollMs);
  connect(&timer_, &QTimer::timeout, this, &OverlayRecordingTask::poll);
}

void OverlayRecordingTask::fail(const QString& message)
{
  timer_.stop();
  recorder_.reset();
  state_.phase = Phase::Failed;
  state_.message = message;
  emit changed(state_);
}

bool OverlayRecordingTask::start(const QString& folder, const QString& ending, const QString& note)
{
  if (isRecording() || state_.phase == Phase::Finishing)
  {
    return false;
  }
  const QString time = QDateTime::currentDateTime().toString(QStringLiteral("yyyyMMdd-HHmmss-zzz"));
  state_ = {};
  state_.message = note_ = note;
  state_.path = QDir(folder).filePath(QStringLiteral("overlay-%1%2").arg(time, ending));
  try
  {
    if (folder.isEmpty() || !QDir().mkpath(folder))
    {
      fail(folder.isEmpty() ? tr("no session is open") : tr("the folder %1 cannot be made").arg(folder));
      return false;
    }
    recorder_ = std::make_unique<LiveOverlayRecorder>(state_.path.toStdString());
  }
  catch (const std::exception& error)
  {
    fail(QString::fromUtf8(error.what()));
    return false;
  }
  state_.phase = Phase::Recording;
  clock_.start();
  timer_.start();
  emit changed(state_);
  return true;
}

void OverlayRecordingTask::stop()
{
  if (isRecording())
  {
    recorder_->finish();
    state_.phase = Phase::Finishing;
    state_.elapsedSec = double(clock_.elapsed()) / 1000;
    poll();
  }
}

void OverlayRecordingTask::add(const cv::Mat& bgr, double timeSec, const OverlayTransformSet& transforms)
{
  if (isRecording())
  {
    recorder_->add(bgr, timeSec, transforms);
  }
}

void OverlayRecordingTask::poll()
{
  const LiveOverlayRecorder::State written = recorder_->state();
  if (isRecording())
  {
    state_.elapsedSec = double(clock_.elapsed()) / 1000;
  }
  state_.pictureCount = written.pictureCount + written.waitingCount;
  state_.leftOutCount = written.leftOutCount;
  state_.message = written.leftOutCount > 0
    ? tr("%1 pictures are left out: %2.").arg(written.leftOutCount).arg(QString::fromStdString(written.leftOutReason))
    : note_;
  if (!written.error.empty())
  {
    fail(QString::fromStdString(written.error));
    return;
  }
  if (written.isFinished)
  {
    timer_.stop();
    recorder_.reset();
    state_.phase = Phase::Stored;
  }
  emit changed(state_);
}

}  // namespace handeye
