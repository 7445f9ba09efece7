// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallVideo.h"

#include "ClutteredPicture.h"
#include "TestCameras.h"

#include <opencv2/imgproc.hpp>

#include <cmath>

namespace handeye::bench
{

namespace
{

constexpr double FramesPerSecond = 60;
/// The share of the time between two frames that the shutter is open.
constexpr double Exposure = 0.25;
constexpr double BlurPx = 0.7;
constexpr double Noise = 1.5;
constexpr int JpegQuality = 92;
constexpr unsigned Seed = 5;

CameraModel cameraFor(const cv::Size& size)
{
  const double focal = 0.94 * size.width;
  return test::makeCamera(size.width, size.height, focal, 1.002 * focal, 0.494 * size.width, 0.51 * size.height,
    { 0.041, -0.112, -0.0007, 0.0011, 0.02 });
}

/// A hand that sweeps: about 100 mm/s on average, between 230 and 470 mm from the camera.
Eigen::Vector3d placeAt(double seconds)
{
  return { 60 * std::sin(2.1 * seconds - 0.6), 38 * std::sin(1.7 * seconds + 0.8), 350 + 120 * std::sin(1.1 * seconds - 0.7) };
}

/// The stylus' shaft, from the ball to below the picture.
void drawShaft(cv::Mat& frame, const CameraModel& camera, const test::RenderedBall& ball)
{
  const Eigen::Vector3d behind_Camera = ball.center_Camera + Eigen::Vector3d(0.25, 0.9, 0.1) * 8 * ball.radiusMm;
  const Eigen::Vector2d from = camera.project(ball.center_Camera).point_Image;
  const Eigen::Vector2d to = from + 20 * (camera.project(behind_Camera).point_Image - from);
  const double widthPx = 0.35 * camera.fx() * ball.radiusMm / ball.center_Camera.z();
  cv::line(
    frame, { int(from.x()), int(from.y()) }, { int(to.x()), int(to.y()) }, { 70, 66, 66 }, std::max(2, int(widthPx)), cv::LINE_AA);
}

}  // namespace

BallVideo makeBallVideo(const cv::Size& size, int frameCount)
{
  BallVideo video{ cameraFor(size), 15, {}, {} };
  const cv::Mat room = test::clutter(size, Seed);
  for (int i = 0; i < frameCount; ++i)
  {
    const double seconds = i / FramesPerSecond;
    test::RenderedBall ball;
    ball.center_Camera = placeAt(seconds);
    ball.radiusMm = video.ballRadiusMm;
    ball.isShaded = true;
    const Eigen::Vector2d center_Image = video.camera.project(ball.center_Camera).point_Image;
    const Eigen::Vector3d next_Camera = placeAt(seconds + Exposure / FramesPerSecond);
    const Eigen::Vector2d motionPx = video.camera.project(next_Camera).point_Image - center_Image;

    cv::Mat frame = room.clone();
    drawShaft(frame, video.camera, ball);
    const cv::Rect area = test::areaOfBall(video.camera, ball, BlurPx, motionPx);
    cv::Mat light = test::toLight(frame(area));
    test::drawBall(light, area, video.camera, ball, BlurPx, motionPx);
    test::develop(light, {}).copyTo(frame(area));
    cv::Mat noise(size, CV_16SC3);
    cv::RNG(unsigned(i + 1)).fill(noise, cv::RNG::NORMAL, cv::Scalar::all(0), cv::Scalar::all(Noise));
    cv::add(frame, noise, frame, {}, CV_8U);
    video.frames.push_back(test::throughJpeg(frame, JpegQuality));
    video.ball_Image.push_back(center_Image);
  }
  return video;
}

}  // namespace handeye::bench
