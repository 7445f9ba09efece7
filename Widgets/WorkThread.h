// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace handeye
{

/// The thread beside the window: work is done in the order in which it was posted, and newest-only work (the frames of a video)
/// whenever nothing else waits. What takes longer asks isCancelled() between its steps.
///
/// An exception that leaves a piece of work goes to the handler given, in this thread; nothing ends because of it.
///
/// All functions may be called from any thread.
class WorkThread
{
public:
  using Work = std::function<void()>;

  /// @param onError receives the sentence of an exception that left a piece of work
  explicit WorkThread(std::function<void(const char*)> onError);
  /// Waits for the work under way and does what was posted, so that nothing that is to be stored is lost; what takes long is
  /// isCancelled() and ends early.
  ~WorkThread();
  WorkThread(const WorkThread&) = delete;
  WorkThread& operator=(const WorkThread&) = delete;

  void post(Work work);
  /// Replaces what was posted by this function before and has not begun: a video that is too fast loses frames, and does not wait.
  void postNewest(Work work);

  /// Asks the work under way, and what waits behind it, to stop; forgotten once all of that is done. Without effect where there is
  /// none.
  void cancel();
  bool isCancelled() const { return isCancelled_ || isEnding_; }
  /// The thread is being ended: nobody waits for results any more.
  bool isEnding() const { return isEnding_; }

private:
  void run();
  void perform(const Work& work);

  std::function<void(const char*)> onError_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Work> work_;
  Work newest_;
  bool isWorking_ = false;
  std::atomic<bool> isCancelled_{ false }, isEnding_{ false };
  std::thread thread_;
};

}  // namespace handeye
