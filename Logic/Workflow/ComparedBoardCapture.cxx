// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComparedBoardCapture.h"

namespace handeye
{

ComparedBoardCapture readComparedBoard(const io::Recording& recording, const BoardDescription& board, const CameraModel& camera,
  const ToolNames& tools, const TrackedBoardNames& trackedBoard, const Progress& progress)
{
  const CameraModel sized = cameraForRecording(camera, recording);
  std::vector<BoardFrame> frames = readBoardFrames(recording, board, {}, progress);
  ComparedBoardCapture capture;
  capture.views = boardHandEyeViews(recording, tools, trackedBoard, frames);
  const std::string left = countStatuses(frames);
  std::string note;
  if (board.looksTheSameTurned())
  {
    const std::optional<int> turned = resolveHalfTurns(capture.views, board, sized);
    note = turned ? ", " + std::to_string(*turned) + " of them numbered from the other end" : ", whose ends cannot be told apart";
  }
  capture.fact = "Board: " + recording.path().string() + ", " + toString(board) + ", found and tracked in " +
    std::to_string(capture.views.size()) + " of " + std::to_string(recording.frameCount()) + " frames" + note +
    (left.empty() ? "" : "; the others: " + left) + ".";
  return capture;
}

}  // namespace handeye
