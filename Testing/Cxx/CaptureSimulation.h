// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Capture.h"
#include "IoTestSupport.h"
#include "SequenceMetafileWriter.h"
#include "Simulation.h"
#include "SphereRenderer.h"
#include "TestCameras.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/imgcodecs.hpp>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace handeye::test
{

/// A small camera, so that pictures of it are made quickly.
inline CameraModel smallCamera()
{
  return makeCamera(320, 240, 300, 301, 158.2, 121.7, { -0.12, 0.05, 0.0006, -0.0008 });
}

/// A session that never was: a ball held at places in front of a camera whose marker is tracked, pictures and poses as a tracker
/// would have given them, without noise.
struct SimulatedSession
{
  CameraModel camera = smallCamera();
  Eigen::Isometry3d markerToCamera = typicalMarkerToCamera();
  Eigen::Vector3d tip_Stylus = { 1.5, -2.5, -150 };
  double ballRadiusMm = 12;
  std::vector<Eigen::Vector3d> balls_Camera;

  explicit SimulatedSession(int frameCount, unsigned seed = 1)
  {
    Random random(seed);
    for (int i = 0; i < frameCount; ++i)
    {
      balls_Camera.push_back(randomPointInView(camera, { 130, 330, 0.15 }, random));
    }
  }

  cv::Mat picture(std::size_t frame) const
  {
    RenderedBall ball;
    ball.center_Camera = balls_Camera[frame];
    ball.radiusMm = ballRadiusMm;
    return SphereScene(camera).add(ball).photograph();
  }

  Eigen::Vector3d tip_Marker(std::size_t frame) const { return markerToCamera.inverse() * balls_Camera[frame]; }

  /// One tracked frame: the camera's marker anywhere, the stylus such that its tip is the ball's centre.
  io::SequenceFrame track(std::size_t frame, Random& random) const
  {
    const Eigen::Isometry3d markerToTracker = random.rigid(300);
    Eigen::Isometry3d stylusToTracker = random.rigid(0);
    stylusToTracker.translation() = markerToTracker * tip_Marker(frame) - stylusToTracker.linear() * tip_Stylus;
    io::SequenceFrame tracked;
    tracked.timestampSec = 0.05 * double(frame);
    tracked.transforms["MarkerToTracker"] = { markerToTracker.matrix(), "OK" };
    tracked.transforms["StylusToTracker"] = { stylusToTracker.matrix(), "OK" };
    return tracked;
  }

  std::vector<io::SequenceFrame> trackAll(unsigned seed = 5) const
  {
    Random random(seed);
    std::vector<io::SequenceFrame> frames;
    for (std::size_t i = 0; i < balls_Camera.size(); ++i)
    {
      frames.push_back(track(i, random));
    }
    return frames;
  }

  /// What the evaluation of such a capture gives, without pictures.
  std::vector<CapturedFrame> captured(double sigmaMm = 0, double sigmaPx = 0, unsigned seed = 9) const
  {
    Random random(seed);
    std::vector<CapturedFrame> frames;
    for (std::size_t i = 0; i < balls_Camera.size(); ++i)
    {
      const HandEyeSample sample =
        makeSample(int(i), balls_Camera[i], { camera }, 0, tip_Marker(i) + random.normal3(sigmaMm), sigmaPx, random);
      CapturedFrame frame;
      frame.frame = int(i);
      frame.status = "ok";
      frame.message = "ball found";
      frame.ball.status = BallDetection::Status::Found;
      frame.ball.ball_Image = sample.ball_Image;
      frame.ball.ray_Camera = sample.ray_Eye;
      frame.ball.covariance_Image = 0.01 * Eigen::Matrix2d::Identity();
      frame.ball.radiusPx = 20;
      frame.ball.distanceMm = balls_Camera[i].norm();
      frame.tip_Marker = sample.tip_Marker;
      frames.push_back(frame);
    }
    return frames;
  }

  /// Writes the recording's folder: frames/0000.png, ... and tracking.igs.mha.
  std::filesystem::path write(const std::filesystem::path& folder, const std::vector<io::SequenceFrame>& tracking) const
  {
    std::filesystem::create_directories(folder / "frames");
    for (std::size_t i = 0; i < balls_Camera.size(); ++i)
    {
      writePicture(folder, int(i), picture(i));
    }
    writeTracking(folder / "tracking.igs.mha", tracking);
    return folder;
  }

  static std::filesystem::path picturePath(const std::filesystem::path& folder, int frame)
  {
    char name[32];
    std::snprintf(name, sizeof(name), "%04d.png", frame);
    return folder / "frames" / name;
  }

  static void writePicture(const std::filesystem::path& folder, int frame, const cv::Mat& image)
  {
    cv::imwrite(picturePath(folder, frame).string(), image);
  }

  static void writeTracking(const std::filesystem::path& path, const std::vector<io::SequenceFrame>& tracking)
  {
    io::SequenceMetafileWriterOptions options;
    options.transformsOnly = true;
    io::SequenceMetafileWriter writer(path, options);
    for (const io::SequenceFrame& frame : tracking)
    {
      writer.append(frame);
    }
    writer.close();
  }
};

}  // namespace handeye::test
