// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardOptions.h"
#include "BoardResultFiles.h"
#include "CameraFile.h"
#include "CommandOutput.h"
#include "Commands.h"
#include "CommonOptions.h"
#include "ResultFiles.h"
#include "TimedPose.h"

#include <unistd.h>

#include <iostream>
#include <memory>

namespace handeye::cli
{

namespace
{

using Method = BoardHandEyeOptions::Method;

struct BoardHandEyeArguments
{
  std::string recording, board, camera, stylus, boardRegistration;
  std::string method = toString(Method::Daniilidis);
  double ballRadiusMm = 0;
  TrackedBoardNames trackedBoard;
  ToolNames tools;
  BoardHandEyeOptions options;
  CommandOutput output;
};

std::vector<std::string> methodNames()
{
  std::vector<std::string> names;
  for (const Method method : { Method::Tsai, Method::Park, Method::Horaud, Method::Daniilidis, Method::BranchAndBound,
         Method::TrackedBoard, Method::TrackedBoardLines })
  {
    names.push_back(toString(method));
  }
  return names;
}

Method methodOf(const std::string& name)
{
  const std::vector<std::string> names = methodNames();
  return Method(std::find(names.begin(), names.end(), name) - names.begin());  // in the order of the enumeration
}

/// How far the search is, on a terminal.
BranchAndBoundProgress searchProgress()
{
  const bool isTerminal = isatty(STDERR_FILENO) != 0;
  return [isTerminal](const BranchAndBoundState& state)
  {
    if (isTerminal)
    {
      std::cerr << '\r'
                << format("%.0f s: largest epipolar error %.3f mrad, at least %.3f mrad proven   ", state.elapsedSec,
                     1000 * state.bestErrorRad, 1000 * state.lowerBoundRad)
                << std::flush;
    }
    return true;
  };
}

void say(const BoardCalibration& calibration, const CommandOutput& output)
{
  const BoardHandEyeResult& result = calibration.result;
  const std::string statuses = countStatuses(calibration.frames);
  output.say("views                " + std::to_string(result.usedCount) + " of " + std::to_string(calibration.frames.size()) +
    " frames" + (statuses.empty() ? "" : " (not used: " + statuses + ")"));
  if (!result.isUsable())
  {
    return;
  }
  output.say("markerToCamera (mm)\n" + matrixLines(result.markerToCamera.matrix(), "  ", 4));
  output.say("boardToTracker (mm)\n" + matrixLines(result.boardToTracker.matrix(), "  ", 4));
  output.say(format("fitted views         %.2f px, %.2f mm, %.3f degrees RMS (validate on other captures)",
    result.reprojectionRmsPx, result.rmsMm, result.rmsRad * 180 / EIGEN_PI));
  output.say("verdict              " + result.message);
  if (!calibration.tip_Stylus || !calibration.ballRadiusMm)
  {
    output.say("note                 `handeye validate` needs the ball: give --stylus and --ball-radius for it");
  }
}

int runBoardHandEye(BoardHandEyeArguments& arguments)
{
  const BoardDescription board = parseBoard(arguments.board);
  const io::CameraFile file = io::readCameraFile(arguments.camera);
  const io::Recording recording = io::Recording::open(arguments.recording);
  arguments.output.warn(file.warnings);
  arguments.output.warn(recording.warnings());
  arguments.output.warn(latencyNotes(recording, arguments.tools.latencySec));
  recording.requireTransform(arguments.tools.markerToTracker);
  if (!arguments.boardRegistration.empty())
  {
    arguments.trackedBoard.boardToBoardMarker = readPhantomRegistration(arguments.boardRegistration);
  }
  BoardCalibration calibration{ {}, methodOf(arguments.method), board, cameraForRecording(file.camera, recording), {}, {},
    arguments.tools, {}, {} };
  if (!arguments.stylus.empty())
  {
    calibration.tip_Stylus = readStylusTip(arguments.stylus);
  }
  calibration.ballRadiusMm = arguments.ballRadiusMm > 0 ? std::optional(arguments.ballRadiusMm) : std::nullopt;
  calibration.frames = readBoardFrames(recording, board, {}, arguments.output.progress("looking for the board, frame"));
  std::vector<BoardHandEyeView> views = boardHandEyeViews(recording, arguments.tools, arguments.trackedBoard, calibration.frames);
  if (board.looksTheSameTurned())
  {
    const std::optional<int> turned = resolveHalfTurns(views, board, calibration.camera);
    arguments.output.warn({ turned
        ? "this board looks the same upside down; the tracker says that it was in " + std::to_string(*turned) + " views"
        : std::string("this board looks the same upside down, and the tracker does not say in which views: use a ChArUco board") });
  }
  for (const BoardHandEyeView& view : views)
  {
    calibration.viewFrames.push_back(view.frame);
  }
  arguments.options.method = calibration.method;
  calibration.result = calibrateBoardHandEye(views, calibration.camera, arguments.options, searchProgress());
  say(calibration, arguments.output);
  return arguments.output.finish(boardCalibrationJson(calibration));
}

}  // namespace

void addBoardHandEyeCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<BoardHandEyeArguments>();
  CLI::App* command = app.add_subcommand(
    "board-hand-eye", "Find markerToCamera the classical way: from a board that stands still, or that is tracked, too");
  addRecordingArgument(*command, arguments->recording, "Images of the board and tracking of the camera's marker");
  addBoardOption(*command, arguments->board);
  addCameraOption(*command, arguments->camera);
  std::string words;
  for (const std::string& name : methodNames())
  {
    words += (words.empty() ? "" : "|") + name;
  }
  command->add_option("--method", arguments->method, "How the motions are brought together")
    ->check(CLI::IsMember(methodNames()))
    ->type_name(words)
    ->capture_default_str();
  addTransformOption(*command, "--marker-transform", arguments->tools.markerToTracker, "camera's marker");
  addLatencyOption(*command, arguments->tools.latencySec);
  CLI::Option* tracked = command->add_option(
    "--board-transform", arguments->trackedBoard.boardToTracker, "tracked-board: pose of the board's marker in the recording");
  tracked->type_name("NAME");
  command
    ->add_option("--board-registration", arguments->boardRegistration,
      "tracked-board: how the board sits on its marker, as `handeye landmarks` writes it from touched corners")
    ->type_name("phantom.json")
    ->needs(tracked);
  command
    ->add_option(
      "--time-limit", arguments->options.timeLimitSec, "branch-and-bound: after so many seconds the best so far is taken")
    ->check(CLI::Range(0.1, 1e6))
    ->type_name("SEC")
    ->capture_default_str();
  command
    ->add_option("--gap", arguments->options.gapRad, "branch-and-bound: proven to so many radians of the largest epipolar error")
    ->check(CLI::Range(1e-9, 1.0))
    ->type_name("RAD")
    ->capture_default_str();
  command->add_option("--stylus", arguments->stylus, "What `handeye pivot` wrote, passed on for `handeye validate`")
    ->type_name("stylus.json");
  command->add_option("--ball-radius", arguments->ballRadiusMm, "Radius of the ball, mm, passed on for `handeye validate`")
    ->check(CLI::PositiveNumber)
    ->type_name("MM");
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runBoardHandEye(*arguments); });
}

}  // namespace handeye::cli
