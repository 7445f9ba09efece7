// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallOptions.h"
#include "CommandOutput.h"
#include "Commands.h"
#include "CommonOptions.h"
#include "OffscreenRendering.h"
#include "ResultFiles.h"
#include "TimedPose.h"
#include "ValidationReport.h"
#include "ValidationStep.h"

#include <memory>

namespace handeye::cli
{

namespace
{

struct ValidateArguments
{
  std::string recording, calibration, report;
  std::string stylusTransform, markerTransform;
  std::optional<double> latencySec;
  BallOptions ball;
  CommandOutput output;
};

int runValidate(const ValidateArguments& arguments)
{
  const StoredCalibration stored = readCalibration(arguments.calibration);
  const io::Recording recording = io::Recording::open(arguments.recording);
  arguments.output.warn(recording.warnings());
  ToolNames tools = stored.tools;
  tools.stylusToTracker = arguments.stylusTransform.empty() ? tools.stylusToTracker : arguments.stylusTransform;
  tools.markerToTracker = arguments.markerTransform.empty() ? tools.markerToTracker : arguments.markerTransform;
  tools.latencySec = chooseLatency(arguments.latencySec, tools.latencySec, arguments.output);
  arguments.output.warn(latencyNotes(recording, tools.latencySec));
  const CameraModel camera = cameraForRecording(stored.camera, recording);
  const std::vector<CapturedFrame> frames = readCapture(recording, tools, camera, stored.tip_Stylus, stored.ballRadiusMm,
    arguments.ball.forRecording(recording, arguments.output), arguments.output.progress("looking for the ball, frame"));
  ValidationStepResult step = validateCapture(frames, camera, stored.markerToCamera);
  step.subject.calibrationFile = arguments.calibration;
  step.subject.ballRadiusMm = stored.ballRadiusMm;
  if (step.isUsable())
  {
    const Summary& error = step.projectionErrorPx;
    arguments.output.say(format("projection error     %.2f px mean, %.2f px standard deviation, %.2f px RMS", error.mean,
      error.standardDeviation, error.rms));
    arguments.output.say(format("                     %.2f to %.2f px over ", error.minimum, error.maximum) +
      std::to_string(error.count) + " of " + std::to_string(frames.size()) + " frames");
  }
  arguments.output.say("verdict              " + step.message);
  for (const ValidatedFrame& frame : step.frames)
  {
    if (frame.status != "ok")
    {
      arguments.output.say("left out             frame " + std::to_string(frame.captured.frame) + ": " + frame.status + " (" +
        frame.captured.message + ")");
    }
  }
  if (!arguments.report.empty())
  {
    registerOffscreenRendering();
    writeValidationReport(arguments.report, step, recording);
    arguments.output.say("report in            " + arguments.report + "/report.html, report.pdf");
  }
  return arguments.output.finish(validationJson(step));
}

}  // namespace

void addValidateCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<ValidateArguments>();
  CLI::App* command = app.add_subcommand("validate", "Measure a calibration's projection error on a capture that was not fitted");
  addRecordingArgument(*command, arguments->recording, "Another capture: images and tracking");
  addCalibrationOption(*command, arguments->calibration);
  command
    ->add_option("--report", arguments->report, "Write report.html, report.pdf, errors.csv and a picture a frame into this folder")
    ->type_name("DIR");
  arguments->ball.addTo(*command);
  addTransformOption(*command, "--stylus-transform", arguments->stylusTransform, "stylus");
  addTransformOption(*command, "--marker-transform", arguments->markerTransform, "camera's marker");
  addLatencyOption(*command, arguments->latencySec);
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runValidate(*arguments); });
}

}  // namespace handeye::cli
