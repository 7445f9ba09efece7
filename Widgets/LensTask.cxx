// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LensTask.h"

#include "BoardPattern.h"
#include "LensCollection.h"
#include "Recording.h"
#include "WorkThread.h"

#include <opencv2/core.hpp>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

namespace handeye
{

namespace
{

LensViewCollectorOptions optionsFor(bool isLive)
{
  LensViewCollectorOptions options;
  options.stillFrames = isLive ? options.stillFrames : 1;
  return options;
}

}  // namespace

/// Views of one board; of the work's thread, but for `board` and `isLive`, which stay as they are.
struct LensTask::Collection
{
  Collection(const BoardDescription& ofBoard, bool isOfLiveVideo)
    : board(ofBoard)
    , isLive(isOfLiveVideo)
    , pictures(ofBoard, optionsFor(isOfLiveVideo))
  {
  }

  void add(const cv::Mat& image);

  const BoardDescription board;
  const bool isLive;
  LensCollection pictures;
  State state;
};

void LensTask::Collection::add(const cv::Mat& image)
{
  const LensCollection::Look look = pictures.add(image);
  const LensViewCollector& collector = *pictures.collector();
  state.width = pictures.width();
  state.height = pictures.height();
  state.pictures = pictures.pictureCount();
  state.withBoard = pictures.withBoardCount();
  state.wasTaken = look.isTaken;
  state.seen = QString::fromStdString(look.message);
  state.hint = QString::fromStdString(collector.hint());
  if (look.isTaken)
  {
    const LensView& view = collector.views().back();
    state.points_Image.insert(state.points_Image.end(), view.points_Image.begin(), view.points_Image.end());
    state.views = int(collector.views().size());
    state.coverage = collector.coverage();
    state.coverageShare = collector.coverageShare();
    state.completeness = collector.completeness();
  }
}

LensTask::LensTask(WorkThread& work, QObject* parent)
  : QObject(parent)
  , work_(work)
  , isCancelled_(std::make_shared<std::atomic<bool>>(false))
{
}

LensTask::~LensTask() = default;

void LensTask::setLive(const std::shared_ptr<Collection>& collection)
{
  {
    const std::lock_guard lock(mutex_);
    live_ = collection;
  }
  isCollecting_ = collection != nullptr;
  emit changed();
}

void LensTask::start(const BoardDescription& board)
{
  if (isWorking_)
  {
    return;
  }
  if (!collection_ || !collection_->isLive || toString(collection_->board) != toString(board))
  {
    clear();
    collection_ = std::make_shared<Collection>(board, true);
  }
  setLive(collection_);
}

void LensTask::stop()
{
  if (isCollecting_)
  {
    setLive(nullptr);
  }
}

void LensTask::clear()
{
  cancel();
  collection_.reset();
  state_ = {};
  result_.reset();
  setLive(nullptr);
}

void LensTask::cancel()
{
  if (isWorking_ && !isCancelled_->exchange(true))
  {
    emit changed();
  }
}

void LensTask::onFrame(const devices::PairedFrame& frame)
{
  std::shared_ptr<Collection> collection;
  {
    const std::lock_guard lock(mutex_);
    collection = live_;
  }
  if (!collection || !frame.image.frame())
  {
    return;
  }
  try
  {
    collection->add(frame.image.frame()->image);
    publish(collection);
  }
  catch (const std::exception& error)
  {
    tell(
      [this, message = QString::fromUtf8(error.what())]
      {
        stop();
        emit refused(message);
      });
  }
}

void LensTask::tell(std::function<void()> news)
{
  QMetaObject::invokeMethod(this, std::move(news), Qt::QueuedConnection);
}

/// From the work's thread.
void LensTask::publish(const std::shared_ptr<Collection>& collection)
{
  tell(
    [this, collection, state = collection->state]
    {
      if (collection == collection_)
      {
        state_ = state;
        emit progressed();
      }
    });
}

LensTask::Flag LensTask::beginWork()
{
  stop();
  isCancelled_ = std::make_shared<std::atomic<bool>>(false);
  isWorking_ = true;
  emit changed();
  return isCancelled_;
}

void LensTask::calibrate()
{
  if (isWorking_)
  {
    return;
  }
  if (!collection_)
  {
    emit refused(tr("No views of a board have been taken: start, and show the board to the camera."));
    return;
  }
  const Flag isCancelled = beginWork();
  work_.post([this, collection = collection_, isCancelled] { work(collection, isCancelled, [] { return true; }); });
}

void LensTask::calibrateRecording(const QString& path, const BoardDescription& board)
{
  if (isWorking_)
  {
    return;
  }
  clear();
  collection_ = std::make_shared<Collection>(board, false);
  const Flag isCancelled = beginWork();
  work_.post([this, path, collection = collection_, isCancelled]
    { work(collection, isCancelled, [&] { return readRecording(path, collection, isCancelled); }); });
}

/// In the work's thread. @return false if it was cancelled
bool LensTask::readRecording(const QString& path, const std::shared_ptr<Collection>& collection, const Flag& isCancelled)
{
  const io::Recording recording = io::Recording::openImages(path.toStdString());
  for (int frame = 0; frame < recording.frameCount(); ++frame)
  {
    if (*isCancelled || work_.isCancelled())
    {
      return false;
    }
    if (recording.hasImage(frame))
    {
      collection->add(recording.image(frame));
      publish(collection);
    }
    tell([this, done = frame + 1, total = recording.frameCount()] { emit worked(done, total); });
  }
  return true;
}

/// In the work's thread: views, and the lens from them.
void LensTask::work(const std::shared_ptr<Collection>& collection, const Flag& isCancelled, const std::function<bool()>& prepare)
{
  std::optional<Result> result;
  QString message;
  bool isDone = false;
  try
  {
    isDone = prepare();
    if (isDone && !collection->pictures.collector())
    {
      message = tr("No picture has arrived, so there is nothing to calibrate from.");
    }
    else if (isDone)
    {
      LensCalibrationOptions options;
      options.circleDiameterMm = printedCircleDiameterMm(collection->board);
      result = Result{ collection->board,
        calibrateLens(collection->pictures.views(), collection->state.width, collection->state.height, options) };
      message = refusal(*collection, result->calibration);
    }
  }
  catch (const std::exception& error)
  {
    message = QString::fromUtf8(error.what());
  }
  tell(
    [this, collection, isCancelled, isKept = isDone && !work_.isCancelled(), result, message]
    {
      isWorking_ = false;
      const bool isWanted = !*isCancelled && collection == collection_ && (isKept || !message.isEmpty());
      if (isWanted)
      {
        result_ = result;
      }
      emit changed();
      if (isWanted && message.isEmpty())
      {
        emit calibrated();
      }
      else if (isWanted)
      {
        emit refused(message);
      }
    });
}

/// Why there is no lens and what to do about it; empty if there is one.
QString LensTask::refusal(const Collection& collection, const LensCalibrationResult& result)
{
  if (result.isUsable())
  {
    return {};
  }
  const State& state = collection.state;
  const QString reason = QString::fromStdString(collection.pictures.commonestReason());
  if (state.withBoard == 0 && !reason.isEmpty())
  {
    return tr("None of %1 pictures shows the board %2: %3. Is it the board that is chosen above?")
      .arg(state.pictures)
      .arg(QString::fromStdString(toString(collection.board)), reason);
  }
  return tr("%1. Next: %2").arg(QString::fromStdString(result.message), state.hint);
}

}  // namespace handeye
