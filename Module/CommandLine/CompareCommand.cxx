// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFile.h"
#include "CommandOutput.h"
#include "Commands.h"
#include "CommonOptions.h"
#include "CompareCaptures.h"
#include "ComparedBoardMethods.h"
#include "ComparedMethods.h"
#include "ComparisonFiles.h"
#include "ComparisonReport.h"
#include "NumberWords.h"
#include "OffscreenRendering.h"
#include "ResultFiles.h"
#include "StopSignal.h"
#include "TimedPose.h"

#include <unistd.h>

#include <iostream>
#include <memory>
#include <stdexcept>

namespace handeye::cli
{

namespace
{

struct CompareArguments
{
  std::string validation, camera, stylus, report;
  std::vector<std::string> ballRecordings, boardRecordings;
  std::string board, boardRegistration;
  TrackedBoardNames trackedBoard;
  double branchAndBoundSec = 60;
  double ballRadiusMm = 0;
  BallOptions ball;
  ToolNames tools;
  HandEyeCalibrationOptions calibration;
  ComparisonOptions comparison;
  bool withPublished = true;
  CommandOutput output;
};

/// What is being done, on standard error if that is a terminal; stops when Ctrl+C asked for it.
std::function<bool(const std::string&, int, int)> comparisonProgress()
{
  const bool isTerminal = isatty(STDERR_FILENO) != 0;
  return [isTerminal](const std::string& what, int done, int total)
  {
    if (isTerminal)
    {
      std::cerr << "\rcomparing " << done << " of " << total << ": " << what << "\033[K" << (done == total ? "\n" : "")
                << std::flush;
    }
    return !isStopAsked();
  };
}

void sayMethods(const ComparisonResult& result, const CommandOutput& output)
{
  output.say("method              rank    mean     std     min     max     RMS px   errors   calibrations");
  const std::vector<std::string> ranks = report::ranksOf(result);
  for (std::size_t i = 0; i < result.methods.size(); ++i)
  {
    const MethodResult& method = result.methods[i];
    char line[200];
    const Summary& error = method.errorPx;
    if (method.isUsable())
    {
      std::snprintf(line, sizeof(line), "%-18s %5s%8.2f%8.2f%8.2f%8.2f%8.2f %11d   %d of %zu", method.name.c_str(),
        ranks[i].c_str(), error.mean, error.standardDeviation, error.minimum, error.maximum, error.rms, error.count,
        method.usableCount(), method.captures.size());
      output.say(line);
    }
    else
    {
      std::snprintf(line, sizeof(line), "%-18s ", method.name.c_str());
      output.say(line + method.status + " (" + method.message + ")");
    }
  }
  output.say("rank                 ~: not told apart from the first by these data" +
    std::string(result.incomplete.empty() ? "" : "; apart: failed where others did not, its errors are of easier cases"));
}

std::vector<std::string> factsOf(const CompareArguments& arguments, const CompareCaptures& captures)
{
  const CameraModel& camera = captures.camera;
  std::vector<std::string> facts = { "Validation: " + arguments.validation + ", " + std::to_string(captures.validation.size()) +
    " samples in " + std::to_string(captures.validationFrames.size()) + " frames. Lens: " + arguments.camera + ", " +
    std::to_string(camera.width()) + " x " + std::to_string(camera.height()) + " px, fx " + fixedDigits(camera.fx(), 1) + ", fy " +
    fixedDigits(camera.fy(), 1) + " px. Ball: radius " + fixedDigits(arguments.ballRadiusMm, 2) + " mm, tip by " +
    arguments.stylus + "." };
  facts.insert(facts.end(), captures.facts.begin(), captures.facts.end());
  return facts;
}

/// The branch and bound takes so long that it says how far it is.
BoardMethodsOptions boardOptions(const CompareArguments& arguments)
{
  BoardMethodsOptions options;
  options.withBranchAndBound = arguments.branchAndBoundSec > 0;
  options.options.timeLimitSec = options.withBranchAndBound ? arguments.branchAndBoundSec : options.options.timeLimitSec;
  const bool isTerminal = isatty(STDERR_FILENO) != 0;
  options.progress = [isTerminal](const BranchAndBoundState& state)
  {
    if (isTerminal)
    {
      std::cerr << format("\rbranch and bound: %.0f s, best %.3f mrad, proven bound %.3f mrad", state.elapsedSec,
                     1e3 * state.bestErrorRad, 1e3 * state.lowerBoundRad)
                << "\033[K" << std::flush;
    }
    return !isStopAsked();
  };
  return options;
}

int runCompare(CompareArguments& arguments)
{
  if (arguments.ballRecordings.empty() && arguments.boardRecordings.empty())
  {
    throw std::invalid_argument("there is nothing to calibrate from: --ball RECORDING or --board-recording RECORDING is expected");
  }
  catchStopSignals();
  CompareInputs inputs;
  inputs.validation = arguments.validation;
  inputs.ballRecordings = arguments.ballRecordings;
  inputs.boardRecordings = arguments.boardRecordings;
  inputs.trackedBoard = arguments.trackedBoard;
  if (!arguments.boardRegistration.empty())
  {
    inputs.trackedBoard.boardToBoardMarker = readPhantomRegistration(arguments.boardRegistration);
  }
  if (!arguments.board.empty())
  {
    inputs.board = parseBoard(arguments.board);
  }
  inputs.tip_Stylus = readStylusTip(arguments.stylus);
  inputs.ballRadiusMm = arguments.ballRadiusMm;
  inputs.tools = arguments.tools;
  inputs.withPublished = arguments.withPublished;
  arguments.calibration.tipCovariance_Stylus = readStylusTipCovariance(arguments.stylus);
  const io::CameraFile file = io::readCameraFile(arguments.camera);
  arguments.output.warn(file.warnings);
  const CompareCaptures captures = readCompareCaptures(inputs, file.camera, arguments.ball, arguments.output);
  std::vector<ComparedMethod> methods = ballMethods(captures.balls, captures.camera, arguments.calibration);
  const std::vector<ComparedMethod> classical = boardMethods(captures.boards, captures.camera, boardOptions(arguments));
  methods.insert(methods.end(), classical.begin(), classical.end());
  arguments.comparison.progress = comparisonProgress();
  const ComparisonResult result = compareMethods(methods, captures.validation, captures.camera, arguments.comparison);
  if (!result.wasStopped)
  {
    sayMethods(result, arguments.output);
    arguments.output.say("verdict              " + result.message);
    if (!arguments.report.empty())
    {
      registerOffscreenRendering();
      writeComparisonReport(arguments.report, result,
        { captures.validation, captures.validationFrames, &captures.validationRecording, factsOf(arguments, captures) });
      arguments.output.say("report in            " + arguments.report + "/report.html, report.pdf");
    }
  }
  return arguments.output.finish(comparisonJson(result));
}

void addComparisonOptions(CLI::App& command, CompareArguments& arguments)
{
  addSigmaOption(command, "--sigma-mm", arguments.calibration.trackingSigmaMm, "Noise of the tracked tip, mm per axis");
  addSigmaOption(command, "--sigma-px", arguments.calibration.segmentationSigmaPx,
    "Noise of the segmented ball where the segmentation does not say, px per axis");
  command
    .add_option("--subsets", arguments.comparison.subsetRepetitions,
      "Random subsets of each size from 3 to 30 samples, for the error against the number of samples; 0 for none")
    ->check(CLI::Range(0, 10000))
    ->capture_default_str()
    ->type_name("N");
  command.add_option("--time-limit", arguments.branchAndBoundSec, "Of the branch and bound for each capture, s; 0 leaves it out")
    ->check(CLI::Range(0.0, 86400.0))
    ->capture_default_str()
    ->type_name("SEC");
  command.add_option("--seed", arguments.comparison.seed, "Of the random subsets and halves")->capture_default_str();
  command.add_flag("!--without-published", arguments.withPublished, "Leave out the paper's own segmentation and iteration");
}

}  // namespace

void addCompareCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command =
    app.add_subcommand("compare", "Every calibration method on the same captures and the same validation set, in one report");
  command->add_option("--validation", arguments->validation, "Capture that no method is fitted to: images and tracking of the ball")
    ->required()
    ->type_name("RECORDING");
  command->add_option("--stylus", arguments->stylus, "What `handeye pivot` wrote")->required()->type_name("stylus.json");
  addBallRadiusOption(*command, arguments->ballRadiusMm);
  addCameraOption(*command, arguments->camera);
  command
    ->add_option("--ball", arguments->ballRecordings,
      "Capture of the ball to calibrate from; several times for independent captures (repeatability)")
    ->type_name("RECORDING")
    ->expected(1)
    ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  CLI::Option* boards = command->add_option("--board-recording", arguments->boardRecordings,
    "Capture of a board that stands still while the tracked camera moves; several times for independent captures");
  boards->type_name("RECORDING")->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  CLI::Option* board = command->add_option(
    "--board", arguments->board, "What is on it: chessboard:COLSxROWS:SQUARE_MM, charuco:..., circles:..., acircles:...");
  board->type_name("BOARD");
  boards->needs(board);
  board->needs(boards);
  command->add_option("--report", arguments->report, "Write report.html, report.pdf and the data as CSV into this folder")
    ->type_name("DIR");
  arguments->ball.addTo(*command);
  addTransformOption(*command, "--stylus-transform", arguments->tools.stylusToTracker, "stylus");
  addTransformOption(*command, "--marker-transform", arguments->tools.markerToTracker, "camera's marker");
  CLI::Option* tracked = command->add_option("--board-transform", arguments->trackedBoard.boardToTracker,
    "Where the board is tracked, too: pose of its marker in the recording");
  tracked->type_name("NAME")->needs(boards);
  command
    ->add_option("--board-registration", arguments->boardRegistration,
      "How the board sits on its marker, as `handeye landmarks` writes it from touched corners")
    ->type_name("phantom.json")
    ->needs(tracked);
  addLatencyOption(*command, arguments->tools.latencySec);
  addComparisonOptions(*command, *arguments);
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runCompare(*arguments); });
}

}  // namespace handeye::cli
