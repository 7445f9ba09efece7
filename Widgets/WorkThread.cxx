// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "WorkThread.h"

#include <exception>
#include <utility>

namespace handeye
{

WorkThread::WorkThread(std::function<void(const char*)> onError)
  : onError_(std::move(onError))
  , thread_([this] { run(); })
{
}

WorkThread::~WorkThread()
{
  {
    const std::lock_guard lock(mutex_);
    isEnding_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void WorkThread::post(Work work)
{
  {
    const std::lock_guard lock(mutex_);
    work_.push_back(std::move(work));
  }
  changed_.notify_all();
}

void WorkThread::postNewest(Work work)
{
  {
    const std::lock_guard lock(mutex_);
    newest_ = std::move(work);
  }
  changed_.notify_all();
}

void WorkThread::cancel()
{
  const std::lock_guard lock(mutex_);
  isCancelled_ = isWorking_ || !work_.empty();
}

void WorkThread::run()
{
  for (;;)
  {
    Work work;
    {
      std::unique_lock lock(mutex_);
      isWorking_ = false;
      if (work_.empty())
      {
        isCancelled_ = false;
      }
      changed_.wait(lock, [this] { return isEnding_ || !work_.empty() || newest_; });
      if (isEnding_ && work_.empty())
      {
        return;
      }
      if (!work_.empty())
      {
        work = std::move(work_.front());
        work_.pop_front();
      }
      else
      {
        work = std::exchange(newest_, nullptr);
      }
      isWorking_ = true;
    }
    perform(work);
  }
}

void WorkThread::perform(const Work& work)
{
  try
  {
    work();
  }
  catch (const std::exception& error)
  {
    onError_(error.what());
  }
}

}  // namespace handeye
