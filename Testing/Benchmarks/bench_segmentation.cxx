// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Finding the ball in cluttered pictures of three sizes: in the whole image, and following it through a video, each against the
// paper's pipeline (colour threshold, Gaussian, median, Hough circle) on the same frames, in the same process and one thread.
//
//   ratio_to_hough          our processor time a frame over theirs
//   error_px                mean distance of the centre found from the true one
//   core_share_at_60_hz     processor time of all threads over the time that has passed, frames coming at 60 Hz
//
// A ball that is lost or more than a pixel off makes the benchmark an error: speed counts only for the right answer.
#include "BallDetection.h"
#include "BallTracker.h"
#include "BallVideo.h"

#include <benchmark/benchmark.h>
#include <opencv2/core/utility.hpp>

#include <chrono>
#include <ctime>
#include <map>
#include <thread>

namespace
{

using namespace handeye;
using bench::BallVideo;

constexpr int FrameCount = 30;
constexpr double LargestErrorPx = 1;
constexpr int HoughFramesAtLeast = 2;
/// Frames at 60 Hz: two seconds.
constexpr int PacedFrames = 120;
constexpr int PacedThreads = 2;

double cpuSeconds(clockid_t clock)
{
  timespec time{};
  clock_gettime(clock, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

/// Processor time of one thread or of all of them, over many frames.
struct Stopwatch
{
  clockid_t clock = CLOCK_THREAD_CPUTIME_ID;
  double seconds = 0;
  int frames = 0;

  template<typename Call> auto measure(Call call)
  {
    const double before = cpuSeconds(clock);
    auto result = call();
    seconds += cpuSeconds(clock) - before;
    ++frames;
    return result;
  }

  double perFrame() const { return seconds / frames; }
};

/// The video of one size; that of the size before is forgotten.
const BallVideo& videoOf(const cv::Size& size)
{
  static BallVideo video = bench::makeBallVideo(size, FrameCount);
  if (video.frames.front().size() != size)
  {
    video = bench::makeBallVideo(size, FrameCount);
  }
  return video;
}

/// To the end of the video and back again, so that the ball never jumps.
std::size_t frameAt(int step)
{
  const int place = step % (2 * FrameCount - 2);
  return std::size_t(place < FrameCount ? place : 2 * FrameCount - 2 - place);
}

/// The peer's time on a video, from all of its frames that were measured so far.
Stopwatch& houghTime(const BallVideo& video)
{
  static std::map<int, Stopwatch> times;
  return times[video.frames.front().cols];
}

BallDetection runHough(const BallVideo& video)
{
  BallDetectionOptions options;
  options.method = BallDetectionOptions::Method::Hough;
  Stopwatch& time = houghTime(video);
  const cv::Mat& frame = video.frames[frameAt(time.frames)];
  return time.measure([&] { return detectBall(frame, video.camera, video.ballRadiusMm, options); });
}

double ratioToHough(const Stopwatch& ours, const BallVideo& video)
{
  while (houghTime(video).frames < HoughFramesAtLeast)
  {
    benchmark::DoNotOptimize(runHough(video));
  }
  return ours.perFrame() / houghTime(video).perFrame();
}

/// Whether the right thing was found, and how well over all frames.
class Checker
{
public:
  bool accepts(const BallDetection& found, const Eigen::Vector2d& ball_Image, benchmark::State& state)
  {
    const double error = (found.ball_Image - ball_Image).norm();
    if (!found.isFound() || error > LargestErrorPx)
    {
      state.SkipWithError("the ball was not found, or something else was");
      return false;
    }
    sumPx_ += error;
    ++count_;
    return true;
  }

  double meanPx() const { return sumPx_ / count_; }

private:
  double sumPx_ = 0;
  int count_ = 0;
};

void hough(benchmark::State& state, const cv::Size& size)
{
  const BallVideo& video = videoOf(size);
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(runHough(video));
  }
}

void wholeImage(benchmark::State& state, const cv::Size& size)
{
  const BallVideo& video = videoOf(size);
  Stopwatch time;
  Checker checker;
  for (auto _ : state)
  {
    const std::size_t i = frameAt(time.frames);
    const BallDetection found = time.measure([&] { return detectBall(video.frames[i], video.camera, video.ballRadiusMm); });
    if (!checker.accepts(found, video.ball_Image[i], state))
    {
      return;
    }
  }
  state.counters["ratio_to_hough"] = ratioToHough(time, video);
  state.counters["error_px"] = checker.meanPx();
}

void tracking(benchmark::State& state, const cv::Size& size)
{
  const BallVideo& video = videoOf(size);
  BallTracker tracker(BallDetector(video.camera, video.ballRadiusMm));
  benchmark::DoNotOptimize(tracker.next(video.frames.front()));  // the first frame has no place to start from
  Stopwatch time;
  Checker checker;
  int searchedWhole = 0;
  for (auto _ : state)
  {
    const std::size_t i = frameAt(time.frames + 1);
    const BallDetection found = time.measure([&] { return tracker.next(video.frames[i]); });
    searchedWhole += tracker.searched().size() == video.frames[i].size() ? 1 : 0;
    if (!checker.accepts(found, video.ball_Image[i], state))
    {
      return;
    }
  }
  state.counters["ratio_to_hough"] = ratioToHough(time, video);
  state.counters["error_px"] = checker.meanPx();
  state.counters["searched_whole"] = double(searchedWhole) / time.frames;
}

/// As in use: a frame every 16.7 ms, two threads, caches cold and threads asleep in between.
void trackingAt60Hz(benchmark::State& state, const cv::Size& size)
{
  using Clock = std::chrono::steady_clock;
  const BallVideo& video = videoOf(size);
  cv::setNumThreads(PacedThreads);
  for (auto _ : state)
  {
    BallTracker tracker(BallDetector(video.camera, video.ballRadiusMm));
    benchmark::DoNotOptimize(tracker.next(video.frames.front()));
    Checker checker;
    const Clock::time_point start = Clock::now();
    const double before = cpuSeconds(CLOCK_PROCESS_CPUTIME_ID);
    for (int step = 1; step <= PacedFrames; ++step)
    {
      const std::size_t i = frameAt(step);
      const BallDetection found = tracker.next(video.frames[i]);
      if (!checker.accepts(found, video.ball_Image[i], state))
      {
        break;
      }
      std::this_thread::sleep_until(start + step * std::chrono::microseconds(1000000 / 60));
    }
    const double busy = cpuSeconds(CLOCK_PROCESS_CPUTIME_ID) - before;
    state.counters["cpu_ms_per_frame"] = 1e3 * busy / PacedFrames;
    state.counters["core_share_at_60_hz"] = busy / (PacedFrames / 60.0);
    state.counters["frames_per_second"] = PacedFrames / std::chrono::duration<double>(Clock::now() - start).count();
  }
  cv::setNumThreads(1);
}

void registerSize(const cv::Size& size)
{
  const std::string name = "/" + std::to_string(size.width) + "x" + std::to_string(size.height);
  benchmark::RegisterBenchmark(("hough" + name).c_str(), hough, size)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark(("whole_image" + name).c_str(), wholeImage, size)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark(("tracking" + name).c_str(), tracking, size)->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv)
{
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv))
  {
    return 2;
  }
  cv::setNumThreads(1);
  registerSize({ 640, 480 });
  registerSize({ 1280, 720 });
  registerSize({ 1920, 1080 });
  const cv::Size fullHd(1920, 1080);
  benchmark::RegisterBenchmark("tracking_at_60_hz/1920x1080", trackingAt60Hz, fullHd)->Unit(benchmark::kMillisecond)->Iterations(1);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
