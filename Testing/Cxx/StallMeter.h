// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QObject>
#include <QTimer>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

/// How long the event loop of the user interface was stuck at the longest: a timer in the loop beats every 5 ms, and a thread beside it,
/// which is not stuck, watches how long a beat stays away. What the watching thread itself missed, because the machine gave it no time, does
/// not count.
class StallMeter : public QObject
{
public:
  StallMeter()
  {
    connect(&this->Beat, &QTimer::timeout, this, [this] { this->Beats.fetch_add(1); });
    this->Beat.setTimerType(Qt::PreciseTimer);
    this->Beat.start(5);
    this->Watcher = std::thread([this] { this->watch(); });
  }

  ~StallMeter() override
  {
    this->Stop = true;
    this->Watcher.join();
  }

  double longestMs() const { return this->Longest; }

  /// Forgets what was.
  void restart() { this->Longest = 0; }

private:
  void watch()
  {
    using Clock = std::chrono::steady_clock;
    constexpr double stepMs = 2;
    long seen = -1;
    double stuckMs = 0;
    auto before = Clock::now();
    while (!this->Stop)
    {
      std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(stepMs));
      const auto now = Clock::now();
      const double passedMs = std::chrono::duration<double, std::milli>(now - before).count();
      before = now;
      const long beats = this->Beats;
      if (beats != seen)
      {
        seen = beats;
        stuckMs = 0;
        continue;
      }
      stuckMs += std::min(passedMs, 2 * stepMs);
      if (stuckMs > this->Longest)
      {
        this->Longest = stuckMs;
      }
    }
  }

  QTimer Beat;
  std::atomic<long> Beats{ 0 };
  std::atomic<bool> Stop{ false };
  std::atomic<double> Longest{ 0 };
  std::thread Watcher;
};
