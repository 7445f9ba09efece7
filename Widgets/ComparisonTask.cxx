// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComparisonTask.h"

#include "ComparisonReport.h"
#include "PaintedPlot.h"
#include "WorkThread.h"

#include <QElapsedTimer>

#include <utility>

namespace handeye
{

namespace
{

constexpr int NewsEveryMs = 60;  ///< of progress: a comparison has thousands of steps

/// Before anything was compared; a camera is never without a matrix.
SessionComparisonInput noInput()
{
  return { CameraModel(0, 0, Eigen::Matrix3d::Identity(), {}), {}, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), 0, {}, {}, {},
    {}, {}, {}, {}, {}, {}, 0, {} };
}

}  // namespace

ComparisonTask::ComparisonTask(QObject* parent)
  : QObject(parent)
  , input_(noInput())
  , isCancelled_(std::make_shared<std::atomic<bool>>(false))
  , work_(std::make_unique<WorkThread>([](const char*) {}))
{
}

ComparisonTask::~ComparisonTask()
{
  // Before what its work tells of is gone.
  work_.reset();
}

void ComparisonTask::tell(std::function<void()> news)
{
  QMetaObject::invokeMethod(this, std::move(news), Qt::QueuedConnection);
}

void ComparisonTask::begin()
{
  isCancelled_ = std::make_shared<std::atomic<bool>>(false);
  isWorking_ = true;
  emit changed();
}

void ComparisonTask::end()
{
  isWorking_ = false;
  emit changed();
}

void ComparisonTask::start(const SessionComparisonInput& input)
{
  if (isWorking_)
  {
    return;
  }
  begin();
  work_->post([this, input, isCancelled = isCancelled_, thread = work_.get()] { work(input, isCancelled, *thread); });
}

void ComparisonTask::cancel()
{
  if (isWorking_ && !isCancelled_->exchange(true))
  {
    emit changed();
  }
}

void ComparisonTask::clear()
{
  cancel();
  result_.reset();
  emit changed();
}

/// In the work's thread.
void ComparisonTask::work(const SessionComparisonInput& input, const Flag& isCancelled, const WorkThread& thread)
{
  QElapsedTimer sinceNews;
  const ComparisonProgress progress = [&](const std::string& what, int done, int total)
  {
    if (!sinceNews.isValid() || sinceNews.elapsed() > NewsEveryMs)
    {
      sinceNews.start();
      tell(
        [this, isCancelled, text = QString::fromStdString(what), done, total]
        {
          if (!*isCancelled)
          {
            emit progressed(text, done, total);
          }
        });
    }
    return !*isCancelled && !thread.isEnding();
  };
  std::shared_ptr<const SessionComparison> result;
  QString message;
  try
  {
    result = std::make_shared<const SessionComparison>(compareSession(input, progress));
  }
  catch (const std::exception& error)
  {
    message = QString::fromUtf8(error.what());
  }
  tell(
    [this, isCancelled, input, result, message]
    {
      const bool isWanted = !*isCancelled;
      const bool isGood = isWanted && result && !result->result.wasStopped;
      if (isGood)
      {
        result_ = result;
        input_ = input;
      }
      end();
      if (isGood)
      {
        emit finished();
      }
      else if (isWanted && !message.isEmpty())
      {
        emit refused(message);
      }
    });
}

void ComparisonTask::writeReport(const QString& folder)
{
  if (isWorking_)
  {
    return;
  }
  if (!result_)
  {
    emit refused(tr("There is no comparison yet that a report could be written of."));
    return;
  }
  begin();
  emit progressed(tr("writing the report"), 0, 0);
  const report::PlotDrawer draw =
    paintUnless([thread = work_.get(), isCancelled = isCancelled_] { return *isCancelled || thread->isEnding(); });
  work_->post(
    [this, folder, draw, comparison = result_, isCancelled = isCancelled_]
    {
      QString message;
      try
      {
        const io::Recording* recording = comparison->validationRecording ? &*comparison->validationRecording : nullptr;
        writeComparisonReport(folder.toStdString(), comparison->result,
          { comparison->validation, comparison->validationFrames, recording, comparison->facts, draw });
      }
      catch (const std::exception& error)
      {
        message = QString::fromUtf8(error.what());
      }
      tell(
        [this, folder, message, isCancelled]
        {
          end();
          if (*isCancelled)
          {
            return;  // nobody waits for it; what was written is complete, or not there
          }
          if (message.isEmpty())
          {
            emit reportWritten(folder + QStringLiteral("/report.html"));
          }
          else
          {
            emit refused(message);
          }
        });
    });
}

}  // namespace handeye
