// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CommandOutput.h"
#include "Commands.h"
#include "CommonOptions.h"
#include "PivotStep.h"
#include "ResultFiles.h"

#include <cmath>
#include <memory>

namespace handeye::cli
{

namespace
{

constexpr double Degrees = 180 / EIGEN_PI;

struct PivotArguments
{
  std::string recording;
  std::string transform = ToolNames().stylusToTracker;
  PivotCalibrationOptions options;
  double rotationNoiseDeg = TrackerNoise().rotation * Degrees;
  CommandOutput output;
};

int runPivot(const PivotArguments& arguments)
{
  const io::Recording recording = io::Recording::open(arguments.recording);
  arguments.output.warn(recording.warnings());
  PivotCalibrationOptions options = arguments.options;
  options.noise = TrackerNoise::fromDegrees(options.noise.positionMm, arguments.rotationNoiseDeg);
  const PivotStepResult step = pivotFromRecording(recording, arguments.transform, options);
  const PivotCalibrationResult& calibration = step.calibration;
  if (calibration.isUsable())
  {
    const Eigen::Vector3d sigma = calibration.tipCovariance.diagonal().cwiseSqrt();
    arguments.output.say("tip (mm, Stylus)     " + numbers(calibration.tip_Stylus, 3));
    arguments.output.say("  standard error     " + numbers(sigma, 3));
    arguments.output.say(format("residual             %.3f mm RMS, %.3f mm mean, %.3f mm at most", calibration.rmsMm,
      calibration.meanMm, calibration.maximumMm));
    arguments.output.say(format("                     %.2f times the tracker's noise", calibration.noiseFactor));
    arguments.output.say(format("leant over           %.0f and %.0f deg, in two perpendicular directions",
      calibration.angularRange(0) * Degrees, calibration.angularRange(1) * Degrees));
    arguments.output.say("frames               " + std::to_string(step.usedFrames.size()) + " used, " +
      std::to_string(step.invalidFrames.size()) + " not tracked, " + std::to_string(step.repeatedFrames.size()) +
      " repeated, left out: " + list(step.rejectedFrames));
  }
  return arguments.output.finish(stylusJson(step));
}

}  // namespace

void addPivotCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<PivotArguments>();
  CLI::App* command = app.add_subcommand("pivot", "Find the tip of a stylus from a recording of it turning about that tip");
  addRecordingArgument(*command, arguments->recording, "Sequence metafile, or folder with tracking.igs.mha");
  addTransformOption(*command, "--transform", arguments->transform, "stylus");
  addPivotMethodOption(*command, arguments->options.method);
  command->add_option("--noise-mm", arguments->options.noise.positionMm, "The tracker's noise of a position, per axis")
    ->type_name("MM")
    ->check(CLI::PositiveNumber)
    ->capture_default_str();
  command->add_option("--noise-deg", arguments->rotationNoiseDeg, "The tracker's noise of a rotation, per axis")
    ->type_name("DEG")
    ->check(CLI::NonNegativeNumber)
    ->capture_default_str();
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runPivot(*arguments); });
}

}  // namespace handeye::cli
