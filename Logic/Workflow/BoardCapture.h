// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardDetection.h"
#include "BoardHandEye.h"
#include "Capture.h"
#include "LensViewCollector.h"
#include "Recording.h"

#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

namespace handeye
{

/// One frame of a recording of a board.
struct BoardFrame
{
  int frame = 0;
  std::string status;  ///< "ok", a status of BoardDetection, "image_missing", or what became of it later
  std::string message;
  BoardDetection detection;  ///< meaningful where the status is "ok"
};

/// Looks for the board in every picture.
/// @return as many frames as there are, or fewer if `progress` stopped it
/// @throws io::FileError where the recording has no images or one cannot be read
std::vector<BoardFrame> readBoardFrames(const io::Recording& recording, const BoardDescription& board,
  const BoardDetectionOptions& options = {}, const Progress& progress = {});

/// "3 not_found, 2 blurred", or nothing where all are "ok".
std::string countStatuses(const std::vector<BoardFrame>& frames);

/// The views for the lens among the frames, in their order: those that the collector takes, or all that show the board.
/// Frames that are not taken have the collector's verdict as their status.
/// @param collector empty for all
std::vector<LensView> selectLensViews(std::vector<BoardFrame>& frames, LensViewCollector* collector);

/// Where the tracker sees the board, for the tracked-board methods.
struct TrackedBoardNames
{
  std::string boardToTracker;  ///< name in the recording of the board's marker; empty: the board is not tracked
  /// p_BoardMarker = boardToBoardMarker * p_Board; how the board sits on its marker, from landmarks touched on it
  Eigen::Isometry3d boardToBoardMarker = Eigen::Isometry3d::Identity();
};

/// The views for calibrateBoardHandEye(): frames with the board seen and the marker tracked. Others get their status.
/// @throws io::FileError, listing the transforms that there are, where a tool is not in the recording
std::vector<BoardHandEyeView> boardHandEyeViews(
  const io::Recording& recording, const ToolNames& tools, const TrackedBoardNames& trackedBoard, std::vector<BoardFrame>& frames);

}  // namespace handeye
