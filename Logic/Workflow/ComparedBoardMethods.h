// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardHandEye.h"
#include "MethodComparison.h"

#include <vector>

namespace handeye
{

struct BoardMethodsOptions
{
  /// Of the classical methods; `method` is each one's own. The time limit of the branch and bound is here.
  BoardHandEyeOptions options;
  /// Told how far the branch and bound is; false ends it with the best so far.
  BranchAndBoundProgress progress;
  bool withBranchAndBound = true;
};

/// The methods that calibrate with a board: `tsai`, `park`, `horaud`, `daniilidis`, `branch-and-bound` from a board that stands
/// still; `tracked-board` and `tracked-board-lines` where a capture's views say where the tracker sees the board.
///
/// @param captures the views of independent captures; views in which the board was not found are not among them
[[nodiscard]] std::vector<ComparedMethod> boardMethods(
  const std::vector<std::vector<BoardHandEyeView>>& captures, const CameraModel& camera, const BoardMethodsOptions& options = {});

}  // namespace handeye
