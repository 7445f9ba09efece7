// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardCapture.h"

#include <string>
#include <vector>

namespace handeye
{

/// A capture of a board as the methods of a comparison take it.
struct ComparedBoardCapture
{
  std::vector<BoardHandEyeView> views;
  std::string fact;  ///< a sentence: which recording, which board, in how many frames it was found, why not in the others
};

/// Finds the board in a recording. One that looks the same after half a turn is given the numbering that agrees with the tracker.
///
/// @param camera of the recording's size, or of none
/// @return views of fewer frames where `progress` stopped it
/// @throws io::FileError as readBoardFrames() and boardHandEyeViews(); std::invalid_argument where the pictures are not of the
///         camera's size
[[nodiscard]] ComparedBoardCapture readComparedBoard(const io::Recording& recording, const BoardDescription& board,
  const CameraModel& camera, const ToolNames& tools, const TrackedBoardNames& trackedBoard = {}, const Progress& progress = {});

}  // namespace handeye
