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

struct PivotArguments
{
  std::string recording;
  std::string transform = ToolNames().stylusToTracker;
  CommandOutput output;
};

int runPivot(const PivotArguments& arguments)
{
  const io::Recording recording = io::Recording::open(arguments.recording);
  arguments.output.warn(recording.warnings());
  const PivotStepResult step = pivotFromRecording(recording, arguments.transform);
  const PivotCalibrationResult& calibration = step.calibration;
  if (calibration.isUsable())
  {
    const Eigen::Vector3d sigma = calibration.tipCovariance.diagonal().cwiseSqrt();
    arguments.output.say("tip (mm, Stylus)     " + numbers(calibration.tip_Stylus, 3));
    arguments.output.say("  standard error     " + numbers(sigma, 3));
    arguments.output.say(format("residual             %.3f mm RMS, %.3f mm at most", calibration.rmsMm, calibration.maximumMm));
    arguments.output.say("frames               " + std::to_string(step.usedFrames.size()) + " used, " +
      std::to_string(step.invalidFrames.size()) + " not tracked, left out: " + list(step.rejectedFrames));
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
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runPivot(*arguments); });
}

}  // namespace handeye::cli
