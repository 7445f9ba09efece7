// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Source.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace handeye::devices
{

/// Where frames come from: a thin layer over cv::VideoCapture, so that a test can pull the plug.
class FrameGrabber
{
public:
  virtual ~FrameGrabber() = default;
  /// The next frame; an empty one where there is none any more (end of a file, cable pulled).
  virtual cv::Mat grab() = 0;
  /// When the frame was recorded, seconds from the beginning; nothing for a live camera.
  virtual std::optional<double> timeSec() const { return std::nullopt; }
  /// Whether it ends by itself (a file) or should go on for ever (a camera).
  virtual bool isFinite() const = 0;
};

/// Opens a grabber, or says why not: @throws std::runtime_error with a sentence
using OpenGrabber = std::function<std::unique_ptr<FrameGrabber>()>;

struct VideoSourceOptions
{
  std::string name = "Video";  ///< of the samples
  /// "0" is the first camera; otherwise a file, a pattern of an image sequence ("frames/%04d.jpg") or a URL. A camera or URL that is not
  /// there is tried again; a file that cannot be opened is Finished at once.
  std::string device = "0";
  int width = 0;  ///< px, asked of a camera; 0: as it likes
  int height = 0;
  bool realTime = true;  ///< of a file: frames come at their own times; otherwise as fast as they are taken
  SampleBufferOptions buffer;
};

/// Whether the device names a file or an image sequence, as opposed to a camera or a URL.
bool isVideoFile(const std::string& device);

/// @throws io::FileError for a file, or an image sequence, that cannot be opened as a video; a camera or URL is not looked at
void requireReadable(const VideoSourceOptions& options);

/// A camera or a video file through OpenCV.
///
/// A live frame's time is this computer's clock when the frame had arrived, so that the camera's own delay is part of the latency that
/// temporal calibration finds. A camera that is unplugged says so in the status and is opened again every half second. A file ends
/// with the state Finished.
class VideoSource : public Source
{
public:
  explicit VideoSource(const VideoSourceOptions& options);
  /// With another way to frames.
  VideoSource(const VideoSourceOptions& options, OpenGrabber open);
  ~VideoSource() override;

  std::string name() const override;

protected:
  void run() override;

private:
  void deliverFrames(FrameGrabber& grabber);

  VideoSourceOptions options_;
  OpenGrabber open_;
};

}  // namespace handeye::devices
