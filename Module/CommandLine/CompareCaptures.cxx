// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CompareCaptures.h"

#include "BoardDetection.h"
#include "StopSignal.h"
#include "TimedPose.h"

#include <algorithm>
#include <stdexcept>

namespace handeye::cli
{

namespace
{

/// The command's progress, which Ctrl+C ends.
Progress stoppable(const Progress& progress)
{
  return [progress](int done, int total)
  {
    if (isStopAsked())
    {
      throw std::runtime_error("stopped");
    }
    return !progress || progress(done, total);
  };
}

io::Recording openRecording(const std::string& path, const ToolNames& tools, const CommandOutput& output)
{
  io::Recording recording = io::Recording::open(path);
  output.warn(recording.warnings());
  output.warn(latencyNotes(recording, tools.latencySec));
  return recording;
}

std::vector<CapturedFrame> findBall(const CompareInputs& inputs, const io::Recording& recording, const CameraModel& camera,
  const BallDetectionOptions& options, const CommandOutput& output, const std::string& label)
{
  return readCapture(recording, inputs.tools, camera, inputs.tip_Stylus, inputs.ballRadiusMm, options,
    stoppable(output.progress("looking for the ball, " + label + ", frame")));
}

/// The frames in which the board is found and the camera's marker is tracked.
std::vector<BoardHandEyeView> findBoard(const CompareInputs& inputs, const io::Recording& recording, const Progress& progress)
{
  recording.requireTransform(inputs.tools.markerToTracker);
  const std::vector<std::string>& names = recording.transformNames();
  const bool isTracked = std::find(names.begin(), names.end(), inputs.boardToTracker) != names.end();
  std::vector<BoardHandEyeView> views;
  for (int frame = 0; frame < recording.frameCount(); ++frame)
  {
    const io::TransformSample marker = poseOfFrame(recording, frame, inputs.tools.markerToTracker, inputs.tools.latencySec);
    if (recording.hasImage(frame) && marker.isUsable())
    {
      const BoardDetection found = detectBoard(recording.image(frame), *inputs.board);
      if (found.isUsable())
      {
        BoardHandEyeView view;
        view.frame = frame;
        view.markerToTracker = marker.transform;
        view.ids = found.ids;
        view.points_Board = found.points_Board;
        view.points_Image = found.points_Image;
        if (isTracked)
        {
          const io::TransformSample board = poseOfFrame(recording, frame, inputs.boardToTracker, inputs.tools.latencySec);
          view.boardToTracker = board.isUsable() ? std::make_optional(board.transform) : std::nullopt;
        }
        views.push_back(std::move(view));
      }
    }
    progress(frame + 1, recording.frameCount());
  }
  return views;
}

void readBoards(const CompareInputs& inputs, const CommandOutput& output, CompareCaptures& captures)
{
  for (const std::string& path : inputs.boardRecordings)
  {
    const io::Recording recording = openRecording(path, inputs.tools, output);
    (void)cameraForRecording(captures.camera, recording);
    std::vector<BoardHandEyeView> views =
      findBoard(inputs, recording, stoppable(output.progress("looking for the board, " + path + ", frame")));
    std::string note;
    if (inputs.board->looksTheSameTurned())
    {
      const std::optional<int> turned = resolveHalfTurns(views, *inputs.board, captures.camera);
      note = turned ? ", " + std::to_string(*turned) + " of them numbered from the other end" : ", whose ends cannot be told apart";
    }
    captures.facts.push_back("Board: " + path + ", " + toString(*inputs.board) + ", found and tracked in " +
      std::to_string(views.size()) + " of " + std::to_string(recording.frameCount()) + " frames" + note + ".");
    captures.boards.push_back(std::move(views));
  }
}

}  // namespace

CompareCaptures readCompareCaptures(
  const CompareInputs& inputs, const CameraModel& camera, const BallOptions& ball, const CommandOutput& output)
{
  io::Recording validation = openRecording(inputs.validation, inputs.tools, output);
  const CameraModel sized = cameraForRecording(camera, validation);
  std::vector<CapturedFrame> frames =
    findBall(inputs, validation, sized, ball.forRecording(validation, output), output, "validation");
  std::vector<HandEyeSample> samples = toSamples(frames);
  CompareCaptures captures{ sized, std::move(validation), std::move(frames), std::move(samples), {}, {}, {} };
  for (const std::string& path : inputs.ballRecordings)
  {
    const io::Recording recording = openRecording(path, inputs.tools, output);
    BallDetectionOptions options = ball.forRecording(recording, output);
    BallCapture capture;
    capture.samples = toSamples(findBall(inputs, recording, sized, options, output, path));
    if (inputs.withPublished)
    {
      options.method = BallDetectionOptions::Method::Hough;
      capture.publishedSamples = toSamples(findBall(inputs, recording, sized, options, output, path + " (Hough)"));
    }
    captures.facts.push_back("Ball: " + path + ", " + std::to_string(capture.samples.size()) + " samples in " +
      std::to_string(recording.frameCount()) + " frames" +
      (inputs.withPublished ? ", " + std::to_string(capture.publishedSamples.size()) + " by the paper's segmentation." : "."));
    captures.balls.push_back(std::move(capture));
  }
  readBoards(inputs, output, captures);
  return captures;
}

}  // namespace handeye::cli
