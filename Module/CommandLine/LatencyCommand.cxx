// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFile.h"
#include "CommandOutput.h"
#include "Commands.h"
#include "CommonOptions.h"
#include "ResultFiles.h"
#include "TemporalCalibration.h"

#include <memory>

namespace handeye::cli
{

namespace
{

struct LatencyArguments
{
  std::string recording, poses, camera, stylus, calibration;
  double ballRadiusMm = 0;
  BallDetectionOptions detection;
  ToolNames tools;
  CommandOutput output;
};

/// A tool's poses by their own times.
PoseTrack trackOf(const io::Recording& recording, const std::string& name)
{
  recording.requireTransform(name);
  PoseTrackOptions options;
  options.historySec = 1e9;
  options.maximumRepeatSec = 0;
  PoseTrack track(options);
  for (int frame = 0; frame < recording.frameCount(); ++frame)
  {
    const io::TransformSample pose = recording.transform(frame, name);
    const std::optional<double> timeSec = recording.timestampSec(frame);
    if (timeSec && pose.status != io::TransformSample::Status::Missing)
    {
      track.add(*timeSec, pose.transform, pose.isUsable());
    }
  }
  return track;
}

int runLatency(const LatencyArguments& arguments)
{
  const io::CameraFile file = io::readCameraFile(arguments.camera);
  const io::Recording recording = io::Recording::open(arguments.recording);
  const io::Recording poses = io::Recording::open(arguments.poses.empty() ? arguments.recording : arguments.poses);
  arguments.output.warn(file.warnings);
  arguments.output.warn(recording.warnings());
  if (arguments.poses.empty() && recording.appliedLatencySec() != 0)
  {
    arguments.output.warn({ format("the recording's poses have a latency of %.1f ms already: what is found comes on top of it",
      1000 * recording.appliedLatencySec()) });
  }
  const CameraModel camera = cameraForRecording(file.camera, recording);
  std::vector<BallSighting> sightings;
  for (const CapturedFrame& captured : detectBalls(
         recording, camera, arguments.ballRadiusMm, arguments.detection, arguments.output.progress("looking for the ball, frame")))
  {
    const std::optional<double> timeSec = recording.timestampSec(captured.frame);
    if (captured.ball.isFound() && timeSec)
    {
      sightings.push_back({ *timeSec, captured.ball.ray_Camera, captured.ball.distanceMm });
    }
  }
  std::optional<Eigen::Isometry3d> markerToCamera;
  if (!arguments.calibration.empty())
  {
    markerToCamera = readCalibration(arguments.calibration).markerToCamera;
  }
  const TemporalCalibrationResult result = calibrateLatency(sightings, trackOf(poses, arguments.tools.markerToTracker),
    trackOf(poses, arguments.tools.stylusToTracker), readStylusTip(arguments.stylus), camera, markerToCamera);
  nlohmann::json object = { { "schema", "handeye-latency/1" }, { "status", toString(result.status) }, { "message", result.message },
    { "usedFrames", result.usedCount }, { "rejectedFrames", result.rejectedCount } };
  if (result.isUsable())
  {
    object["latencySec"] = result.latencySec;
    object["sigmaSec"] = result.sigmaSec;
    object["rmsPx"] = result.rmsPx;
    arguments.output.say(format("latency              %.1f ms, standard deviation %.1f ms (residual %.2f px RMS)",
      1000 * result.latencySec, 1000 * result.sigmaSec, result.rmsPx));
    arguments.output.say(result.message);
  }
  return arguments.output.finish(object);
}

}  // namespace

void addLatencyCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<LatencyArguments>();
  CLI::App* command = app.add_subcommand("latency", "Find how far video and tracker are apart in time, from a moving ball");
  addRecordingArgument(*command, arguments->recording, "Some seconds of the ball in motion: images, poses and times");
  command
    ->add_option("--poses", arguments->poses, "The poses at their own rate (`handeye record --poses`), instead of the recording's")
    ->type_name("RECORDING");
  addCameraOption(*command, arguments->camera);
  command->add_option("--stylus", arguments->stylus, "What `handeye pivot` wrote")->required()->type_name("stylus.json");
  addBallRadiusOption(*command, arguments->ballRadiusMm);
  addSegmentationOption(*command, arguments->detection.method);
  command->add_option("--calibration", arguments->calibration, "Take markerToCamera from it; found along the way otherwise")
    ->type_name("calibration.json");
  addTransformOption(*command, "--stylus-transform", arguments->tools.stylusToTracker, "stylus");
  addTransformOption(*command, "--marker-transform", arguments->tools.markerToTracker, "camera's marker");
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runLatency(*arguments); });
}

}  // namespace handeye::cli
