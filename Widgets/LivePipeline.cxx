// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LivePipeline.h"

#include "WorkThread.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace handeye
{

namespace
{

constexpr qint64 StagesEachMs = 200, ShownEachMs = 32;
/// Frames of two eyes that are further apart are not of one moment: one of the videos stands still.
constexpr double MostApartSec = 0.2;
constexpr std::size_t RightFrames = 8;

}  // namespace

LivePipeline::LivePipeline(WorkThread& work, QObject* parent)
  : QObject(parent)
  , work_(work)
{
  nextShowing_.setSingleShot(true);
  nextShowing_.setTimerType(Qt::PreciseTimer);
  connect(&nextShowing_, &QTimer::timeout, this, &LivePipeline::show);
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
  // Its partner is kept with it: many more may come before it is this frame's turn.
  work_.postNewest(
    [this, frame, right = rightAt(frame.image.timeSec)]
    {
      if (right)
      {
        const std::lock_guard lock(mutex_);
        right_.push_front(*right);
      }
      process(frame);
    });
}

void LivePipeline::takeRight(const devices::PairedFrame& frame)
{
  const std::lock_guard lock(mutex_);
  right_.push_back(frame);
  while (right_.size() > RightFrames)
  {
    right_.pop_front();
  }
}

/// The right eye's frame that is nearest to this time.
std::optional<devices::PairedFrame> LivePipeline::rightAt(double timeSec)
{
  const std::lock_guard lock(mutex_);
  const auto apart = [timeSec](const devices::PairedFrame& frame) { return std::abs(frame.image.timeSec - timeSec); };
  const auto nearest =
    std::min_element(right_.begin(), right_.end(), [&](const auto& a, const auto& b) { return apart(a) < apart(b); });
  return nearest != right_.end() && apart(*nearest) <= MostApartSec ? std::optional(*nearest) : std::nullopt;
}

void LivePipeline::clear()
{
  {
    const std::lock_guard lock(mutex_);
    pending_.reset();
  }
  nextShowing_.stop();
  newest_.reset();
  {
    const std::lock_guard lock(mutex_);
    right_.clear();
  }
  emit shown();
}

/// In the work's thread, as what follows.
void LivePipeline::process(const devices::PairedFrame& frame)
{
  auto view = std::make_shared<LiveView>();
  view->frame = frame;
  view->right = rightAt(frame.image.timeSec);
  if (active_.detects && active_.camera)
  {
    lookForBall(*view);
  }
  for (const Listener& listener : listeners_)
  {
    listener(view->frame, view->ball);
  }
  publish(view);
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
    if (active_.drawsStages && (!sinceStages_.isValid() || sinceStages_.elapsed() > StagesEachMs))
    {
      sinceStages_.start();
      view.stages = drawBallStages(view.image(), *view.ball, active_.camera->withImageSize(view.image().cols, view.image().rows),
        active_.ballRadiusMm, active_.detection);
    }
  }
  catch (const std::exception& error)
  {
    view.problem = QString::fromUtf8(error.what());
  }
}

void LivePipeline::publish(const std::shared_ptr<LiveView>& view)
{
  bool isOnItsWay = false;
  {
    const std::lock_guard lock(mutex_);
    isOnItsWay = pending_ != nullptr;
    if (isOnItsWay && pending_->stages && !view->stages)
    {
      view->stages = std::move(pending_->stages);  // they come now and then only
    }
    pending_ = view;
  }
  if (!isOnItsWay)
  {
    QMetaObject::invokeMethod(
      this, [this] { show(); }, Qt::QueuedConnection);
  }
}

/// In the window's thread: the frame that waits, or, where it is too soon, whichever waits then.
void LivePipeline::show()
{
  const qint64 waitMs = sinceShown_.isValid() ? ShownEachMs - sinceShown_.elapsed() : 0;
  if (waitMs > 0)
  {
    nextShowing_.start(int(waitMs));
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    if (!pending_)
    {
      return;
    }
    newest_ = std::exchange(pending_, nullptr);
  }
  sinceShown_.start();
  emit shown();
}

}  // namespace handeye
