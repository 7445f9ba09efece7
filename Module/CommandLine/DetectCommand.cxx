// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFile.h"
#include "CommandOutput.h"
#include "Commands.h"
#include "CommonOptions.h"
#include "ResultFiles.h"

#include <cmath>
#include <memory>

namespace handeye::cli
{

namespace
{

struct DetectArguments
{
  std::string recording, camera;
  double ballRadiusMm = 0;
  BallDetectionOptions detection;
  CommandOutput output;
};

int runDetect(const DetectArguments& arguments)
{
  const io::CameraFile file = io::readCameraFile(arguments.camera);
  const io::Recording recording = io::Recording::openImages(arguments.recording);
  arguments.output.warn(file.warnings);
  arguments.output.warn(recording.warnings());
  const std::vector<CapturedFrame> frames = detectBalls(
    recording, file.camera, arguments.ballRadiusMm, arguments.detection, arguments.output.progress("looking for the ball, frame"));
  arguments.output.say("frame  centre (px)         sigma (px)  radius (px)  distance (mm)  status");
  for (const CapturedFrame& captured : frames)
  {
    const BallDetection& ball = captured.ball;
    const std::string place = ball.isFound() ? format("%9.2f %8.2f", ball.ball_Image.x(), ball.ball_Image.y()) +
        format("  %10.2f  %11.1f  %13.1f", std::sqrt(ball.covariance_Image.trace() / 2), ball.radiusPx, ball.distanceMm)
                                             : std::string(56, ' ');
    arguments.output.say(
      format("%5.0f  ", captured.frame) + place + "  " + captured.status + (ball.isFound() ? "" : " (" + captured.message + ")"));
  }
  return arguments.output.finish(detectionJson(frames));
}

}  // namespace

void addDetectCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<DetectArguments>();
  CLI::App* command = app.add_subcommand("detect", "Find the ball in every frame of a recording");
  addRecordingArgument(*command, arguments->recording, "Recording with images");
  addCameraOption(*command, arguments->camera);
  addBallRadiusOption(*command, arguments->ballRadiusMm);
  addSegmentationOption(*command, arguments->detection.method);
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runDetect(*arguments); });
}

}  // namespace handeye::cli
