// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QTimer>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <execinfo.h>
#include <thread>
#include <unistd.h>

/// How long the event loop of the user interface was stuck at the longest: a timer in the loop beats every 2 ms, and a thread beside it
/// watches how long a beat stays away. Time in which the machine did not let the watching thread run either does not count.
///
/// With HANDEYE_STALL_STACKS set, what holds the loop for more than 100 ms is written to the standard error as a stack.
class EventLoopWatch
{
public:
  EventLoopWatch()
  {
    QObject::connect(&beat_, &QTimer::timeout, &beat_, [this] { beats_.fetch_add(1); });
    beat_.setTimerType(Qt::PreciseTimer);
    beat_.start(2);
    if (std::getenv("HANDEYE_STALL_STACKS"))
    {
      watched_ = pthread_self();
      writesStacks_ = true;
      std::signal(SIGUSR2, &EventLoopWatch::writeStack);
    }
    watcher_ = std::thread([this] { watch(); });
  }
  ~EventLoopWatch()
  {
    stop_ = true;
    watcher_.join();
  }
  EventLoopWatch(const EventLoopWatch&) = delete;
  EventLoopWatch& operator=(const EventLoopWatch&) = delete;

  double longestMs() const { return longestMs_; }
  /// The longest since the last call.
  double takeLongestMs() { return longestMs_.exchange(0); }

private:
  static void writeStack(int)
  {
    void* frames[60];
    const int count = backtrace(frames, 60);
    const char text[] = "---- the event loop is held by\n";
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text, sizeof text - 1);
    backtrace_symbols_fd(frames, count, STDERR_FILENO);
  }

  void watch()
  {
    using Clock = std::chrono::steady_clock;
    constexpr double stepMs = 2;
    long seen = -1;
    double stuckMs = 0;
    bool isWritten = false;
    auto before = Clock::now();
    while (!stop_)
    {
      std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(stepMs));
      const auto now = Clock::now();
      const double passedMs = std::chrono::duration<double, std::milli>(now - before).count();
      before = now;
      const long beats = beats_;
      stuckMs = beats == seen ? stuckMs + std::min(passedMs, 2 * stepMs) : 0;
      seen = beats;
      if (stuckMs < 100)
      {
        isWritten = false;
      }
      else if (writesStacks_ && !isWritten)
      {
        isWritten = true;
        pthread_kill(watched_, SIGUSR2);
      }
      longestMs_ = std::max(longestMs_.load(), stuckMs);
    }
  }

  QTimer beat_;
  std::atomic<long> beats_{ 0 };
  std::atomic<bool> stop_{ false };
  std::atomic<double> longestMs_{ 0 };
  pthread_t watched_{};
  bool writesStacks_ = false;
  std::thread watcher_;
};
