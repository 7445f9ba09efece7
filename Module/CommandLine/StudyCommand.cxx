// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CommandOutput.h"
#include "Commands.h"
#include "HandEyeStudy.h"
#include "OffscreenRendering.h"
#include "StopSignal.h"
#include "StudyReport.h"

#include <unistd.h>

#include <iostream>
#include <memory>

namespace handeye::cli
{

namespace
{

struct StudyArguments
{
  std::string report;
  study::StudyOptions options;
  double focalErrorPercent = 0, boardErrorPercent = 0;
  CommandOutput output;
};

void sayCamera(const study::StudyCameraResult& camera, const CommandOutput& output)
{
  output.say(camera.camera.title);
  output.say("  method                 mean     std     min     max px |  own mean   own max px   calibrations");
  for (std::size_t i = 0; i < camera.comparison.methods.size(); ++i)
  {
    const MethodResult& method = camera.comparison.methods[i];
    const Summary &error = method.errorPx, &own = camera.truth.methods[i].errorPx;
    char line[200];
    if (method.isUsable())
    {
      std::snprintf(line, sizeof(line), "  %-20s%8.2f%8.2f%8.2f%8.2f    |%10.2f%13.2f   %d of %zu", method.name.c_str(), error.mean,
        error.standardDeviation, error.minimum, error.maximum, own.mean, own.maximum, method.usableCount(), method.captures.size());
      output.say(line);
    }
    else
    {
      std::snprintf(line, sizeof(line), "  %-20s", method.name.c_str());
      output.say(line + method.status + " (" + method.message + ")");
    }
  }
}

int runStudyCommand(StudyArguments& arguments)
{
  catchStopSignals();
  const bool isTerminal = isatty(STDERR_FILENO) != 0;
  arguments.options.progress = [isTerminal](const std::string& what, int done, int total)
  {
    if (isTerminal)
    {
      std::cerr << '\r' << done << " of " << total << ": " << what << "\033[K" << (done == total ? "\n" : "") << std::flush;
    }
    return !isStopAsked();
  };
  arguments.options.lensFocalShare = arguments.focalErrorPercent / 100;
  arguments.options.boardScaleShare = arguments.boardErrorPercent / 100;
  const study::StudyResult result = study::runStudy(arguments.options);
  if (result.isUsable())
  {
    for (const study::StudyCameraResult& camera : result.cameras)
    {
      sayCamera(camera, arguments.output);
    }
    for (const study::StudyClaim& claim : result.claims)
    {
      arguments.output.say("verdict              " + claim.message);
    }
    if (!arguments.report.empty())
    {
      registerOffscreenRendering();
      study::writeStudyReport(arguments.report, result);
      arguments.output.say("report in            " + arguments.report + "/report.html, report.pdf");
    }
  }
  return arguments.output.finish(study::studyJson(result));
}

/// How many repetitions look into what.
void addRepetitionOptions(CLI::App& command, study::StudyOptions& options)
{
  const CLI::Range some(0, 100000);
  command.add_option("--subsets", options.subsetRepetitions, "Repetitions that also vary the number of samples from 3 to 30")
    ->check(some)
    ->capture_default_str();
  command
    .add_option(
      "--tilts", options.tiltRepetitions, "Repetitions for each range of the board's directions, 5 to 45 degrees; 0 for none")
    ->check(some)
    ->capture_default_str();
  command
    .add_option("--conditions", options.conditionRepetitions,
      "Repetitions with one thing changed at a time: corners, print, lens, stylus, number of balls; 0 for none")
    ->check(some)
    ->capture_default_str();
  command
    .add_option("--render", options.renderedRepetitions,
      "Repetitions whose balls and boards are rendered and found by the detectors, besides the others")
    ->check(some)
    ->capture_default_str();
  command.add_option("--noise-pictures", options.noisePictures, "Rendered pictures from which the features' noise is measured")
    ->check(CLI::Range(4, 100000))
    ->capture_default_str();
}

/// Noise and errors, and how the board is looked at.
void addNoiseOptions(CLI::App& command, StudyArguments& arguments)
{
  study::StudyOptions& options = arguments.options;
  command.add_option("--tracking-noise-mm", options.trackingSigmaMm, "Of every pose, per axis")
    ->check(CLI::NonNegativeNumber)
    ->capture_default_str()
    ->type_name("MM");
  command.add_option("--tracking-noise-deg", options.trackingSigmaDeg, "Of every pose, per axis")
    ->check(CLI::NonNegativeNumber)
    ->capture_default_str()
    ->type_name("DEG");
  command
    .add_option("--lens-focal-error", arguments.focalErrorPercent,
      "Error of the focal length that the methods are told, %, one standard deviation")
    ->check(CLI::Range(0.0, 9.0))
    ->capture_default_str()
    ->type_name("PERCENT");
  command.add_option("--lens-center-error", options.lensCenterPx, "The same of the principal point, px per axis")
    ->check(CLI::NonNegativeNumber)
    ->capture_default_str()
    ->type_name("PX");
  command
    .add_option(
      "--corner-noise", options.cornerSigmaPx, "Of the board's corners, px per axis, instead of what is measured on pictures")
    ->check(CLI::NonNegativeNumber)
    ->type_name("PX");
  command
    .add_option("--board-print-error", arguments.boardErrorPercent,
      "Error of the size in which the board is printed, %, one standard deviation")
    ->check(CLI::Range(0.0, 9.0))
    ->capture_default_str()
    ->type_name("PERCENT");
  command.add_option("--board-tilt", options.size.boardTiltDeg, "The board is looked at from up to so far off its normal")
    ->check(CLI::Range(1.0, 70.0))
    ->capture_default_str()
    ->type_name("DEG");
  command.add_option("--board-roll", options.size.boardRollDeg, "The camera is turned about its axis by up to so much")
    ->check(CLI::Range(0.0, 180.0))
    ->capture_default_str()
    ->type_name("DEG");
  command.add_flag("--no-noise", options.isNoiseFree, "No noise at all: every method must find the truth");
}

}  // namespace

void addStudyCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<StudyArguments>();
  study::StudyOptions& options = arguments->options;
  CLI::App* command = app.add_subcommand("study",
    "The paper's evaluation in simulation: webcam, head-mounted stereo camera, stereo laparoscope; every method, many repetitions");
  command->add_option("--report", arguments->report, "Write report.html, report.pdf and the data as CSV into this folder")
    ->type_name("DIR");
  const CLI::Range count(1, 100000);
  command->add_option("--repetitions", options.repetitions, "Captures of each camera and eye")->check(count)->capture_default_str();
  command->add_option("--seed", options.seed, "Of everything random")->capture_default_str();
  command->add_option("--jobs", options.jobs, "Threads")->check(CLI::Range(1, 256))->capture_default_str();
  command->add_option("--time-limit", options.branchAndBoundSec, "Of one branch and bound, s; 0 leaves it out")
    ->check(CLI::Range(0.0, 3600.0))
    ->capture_default_str()
    ->type_name("SEC");
  command->add_option("--camera", options.cameras, "Only these: webcam, headset, laparoscope")->type_name("NAME");
  command->add_option("--samples", options.size.ballSamples, "Balls of a capture")
    ->check(CLI::Range(6, 1000))
    ->capture_default_str();
  command->add_option("--board-views", options.size.boardViews, "Views of the board of a capture")
    ->check(CLI::Range(3, 1000))
    ->capture_default_str();
  addRepetitionOptions(*command, options);
  addNoiseOptions(*command, *arguments);
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runStudyCommand(*arguments); });
}

}  // namespace handeye::cli
