// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Capture.h"

#include "BallTracker.h"
#include "FileError.h"
#include "TimedPose.h"

#include <cmath>
#include <stdexcept>

namespace handeye
{

namespace
{

std::string trackingStatus(const char* tool, const io::TransformSample& sample)
{
  return std::string(tool) + (sample.status == io::TransformSample::Status::Missing ? "_missing" : "_invalid");
}

/// The ball's centre from the tracker; a frame without a usable pose is no sample.
void trackTip(const io::Recording& recording, const ToolNames& tools, const Eigen::Vector3d& tip_Stylus, CapturedFrame& captured)
{
  const io::TransformSample marker = poseOfFrame(recording, captured.frame, tools.markerToTracker, tools.latencySec);
  const io::TransformSample stylus = poseOfFrame(recording, captured.frame, tools.stylusToTracker, tools.latencySec);
  if (!marker.isUsable() || !stylus.isUsable())
  {
    const io::TransformSample& lost = marker.isUsable() ? stylus : marker;
    captured.status = trackingStatus(marker.isUsable() ? "stylus" : "marker", lost);
    captured.message = lost.reason;
    return;
  }
  const Eigen::Vector3d tip_Tracker = stylus.transform * tip_Stylus;
  const Eigen::Isometry3d trackerToMarker = marker.transform.inverse();
  captured.tip_Marker = trackerToMarker * tip_Tracker;
  captured.stylusToMarker = trackerToMarker.linear() * stylus.transform.linear();
}

template<typename Detect> CapturedFrame detectInFrame(const io::Recording& recording, int frame, Detect detect)
{
  CapturedFrame captured;
  captured.frame = frame;
  if (!recording.hasImage(frame))
  {
    captured.status = "image_missing";
    captured.message = "the frame has no image";
    return captured;
  }
  captured.ball = detect(recording.image(frame));
  captured.status = toString(captured.ball.status);
  captured.message = captured.ball.message;
  return captured;
}

template<typename ReadFrame>
std::vector<CapturedFrame> readFrames(const io::Recording& recording, const Progress& progress, ReadFrame readFrame)
{
  std::vector<CapturedFrame> frames;
  for (int frame = 0; frame < recording.frameCount(); ++frame)
  {
    frames.push_back(readFrame(frame));
    if (progress && !progress(frame + 1, recording.frameCount()))
    {
      break;
    }
  }
  return frames;
}

}  // namespace

CameraModel cameraForRecording(const CameraModel& camera, const io::Recording& recording)
{
  for (int frame = 0; frame < recording.frameCount(); ++frame)
  {
    if (recording.hasImage(frame))
    {
      const cv::Mat image = recording.image(frame);
      return camera.withImageSize(image.cols, image.rows);
    }
  }
  throw io::FileError(recording.path(), "the recording has no images, which this step needs");
}

std::vector<CapturedFrame> detectBalls(const io::Recording& recording, const CameraModel& camera, double ballRadiusMm,
  const BallDetectionOptions& options, const Progress& progress)
{
  const BallDetector detector(cameraForRecording(camera, recording), ballRadiusMm, options);
  const auto detect = [&](const cv::Mat& image) { return detector.detect(image); };
  return readFrames(recording, progress, [&](int frame) { return detectInFrame(recording, frame, detect); });
}

std::vector<CapturedFrame> followBall(const io::Recording& recording, const CameraModel& camera, double ballRadiusMm,
  const BallDetectionOptions& options, const Progress& progress)
{
  BallTracker tracker(BallDetector(cameraForRecording(camera, recording), ballRadiusMm, options));
  const auto detect = [&](const cv::Mat& image) { return tracker.next(image); };
  return readFrames(recording, progress, [&](int frame) { return detectInFrame(recording, frame, detect); });
}

std::vector<CapturedFrame> readCapture(const io::Recording& recording, const ToolNames& tools, const CameraModel& camera,
  const Eigen::Vector3d& tip_Stylus, double ballRadiusMm, const BallDetectionOptions& options, const Progress& progress)
{
  recording.requireTransform(tools.markerToTracker);
  recording.requireTransform(tools.stylusToTracker);
  const BallDetector detector(cameraForRecording(camera, recording), ballRadiusMm, options);
  const auto detect = [&](const cv::Mat& image) { return detector.detect(image); };
  return readFrames(recording, progress,
    [&](int frame)
    {
      CapturedFrame captured = detectInFrame(recording, frame, detect);
      trackTip(recording, tools, tip_Stylus, captured);
      return captured;
    });
}

std::vector<HandEyeSample> toSamples(const std::vector<CapturedFrame>& frames, int eye)
{
  std::vector<HandEyeSample> samples;
  for (const CapturedFrame& captured : frames)
  {
    if (captured.isSample() && captured.tip_Marker)
    {
      const BallDetection& ball = captured.ball;
      samples.push_back({ captured.frame, eye, *captured.tip_Marker, ball.ball_Image, ball.ray_Camera, ball.distanceMm,
        std::sqrt(ball.covariance_Image.trace() / 2), captured.stylusToMarker });
    }
  }
  return samples;
}

}  // namespace handeye
