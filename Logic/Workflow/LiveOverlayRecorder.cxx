// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LiveOverlayRecorder.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

namespace handeye
{

namespace
{

struct Picture
{
  cv::Mat bgr;
  double timeSec = 0;
  OverlayTransformSet transforms;
};

/// Waiting pictures may take so much memory, however few they are.
constexpr std::size_t MostWaitingBytes = std::size_t(512) << 20;

std::size_t bytesOf(const Picture& picture)
{
  return picture.bgr.total() * picture.bgr.elemSize();
}

/// Which frame of a video a picture is, by its time.
class FramePlaces
{
public:
  explicit FramePlaces(double framesPerSec)
    : framesPerSec_(framesPerSec)
  {
  }

  /// @return how many frames further than the last picture's; 0 for a picture that is too early to have a frame of its own
  int next(double timeSec)
  {
    const double elapsedSec = timeSec - lastSec_;
    if (last_ < 0 || elapsedSec < 0 || elapsedSec > LiveOverlayRecorder::LongestGapSec)
    {
      beginSec_ = timeSec - (last_ + 1) / framesPerSec_;
    }
    const long wanted = std::lround((timeSec - beginSec_) * framesPerSec_);
    // Of two pictures that come close together, as those of a video with its rate do, the second one takes the next frame.
    if (wanted < last_)
    {
      return 0;
    }
    const long place = std::max(wanted, last_ + 1);
    lastSec_ = timeSec;
    return int(place - std::exchange(last_, place));
  }

private:
  double framesPerSec_, beginSec_ = 0, lastSec_ = 0;
  long last_ = -1;
};

}  // namespace

class LiveOverlayRecorder::Private
{
public:
  Private(const std::filesystem::path& video, const OverlayRecorderOptions& options, std::size_t mostWaiting)
    : recorder_(video, options)
    , places_(options.framesPerSec)
    , mostWaiting_(std::max<std::size_t>(1, mostWaiting))
    , thread_([this] { run(); })
  {
  }

  ~Private()
  {
    finish();
    thread_.join();
  }

  bool add(Picture picture)
  {
    const std::lock_guard lock(mutex_);
    if (isFinishing_ || !state_.error.empty())
    {
      return false;
    }
    const std::size_t bytes = bytesOf(picture);
    if (waiting_.size() >= mostWaiting_ || (!waiting_.empty() && waitingBytes_ + bytes > MostWaitingBytes))
    {
      leaveOut("the encoder does not keep up with the pictures");
      return false;
    }
    waitingBytes_ += bytes;
    waiting_.push_back(std::move(picture));
    changed_.notify_one();
    return true;
  }

  void finish()
  {
    const std::lock_guard lock(mutex_);
    isFinishing_ = true;
    changed_.notify_one();
  }

  State state() const
  {
    const std::lock_guard lock(mutex_);
    State state = state_;
    state.waitingCount = int(waiting_.size()) + (isWriting_ ? 1 : 0);
    return state;
  }

private:
  /// In the thread of the recorder, as what follows.
  void run()
  {
    while (std::optional<Picture> picture = take())
    {
      attempt([&] { write(*picture); });
    }
    attempt([&] { recorder_.close(); });
    const std::lock_guard lock(mutex_);
    state_.isFinished = true;
  }

  std::optional<Picture> take()
  {
    std::unique_lock lock(mutex_);
    isWriting_ = false;
    changed_.wait(lock, [this] { return !waiting_.empty() || isFinishing_; });
    if (waiting_.empty() || !state_.error.empty())
    {
      return std::nullopt;
    }
    Picture picture = std::move(waiting_.front());
    waiting_.pop_front();
    waitingBytes_ -= bytesOf(picture);
    isWriting_ = true;
    return picture;
  }

  template<typename Work> void attempt(Work work)
  {
    try
    {
      if (state().error.empty())
      {
        work();
      }
    }
    catch (const std::invalid_argument& error)
    {
      const std::lock_guard lock(mutex_);
      leaveOut(error.what());
    }
    catch (const std::exception& error)
    {
      const std::lock_guard lock(mutex_);
      state_.error = error.what();
      isFinishing_ = true;
      for (std::size_t lost = waiting_.size() + (isWriting_ ? 1 : 0); lost > 0; --lost)
      {
        leaveOut(state_.error);
      }
      waiting_.clear();
      waitingBytes_ = 0;
      isWriting_ = false;
    }
  }

  void write(const Picture& picture)
  {
    FramePlaces places = places_;
    if (!std::isfinite(picture.timeSec))
    {
      throw std::invalid_argument("the time of a picture is not a finite number");
    }
    const int frames = places.next(picture.timeSec);
    if (frames == 0)
    {
      const std::lock_guard lock(mutex_);
      leaveOut("pictures come faster than the video has frames");
      return;
    }
    // The picture before stays until this one's place.
    for (int i = 1; i < frames; ++i)
    {
      recorder_.append(last_.bgr, last_.timeSec, last_.transforms);
    }
    const std::string refusal = appendOrSayWhyNot(picture);
    if (!refusal.empty() && last_.bgr.empty())
    {
      throw std::invalid_argument(refusal);
    }
    if (!refusal.empty())
    {
      // It has a time all the same: the picture before stays in its place.
      recorder_.append(last_.bgr, last_.timeSec, last_.transforms);
    }
    places_ = places;
    last_ = refusal.empty() ? picture : last_;
    const std::lock_guard lock(mutex_);
    if (refusal.empty())
    {
      ++state_.pictureCount;
    }
    else
    {
      leaveOut(refusal);
    }
    state_.frameCount = recorder_.frameCount();
    state_.encoder = recorder_.encoder();
  }

  /// @return empty, or why the picture cannot be a frame of this video
  std::string appendOrSayWhyNot(const Picture& picture)
  {
    try
    {
      recorder_.append(picture.bgr, picture.timeSec, picture.transforms);
      return {};
    }
    catch (const std::invalid_argument& error)
    {
      return error.what();
    }
  }

  /// With the mutex locked.
  void leaveOut(const std::string& reason)
  {
    ++state_.leftOutCount;
    state_.leftOutReason = state_.leftOutReason.empty() ? reason : state_.leftOutReason;
  }

  OverlayRecorder recorder_;
  FramePlaces places_;
  Picture last_;
  const std::size_t mostWaiting_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Picture> waiting_;
  std::size_t waitingBytes_ = 0;
  State state_;
  bool isFinishing_ = false, isWriting_ = false;
  std::thread thread_;
};

LiveOverlayRecorder::LiveOverlayRecorder(
  const std::filesystem::path& video, const OverlayRecorderOptions& options, std::size_t mostWaiting)
  : d(std::make_unique<Private>(video, options, mostWaiting))
{
}

LiveOverlayRecorder::~LiveOverlayRecorder() = default;

bool LiveOverlayRecorder::add(const cv::Mat& bgr, double timeSec, const OverlayTransformSet& transforms)
{
  return d->add({ bgr, timeSec, transforms });
}

void LiveOverlayRecorder::finish()
{
  d->finish();
}

LiveOverlayRecorder::State LiveOverlayRecorder::state() const
{
  return d->state();
}

}  // namespace handeye
