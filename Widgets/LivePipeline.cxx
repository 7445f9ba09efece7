// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LivePipeline.h"

#include "WorkThread.h"

#include <utility>

namespace handeye
{

namespace
{

constexpr double StagesEachSec = 0.2, ShownEachSec = 1.0 / 31;

}  // namespace

LivePipeline::LivePipeline(WorkThread& work, QObject* parent)
  : QObject(parent)
  , work_(work)
{
}

void LivePipeline::setSettings(const Settings& settings)
{
  settings_ = settings;
  work_.post(
    [this, settings]
    {
      active_ = settings;
      tracker_.reset();
    });
}

void LivePipeline::take(const devices::PairedFrame& frame)
{
  work_.postNewest([this, frame] { process(frame); });
}

void LivePipeline::clear()
{
  newest_.reset();
  emit shown();
}

/// In the work's thread, as what follows.
void LivePipeline::process(const devices::PairedFrame& frame)
{
  auto view = std::make_shared<LiveView>();
  view->frame = frame;
  if (active_.detects && active_.camera)
  {
    lookForBall(*view);
  }
  for (const Listener& listener : listeners_)
  {
    listener(view->frame, view->ball);
  }
  publish(std::move(view));
}

void LivePipeline::lookForBall(LiveView& view)
{
  try
  {
    if (!tracker_)
    {
      tracker_ = std::make_unique<BallTracker>(
        BallDetector(active_.camera->withImageSize(view.image().cols, view.image().rows), active_.ballRadiusMm, active_.detection));
    }
    view.ball = tracker_->next(view.image());
    const double nowSec = devices::systemTimeSec();
    if (active_.drawsStages && nowSec - stagesSec_ > StagesEachSec)
    {
      stagesSec_ = nowSec;
      view.stages = drawBallStages(view.image(), *view.ball, active_.camera->withImageSize(view.image().cols, view.image().rows),
        active_.ballRadiusMm, active_.detection);
    }
  }
  catch (const std::exception& error)
  {
    view.problem = QString::fromUtf8(error.what());
  }
}

void LivePipeline::publish(std::shared_ptr<const LiveView> view)
{
  const double nowSec = devices::systemTimeSec();
  if (nowSec - publishedSec_ < ShownEachSec && !view->stages)
  {
    return;
  }
  publishedSec_ = nowSec;
  bool isOnItsWay = false;
  {
    const std::lock_guard lock(mutex_);
    isOnItsWay = pending_ != nullptr;
    pending_ = std::move(view);
  }
  if (!isOnItsWay)
  {
    QMetaObject::invokeMethod(
      this,
      [this]
      {
        {
          const std::lock_guard lock(mutex_);
          newest_ = std::exchange(pending_, nullptr);
        }
        emit shown();
      },
      Qt::QueuedConnection);
  }
}

}  // namespace handeye
