// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallOptions.h"
#include "CameraFile.h"
#include "CommandOutput.h"
#include "Commands.h"
#include "CommonOptions.h"
#include "DetectionStages.h"
#include "ResultFiles.h"

#include <cmath>
#include <memory>

namespace handeye::cli
{

namespace
{

struct DetectArguments
{
  std::string recording, camera, stages;
  double ballRadiusMm = 0;
  BallOptions ball;
  bool follow = false;
  CommandOutput output;
};

int runDetect(const DetectArguments& arguments)
{
  const io::CameraFile file = io::readCameraFile(arguments.camera);
  const io::Recording recording = io::Recording::openImages(arguments.recording);
  arguments.output.warn(file.warnings);
  arguments.output.warn(recording.warnings());
  const CameraModel camera = cameraForRecording(file.camera, recording);
  const BallDetectionOptions options = arguments.ball.forRecording(recording, arguments.output);
  const Progress progress = arguments.output.progress("looking for the ball, frame");
  const std::vector<CapturedFrame> frames = arguments.follow
    ? followBall(recording, camera, arguments.ballRadiusMm, options, progress)
    : detectBalls(recording, camera, arguments.ballRadiusMm, options, progress);
  if (!arguments.stages.empty())
  {
    writeDetectionStages(arguments.stages, recording, camera, arguments.ballRadiusMm, options, frames);
    arguments.output.say("stages in            " + arguments.stages);
  }
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
  arguments->ball.addTo(*command);
  command->add_flag("--follow", arguments->follow, "The recording is a video: look first where the last frame had the ball");
  command->add_option("--stages", arguments->stages, "Write four pictures a frame into this folder: mask, smoothed, edges, outline")
    ->type_name("DIR");
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runDetect(*arguments); });
}

}  // namespace handeye::cli
