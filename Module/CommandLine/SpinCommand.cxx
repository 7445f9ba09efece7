// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CommandOutput.h"
#include "Commands.h"
#include "CommonOptions.h"
#include "ResultFiles.h"
#include "SpinStep.h"

#include <memory>

namespace handeye::cli
{

namespace
{

struct SpinArguments
{
  std::string recording, stylus;
  std::string transform = ToolNames().stylusToTracker;
  CommandOutput output;
};

int runSpin(const SpinArguments& arguments)
{
  const Eigen::Vector3d tip_Stylus = readStylusTip(arguments.stylus);
  const nlohmann::json stylus = readStylus(arguments.stylus);
  const io::Recording recording = io::Recording::open(arguments.recording);
  arguments.output.warn(recording.warnings());
  const SpinStepResult step = spinFromRecording(recording, arguments.transform, tip_Stylus);
  const SpinCalibrationResult& calibration = step.calibration;
  if (calibration.isUsable())
  {
    arguments.output.say("shaft (Stylus)       " + numbers(calibration.shaft_Stylus, 5) + ", from the tip");
    arguments.output.say("stylusTipToStylus (mm)");
    arguments.output.say(matrixLines(calibration.stylusTipToStylus.matrix(), "  ", 4));
    if (calibration.tipToAxisMm)
    {
      arguments.output.say(format("tip beside the shaft %.2f mm", *calibration.tipToAxisMm));
    }
    arguments.output.say("frames               " + std::to_string(step.usedFrames.size()) + " used, " +
      std::to_string(step.invalidFrames.size()) + " not tracked, left out: " + list(step.rejectedFrames));
    arguments.output.say(calibration.message);
  }
  return arguments.output.finish(spinJson(step, stylus));
}

}  // namespace

void addSpinCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<SpinArguments>();
  CLI::App* command = app.add_subcommand(
    "spin", "Find the shaft of a stylus, and its tip's whole frame, from a recording of it spinning about the shaft");
  addRecordingArgument(*command, arguments->recording, "Sequence metafile, or folder with tracking.igs.mha");
  command->add_option("--stylus", arguments->stylus, "The stylus' tip; -o writes it again with stylusTipToStylus added")
    ->required()
    ->type_name("stylus.json");
  addTransformOption(*command, "--transform", arguments->transform, "stylus");
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runSpin(*arguments); });
}

}  // namespace handeye::cli
