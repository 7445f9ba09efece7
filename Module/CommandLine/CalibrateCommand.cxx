// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CalibrationStep.h"
#include "CameraFile.h"
#include "CommandOutput.h"
#include "Commands.h"
#include "CommonOptions.h"
#include "ResultFiles.h"
#include "TextTables.h"

#include <memory>

namespace handeye::cli
{

namespace
{

struct CalibrateArguments
{
  std::string recording, camera, stylus;
  std::string rightRecording, rightCamera, leftToRight;
  double ballRadiusMm = 0;
  BallDetectionOptions detection;
  HandEyeCalibrationOptions calibration;
  bool keepAll = false;
  ToolNames tools;
  CommandOutput output;
};

EyeCapture readEye(const CalibrateArguments& arguments, const std::string& recordingPath, const std::string& cameraPath,
  const Eigen::Vector3d& tip_Stylus, const std::string& label)
{
  const io::CameraFile file = io::readCameraFile(cameraPath);
  const io::Recording recording = io::Recording::open(recordingPath);
  arguments.output.warn(file.warnings);
  arguments.output.warn(recording.warnings());
  const CameraModel camera = cameraForRecording(file.camera, recording);
  return { camera,
    readCapture(recording, arguments.tools, camera, tip_Stylus, arguments.ballRadiusMm, arguments.detection,
      arguments.output.progress("looking for the ball" + label + ", frame")) };
}

/// The frames that are not used, one a line, with the reason.
void sayLeftOut(const CommandOutput& output, const std::vector<CalibratedFrame>& frames, const std::string& eye)
{
  for (const CalibratedFrame& frame : frames)
  {
    if (frame.used || frame.status == "ok")
    {
      continue;
    }
    const std::string reason = frame.status == "disagrees"
      ? format("disagrees with the others by %.1f px, %.1f mm", frame.residualPx, frame.residualMm)
      : frame.captured.message;
    output.say(
      "left out             " + eye + "frame " + std::to_string(frame.captured.frame) + ": " + frame.status + " (" + reason + ")");
  }
}

void sayResult(const CalibrationStepResult& step, const CommandOutput& output)
{
  const HandEyeCalibrationResult& calibration = step.calibration;
  if (step.isUsable())
  {
    output.say("markerToCamera (mm)");
    output.say(matrixLines(calibration.markerToCamera.matrix(), "  ", 4));
    if (step.right)
    {
      output.say("markerToRightCamera (mm)");
      output.say(matrixLines(step.right->markerToRightCamera.matrix(), "  ", 4));
    }
    output.say(format("fitted samples       %.2f px, %.2f mm RMS (validate on other captures)", calibration.reprojectionRmsPx,
      calibration.pointToLineRmsMm));
  }
  sayLeftOut(output, step.frames, step.right ? "left " : "");
  if (step.right)
  {
    sayLeftOut(output, step.right->frames, "right ");
  }
  if (step.isUsable())
  {
    output.say("verdict              " + calibration.message);
  }
  if (step.isUsable() && step.right && step.right->calibration)
  {
    output.say("verdict, right       " + step.right->calibration->message);
  }
}

int runCalibrate(CalibrateArguments& arguments)
{
  arguments.calibration.rejectOutliers = !arguments.keepAll;
  const Eigen::Vector3d tip_Stylus = readStylusTip(arguments.stylus);
  const bool isStereo = !arguments.rightRecording.empty();
  const EyeCapture left = readEye(arguments, arguments.recording, arguments.camera, tip_Stylus, isStereo ? " (left)" : "");
  CalibrationStepResult step = [&]
  {
    if (!isStereo)
    {
      return calibrateCapture(left, arguments.calibration);
    }
    std::optional<Eigen::Isometry3d> leftToRight;
    if (!arguments.leftToRight.empty())
    {
      leftToRight = io::readMatrix4x4(arguments.leftToRight);
    }
    const EyeCapture right = readEye(arguments, arguments.rightRecording, arguments.rightCamera, tip_Stylus, " (right)");
    return calibrateStereoCapture(left, right, leftToRight, arguments.calibration);
  }();
  step.tip_Stylus = tip_Stylus;
  step.ballRadiusMm = arguments.ballRadiusMm;
  step.tools = arguments.tools;
  sayResult(step, arguments.output);
  return arguments.output.finish(calibrationJson(step));
}

}  // namespace

void addCalibrateCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* command = app.add_subcommand("calibrate", "Find markerToCamera from a capture of the tracked ball");
  addRecordingArgument(*command, arguments->recording, "Capture: images and tracking");
  addCameraOption(*command, arguments->camera);
  command->add_option("--stylus", arguments->stylus, "What `handeye pivot` wrote")->required()->type_name("stylus.json");
  addBallRadiusOption(*command, arguments->ballRadiusMm);
  addSegmentationOption(*command, arguments->detection.method);
  addSolverOption(*command, arguments->calibration.method);
  command->add_flag(
    "--keep-all", arguments->keepAll, "Use all samples, also those that disagree with the rest (as the paper does)");
  addTransformOption(*command, "--stylus-transform", arguments->tools.stylusToTracker, "stylus");
  addTransformOption(*command, "--marker-transform", arguments->tools.markerToTracker, "camera's marker");
  addLatencyOption(*command, arguments->tools.latencySec);
  CLI::Option* right = command->add_option("--right", arguments->rightRecording, "Capture of the right eye of a stereo rig");
  right->type_name("RECORDING");
  CLI::Option* rightCamera =
    command->add_option("--right-camera", arguments->rightCamera, "Lens of the right eye")->type_name("CAMERA");
  right->needs(rightCamera);
  rightCamera->needs(right);
  command
    ->add_option("--left-to-right", arguments->leftToRight,
      "The eyes' relation, p_Right = M * p_Left, four rows of four numbers: both eyes become one registration")
    ->type_name("4x4-FILE")
    ->needs(right);
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runCalibrate(*arguments); });
}

}  // namespace handeye::cli
