// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardCapture.h"

#include "FileError.h"
#include "TimedPose.h"

#include <map>

namespace handeye
{

namespace
{

BoardFrame readFrame(const io::Recording& recording, int frame, const BoardDescription& board, const BoardDetectionOptions& options)
{
  BoardFrame read;
  read.frame = frame;
  if (!recording.hasImage(frame))
  {
    read.status = "image_missing";
    read.message = "the frame has no image";
    return read;
  }
  read.detection = detectBoard(recording.image(frame), board, options);
  read.status = toString(read.detection.status);
  read.message = read.detection.message;
  return read;
}

void giveUp(BoardFrame& frame, const char* tool, const io::TransformSample& sample)
{
  frame.status = std::string(tool) + (sample.status == io::TransformSample::Status::Missing ? "_missing" : "_invalid");
  frame.message = sample.reason;
}

}  // namespace

std::vector<BoardFrame> readBoardFrames(
  const io::Recording& recording, const BoardDescription& board, const BoardDetectionOptions& options, const Progress& progress)
{
  if (!recording.hasImages())
  {
    throw io::FileError(recording.path(), "the recording has no images, which this step needs");
  }
  std::vector<BoardFrame> frames;
  for (int frame = 0; frame < recording.frameCount(); ++frame)
  {
    frames.push_back(readFrame(recording, frame, board, options));
    if (progress && !progress(frame + 1, recording.frameCount()))
    {
      break;
    }
  }
  return frames;
}

std::string countStatuses(const std::vector<BoardFrame>& frames)
{
  std::map<std::string, int> counts;
  for (const BoardFrame& frame : frames)
  {
    counts[frame.status] += frame.status == "ok" ? 0 : 1;
  }
  std::string text;
  for (const auto& [status, count] : counts)
  {
    text += count == 0 ? std::string() : (text.empty() ? "" : ", ") + std::to_string(count) + " " + status;
  }
  return text;
}

std::vector<LensView> selectLensViews(std::vector<BoardFrame>& frames, LensViewCollector* collector)
{
  std::vector<LensView> views;
  for (BoardFrame& frame : frames)
  {
    if (collector == nullptr)
    {
      if (frame.status == "ok")
      {
        views.push_back(toLensView(frame.frame, frame.detection));
      }
      continue;
    }
    const LensViewVerdict verdict = collector->add(frame.frame, frame.detection);
    if (frame.status == "ok" && !verdict.isTaken())
    {
      frame.status = toString(verdict.status);
      frame.message = verdict.status == LensViewVerdict::Status::NotNew ? "much like a view that was taken" : verdict.message;
    }
  }
  return collector == nullptr ? views : collector->views();
}

std::vector<BoardHandEyeView> boardHandEyeViews(
  const io::Recording& recording, const ToolNames& tools, const TrackedBoardNames& trackedBoard, std::vector<BoardFrame>& frames)
{
  recording.requireTransform(tools.markerToTracker);
  if (!trackedBoard.boardToTracker.empty())
  {
    recording.requireTransform(trackedBoard.boardToTracker);
  }
  std::vector<BoardHandEyeView> views;
  for (BoardFrame& frame : frames)
  {
    if (frame.status != "ok")
    {
      continue;
    }
    const io::TransformSample marker = poseOfFrame(recording, frame.frame, tools.markerToTracker, tools.latencySec);
    if (!marker.isUsable())
    {
      giveUp(frame, "marker", marker);
      continue;
    }
    BoardHandEyeView view;
    view.frame = frame.frame;
    view.markerToTracker = marker.transform;
    view.ids = frame.detection.ids;
    view.points_Board = frame.detection.points_Board;
    view.points_Image = frame.detection.points_Image;
    if (!trackedBoard.boardToTracker.empty())
    {
      const io::TransformSample board = poseOfFrame(recording, frame.frame, trackedBoard.boardToTracker, tools.latencySec);
      if (!board.isUsable())
      {
        giveUp(frame, "board", board);
        continue;
      }
      view.boardToTracker = board.transform * trackedBoard.boardToBoardMarker;
    }
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace handeye
