// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "VideoSource.h"

#include "FileError.h"

#include <opencv2/videoio.hpp>

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace handeye::devices
{

namespace
{

bool isDeviceNumber(const std::string& device)
{
  return !device.empty() && device.size() < 4 &&
    std::all_of(device.begin(), device.end(), [](unsigned char c) { return std::isdigit(c); });
}

class OpenCVGrabber : public FrameGrabber
{
public:
  explicit OpenCVGrabber(const VideoSourceOptions& options)
    : isCamera_(isDeviceNumber(options.device))
  {
    if (!open(options.device))
    {
      throw std::runtime_error(isCamera_
          ? "camera " + options.device + " cannot be opened: is it plugged in, and used by no one else?"
          : "'" + options.device + "' cannot be opened as a video");
    }
    isFinite_ = isVideoFile(options.device);
    if (isCamera_ && options.width > 0 && options.height > 0)
    {
      capture_.set(cv::CAP_PROP_FRAME_WIDTH, options.width);
      capture_.set(cv::CAP_PROP_FRAME_HEIGHT, options.height);
    }
    framesPerSec_ = isFinite_ ? capture_.get(cv::CAP_PROP_FPS) : 0;
    framesPerSec_ = framesPerSec_ > 0 && framesPerSec_ < 1000 ? framesPerSec_ : 30;  // image sequences do not say
  }

  cv::Mat grab() override
  {
    cv::Mat frame;
    capture_.read(frame);
    ++count_;
    return frame;
  }

  std::optional<double> timeSec() const override
  {
    return isFinite_ ? std::optional<double>((count_ - 1) / framesPerSec_) : std::nullopt;
  }

  bool isFinite() const override { return isFinite_; }

private:
  bool open(const std::string& device)
  {
    if (isCamera_)
    {
      return capture_.open(std::stoi(device));
    }
    // A server that does not answer must not hold stop() for longer than this; other backends know no such limit.
    constexpr int TimeoutMs = 3000;
    const bool isUrl = !isVideoFile(device) &&
      capture_.open(
        device, cv::CAP_FFMPEG, { cv::CAP_PROP_OPEN_TIMEOUT_MSEC, TimeoutMs, cv::CAP_PROP_READ_TIMEOUT_MSEC, TimeoutMs });
    return isUrl || (isVideoFile(device) && capture_.open(device));
  }

  cv::VideoCapture capture_;
  bool isCamera_ = false;
  bool isFinite_ = false;
  double framesPerSec_ = 30;
  long count_ = 0;
};

}  // namespace

bool isVideoFile(const std::string& device)
{
  return !isDeviceNumber(device) && device.find("://") == std::string::npos;
}

void requireReadable(const VideoSourceOptions& options)
{
  if (!isVideoFile(options.device))
  {
    return;
  }
  try
  {
    OpenCVGrabber grabber(options);
  }
  catch (const std::runtime_error&)
  {
    throw io::FileError(
      options.device, "it cannot be opened as a video; a video file or a pattern such as frames/%04d.jpg is expected");
  }
}

VideoSource::VideoSource(const VideoSourceOptions& options)
  : VideoSource(options, [options] { return std::make_unique<OpenCVGrabber>(options); })
{
}

VideoSource::VideoSource(const VideoSourceOptions& options, OpenGrabber open)
  : Source(options.buffer)
  , options_(options)
  , open_(std::move(open))
{
}

VideoSource::~VideoSource()
{
  stopThread();
}

std::string VideoSource::name() const
{
  return isDeviceNumber(options_.device) ? "camera " + options_.device : options_.device;
}

void VideoSource::run()
{
  std::unique_ptr<FrameGrabber> grabber;
  try
  {
    grabber = open_();
  }
  catch (const std::exception& error)
  {
    if (isVideoFile(options_.device))
    {
      finish(error.what());
      return;
    }
    throw;
  }
  countConnection();
  setState(SourceState::Streaming, "streaming from " + name());
  deliverFrames(*grabber);
  if (grabber->isFinite() && !isStopping())
  {
    setState(SourceState::Finished, name() + " has come to its end");
  }
  else if (!isStopping())
  {
    setProblem(name() + " gives no pictures any more: is it unplugged? Trying again");
  }
}

void VideoSource::deliverFrames(FrameGrabber& grabber)
{
  const double startSec = systemTimeSec();
  while (!isStopping())
  {
    const cv::Mat image = grabber.grab();
    if (image.empty())
    {
      return;
    }
    const std::optional<double> timeSec = grabber.timeSec();
    if (timeSec && options_.realTime && !sleepFor(std::max(0.0, startSec + *timeSec - systemTimeSec())))
    {
      return;
    }
    DeviceSample sample;
    sample.name = options_.name;
    sample.timeSec = timeSec ? *timeSec : systemTimeSec();
    VideoFrame frame;
    frame.image = image;
    sample.content = std::move(frame);
    deliver(std::move(sample));
  }
}

}  // namespace handeye::devices
