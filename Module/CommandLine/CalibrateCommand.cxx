// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallOptions.h"
#include "CalibrationStep.h"
#include "CameraFile.h"
#include "CommandOutput.h"
#include "Commands.h"
#include "CommonOptions.h"
#include "ResultFiles.h"
#include "SecondLook.h"
#include "TextTables.h"
#include "TimedPose.h"

#include <cmath>
#include <memory>
#include <stdexcept>

namespace handeye::cli
{

namespace
{

/// A first calibration is not trusted to say better than this (px) where the ball is seen.
constexpr double LeastPredictionPx = 4;

struct CalibrateArguments
{
  std::string recording, camera, stylus;
  std::string rightRecording, rightCamera, leftToRight;
  double ballRadiusMm = 0;
  BallOptions ball;
  HandEyeCalibrationOptions calibration;
  bool keepAll = false;
  std::vector<double> depthsMm;
  ToolNames tools;
  CommandOutput output;
};

/// One eye's capture, and what it takes to look at its pictures again.
struct Eye
{
  io::Recording recording;
  BallDetectionOptions ball;
  EyeCapture capture;
};

Eye readEye(const CalibrateArguments& arguments, const std::string& recordingPath, const std::string& cameraPath,
  const Eigen::Vector3d& tip_Stylus, const std::string& label)
{
  const io::CameraFile file = io::readCameraFile(cameraPath);
  io::Recording recording = io::Recording::open(recordingPath);
  arguments.output.warn(file.warnings);
  arguments.output.warn(recording.warnings());
  arguments.output.warn(latencyNotes(recording, arguments.tools.latencySec));
  const CameraModel camera = cameraForRecording(file.camera, recording);
  const BallDetectionOptions ball = arguments.ball.forRecording(recording, arguments.output);
  std::vector<CapturedFrame> frames = readCapture(recording, arguments.tools, camera, tip_Stylus, arguments.ballRadiusMm, ball,
    arguments.output.progress("looking for the ball" + label + ", frame"));
  return { std::move(recording), ball, { camera, std::move(frames) } };
}

/// Decides the frames in which several things looked like the ball. @return whether there were any that could be decided
bool decideDoubtful(const CalibrateArguments& arguments, Eye& eye, const Eigen::Isometry3d& markerToCamera, double predictedPx,
  const std::string& label)
{
  const double sigmaPx = std::hypot(predictedPx, LeastPredictionPx);
  const std::vector<int> decided =
    lookAgain(eye.recording, eye.capture.camera, arguments.ballRadiusMm, eye.ball, markerToCamera, sigmaPx, eye.capture.frames);
  for (const int frame : decided)
  {
    arguments.output.say(
      "decided              " + label + "frame " + std::to_string(frame) + ": of several balls, the one where the tracker puts it");
  }
  return !decided.empty();
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
      ? format("disagrees with the others by %.1f px, %.1f mm: %.0f times what its noise explains", frame.residualPx,
          frame.residualMm, frame.deviation)
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
  if (step.isUsable() && calibration.predictedByEye.size() > 1)
  {
    const PredictedError& right = calibration.predictedByEye[1];
    output.say(
      format("right eye            %.1f px predicted over the working volume (%.1f px at worst)", right.meanPx, right.maximumPx));
  }
  if (step.isUsable())
  {
    output.say(format("target error         %.2f mm predicted over the working volume (%.2f mm at worst)",
      calibration.predicted.meanMm, calibration.predicted.maximumMm));
  }
  if (!calibration.tipMessage.empty())
  {
    output.say("tip                  " + calibration.tipMessage);
  }
  if (step.guidance)
  {
    output.say("next placement       " + step.guidance->message);
  }
}

int runCalibrate(CalibrateArguments& arguments)
{
  if (!arguments.depthsMm.empty() && !(arguments.depthsMm[0] < arguments.depthsMm[1]))
  {
    throw std::invalid_argument("--depth-range: the nearest depth first and a greater one after it are expected");
  }
  arguments.calibration.rejectOutliers = !arguments.keepAll;
  arguments.calibration.tipCovariance_Stylus = readStylusTipCovariance(arguments.stylus);
  const Eigen::Vector3d tip_Stylus = readStylusTip(arguments.stylus);
  const bool isStereo = !arguments.rightRecording.empty();
  Eye left = readEye(arguments, arguments.recording, arguments.camera, tip_Stylus, isStereo ? " (left)" : "");
  if (arguments.tools.latencySec == 0)
  {
    arguments.tools.latencySec = left.recording.appliedLatencySec();  // so that validate and overlay have it
  }
  std::optional<Eye> right;
  std::optional<Eigen::Isometry3d> leftToRight;
  if (isStereo)
  {
    leftToRight = arguments.leftToRight.empty() ? leftToRight : io::readMatrix4x4(arguments.leftToRight);
    right = readEye(arguments, arguments.rightRecording, arguments.rightCamera, tip_Stylus, " (right)");
  }
  const auto calibrate = [&]
  {
    return right ? calibrateStereoCapture(left.capture, right->capture, leftToRight, arguments.calibration)
                 : calibrateCapture(left.capture, arguments.calibration);
  };
  CalibrationStepResult step = calibrate();
  if (step.isUsable())
  {
    const double predictedPx = step.calibration.predicted.maximumPx;
    bool isDecided = decideDoubtful(arguments, left, step.calibration.markerToCamera, predictedPx, isStereo ? "left " : "");
    if (right && step.right)
    {
      isDecided |= decideDoubtful(arguments, *right, step.right->markerToRightCamera, predictedPx, "right ");
    }
    step = isDecided ? calibrate() : step;
  }
  step.tip_Stylus = tip_Stylus + step.calibration.tipCorrection_Stylus.value_or(Eigen::Vector3d::Zero());
  addGuidance(step, arguments.calibration,
    arguments.depthsMm.empty() ? DepthRange() : DepthRange({ arguments.depthsMm[0], arguments.depthsMm[1] }));
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
  arguments->ball.addTo(*command);
  addSolverOption(*command, arguments->calibration.method);
  command->add_flag(
    "--keep-all", arguments->keepAll, "Use all samples, also those that disagree with the rest (as the paper does)");
  addSigmaOption(*command, "--sigma-mm", arguments->calibration.trackingSigmaMm, "Noise of the tracked tip, mm per axis");
  addSigmaOption(*command, "--sigma-px", arguments->calibration.segmentationSigmaPx,
    "Noise of the segmented ball where the segmentation does not say, px per axis");
  command->add_flag(
    "--estimate-noise", arguments->calibration.estimateNoise, "ml: estimate the size of both kinds of noise from the residuals");
  command->add_flag("--refine-tip", arguments->calibration.refineTip,
    "Estimate the stylus' tip along with the camera, where the capture says more of it than the pivot calibration");
  const auto isDepth = [](const std::string& text)
  {
    double depth = 0;
    const bool good = CLI::detail::lexical_cast(text, depth) && depth > 0 && std::isfinite(depth);
    return good ? std::string() : "'" + text + "' is not a depth, a positive number of mm is expected";
  };
  command
    ->add_option("--depth-range", arguments->depthsMm, "Depths of the working volume for the next placement, nearest and furthest")
    ->expected(2)
    ->check(CLI::Validator(isDepth, std::string()))
    ->type_name("MM");
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
