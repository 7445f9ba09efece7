// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QTimer>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

/// How long the event loop of the user interface was stuck at the longest: a timer in the loop beats every 2 ms, and a thread beside it
/// watches how long a beat stays away. Time in which the machine did not let the watching thread run either does not count.
class EventLoopWatch
{
public:
  EventLoopWatch()
  {
    QObject::connect(&beat_, &QTimer::timeout, &beat_, [this] { beats_.fetch_add(1); });
    beat_.setTimerType(Qt::PreciseTimer);
    beat_.start(2);
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
  void watch()
  {
    using Clock = std::chrono::steady_clock;
    constexpr double stepMs = 2;
    long seen = -1;
    double stuckMs = 0;
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
      longestMs_ = std::max(longestMs_.load(), stuckMs);
    }
  }

  QTimer beat_;
  std::atomic<long> beats_{ 0 };
  std::atomic<bool> stop_{ false };
  std::atomic<double> longestMs_{ 0 };
  std::thread watcher_;
};
