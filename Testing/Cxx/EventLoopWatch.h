// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QApplication>
#include <QTimer>
#include <QVTKOpenGLNativeWidget.h>
#include <vtkCommand.h>
#include <vtkRenderWindow.h>
#include <vtkWeakPointer.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <execinfo.h>
#include <fstream>
#include <pthread.h>
#include <set>
#include <string>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

/// How long the event loop of the user interface was stuck at the longest: a timer in the loop beats every 2 ms, and a thread beside it
/// watches how long a beat stays away. Time in which the loop's thread was ready and the machine gave it no processor does not count: the
/// kernel says how long that was (schedstat), so that the figure is the program's on a busy machine, too. Waiting for a lock, a file or
/// another thread does count.
///
/// What VTK's views take to draw is counted for itself: without a graphics card, as in the tests, they wait for the threads of the
/// software renderer, which share the processors with everything else, and so does Qt when it puts the pictures on the screen. A figure
/// that the load of the machine does not change is therefore given as well: the processor time of the loop's own thread between two beats,
/// drawing left out; and that of drawing in one go.
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
    loopsTask_ = "/proc/self/task/" + std::to_string(gettid()) + "/schedstat";
    pthread_getcpuclockid(pthread_self(), &loopsClock_);
    watcher_ = std::thread([this] { watch(); });
  }
  ~EventLoopWatch()
  {
    stop_ = true;
    watcher_.join();
    for (const auto& [window, tag] : observers_)
    {
      if (window)
      {
        window->RemoveObserver(tag);
      }
    }
  }
  EventLoopWatch(const EventLoopWatch&) = delete;
  EventLoopWatch& operator=(const EventLoopWatch&) = delete;

  /// The longest since the last call, drawing left out.
  double takeLongestMs() { return longestMs_.exchange(0); }
  /// The longest time of drawing in one go since the last call.
  double takeLongestDrawingMs() { return longestDrawingMs_.exchange(0); }

  /// The most that the loop's thread itself worked between two beats since the last call, drawing left out.
  double takeLongestWorkMs() { return longestWorkMs_.exchange(0); }
  /// The most that it worked to draw in one go.
  double takeLongestDrawingWorkMs() { return longestDrawingWorkMs_.exchange(0); }

  /// Knows all views that there are now.
  void watchDrawing()
  {
    for (QWidget* const widget : QApplication::allWidgets())
    {
      auto* const view = qobject_cast<QVTKOpenGLNativeWidget*>(widget);
      if (view && views_.insert(view).second)
      {
        vtkRenderWindow* const window = view->renderWindow();
        observers_.push_back({ window, window->AddObserver(vtkCommand::StartEvent, this, &EventLoopWatch::beginDrawing) });
        observers_.push_back({ window, window->AddObserver(vtkCommand::EndEvent, this, &EventLoopWatch::endDrawing) });
      }
    }
  }

private:
  void beginDrawing() { isDrawing_ = true; }
  void endDrawing() { isDrawing_ = false; }

  static void writeStack(int)
  {
    void* frames[60];
    const int count = backtrace(frames, 60);
    const char text[] = "---- the event loop is held by\n";
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text, sizeof text - 1);
    backtrace_symbols_fd(frames, count, STDERR_FILENO);
  }

  /// For how long the loop's thread was ready, and waited for a processor.
  double waitedMs() const
  {
    std::ifstream file(loopsTask_);
    double ranNs = 0, waitedNs = 0;
    file >> ranNs >> waitedNs;
    return waitedNs * 1e-6;
  }
  double workedMs() const
  {
    timespec time{};
    clock_gettime(loopsClock_, &time);
    return double(time.tv_sec) * 1e3 + double(time.tv_nsec) * 1e-6;
  }

  void watch()
  {
    using Clock = std::chrono::steady_clock;
    constexpr double stepMs = 2;
    long seen = -1;
    double stuckMs = 0, drawingMs = 0;
    bool isWritten = false;
    auto before = Clock::now();
    double waitedBeforeMs = waitedMs(), workedBeforeMs = workedMs(), workMs = 0, drawingWorkMs = 0;
    while (!stop_)
    {
      std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(stepMs));
      const auto now = Clock::now();
      const double passedMs = std::chrono::duration<double, std::milli>(now - before).count();
      before = now;
      const long beats = beats_;
      const double waited = waitedMs(), worked = workedMs();
      const double stepOfLoopMs = std::max(0.0, passedMs - (waited - waitedBeforeMs));
      waitedBeforeMs = waited;
      const double stepOfWorkMs = worked - workedBeforeMs;
      workedBeforeMs = worked;
      const bool isDrawing = isDrawing_;
      drawingMs = isDrawing ? drawingMs + stepOfLoopMs : 0;
      drawingWorkMs = isDrawing ? drawingWorkMs + stepOfWorkMs : 0;
      workMs = beats == seen ? workMs + (isDrawing ? 0 : stepOfWorkMs) : 0;
      longestDrawingWorkMs_ = std::max(longestDrawingWorkMs_.load(), drawingWorkMs);
      longestWorkMs_ = std::max(longestWorkMs_.load(), workMs);
      stuckMs = beats == seen ? stuckMs + (isDrawing ? 0 : stepOfLoopMs) : 0;
      seen = beats;
      longestDrawingMs_ = std::max(longestDrawingMs_.load(), drawingMs);
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
  std::atomic<bool> isDrawing_{ false };
  std::set<QWidget*> views_;
  std::vector<std::pair<vtkWeakPointer<vtkRenderWindow>, unsigned long>> observers_;
  std::atomic<double> longestMs_{ 0 }, longestDrawingMs_{ 0 }, longestWorkMs_{ 0 }, longestDrawingWorkMs_{ 0 };
  std::string loopsTask_;
  clockid_t loopsClock_{};
  pthread_t watched_{};
  bool writesStacks_ = false;
  std::thread watcher_;
};
