// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CompareCaptures.h"

#include "ComparedBoardCapture.h"
#include "DistinctCaptures.h"
#include "StopSignal.h"
#include "TimedPose.h"

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

void readBoards(const CompareInputs& inputs, const CommandOutput& output, CompareCaptures& captures)
{
  for (const std::string& path : inputs.boardRecordings)
  {
    const io::Recording recording = openRecording(path, inputs.tools, output);
    ComparedBoardCapture board = readComparedBoard(recording, *inputs.board, captures.camera, inputs.tools, inputs.trackedBoard,
      stoppable(output.progress("looking for the board, " + path + ", frame")));
    captures.facts.push_back(board.fact);
    captures.boards.push_back(std::move(board.views));
  }
}

}  // namespace

CompareCaptures readCompareCaptures(
  const CompareInputs& inputs, const CameraModel& camera, const BallOptions& ball, const CommandOutput& output)
{
  DistinctCaptures distinct;
  distinct.addPath(inputs.validation, "the validation set");
  for (const std::string& path : inputs.ballRecordings)
  {
    distinct.addPath(path, "a capture of the ball");
  }
  io::Recording validation = openRecording(inputs.validation, inputs.tools, output);
  const CameraModel sized = cameraForRecording(camera, validation);
  std::vector<CapturedFrame> frames =
    findBall(inputs, validation, sized, ball.forRecording(validation, output), output, "validation");
  std::vector<HandEyeSample> samples = toSamples(frames);
  distinct.addSamples(inputs.validation, samples);
  CompareCaptures captures{ sized, std::move(validation), std::move(frames), std::move(samples), {}, {}, {} };
  for (const std::string& path : inputs.ballRecordings)
  {
    const io::Recording recording = openRecording(path, inputs.tools, output);
    BallDetectionOptions options = ball.forRecording(recording, output);
    BallCapture capture;
    capture.samples = toSamples(findBall(inputs, recording, sized, options, output, path));
    distinct.addSamples(path, capture.samples);
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
