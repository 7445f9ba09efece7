// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardHandEye.h"
#include "EpipolarSearch.h"
#include "HandEyeMotions.h"

#include <vector>

namespace handeye
{

/// What the solvers of calibrateBoardHandEye() share. Internal.

/// @throws std::invalid_argument, naming the view, where sizes differ or a number is not finite
void checkViews(const std::vector<BoardHandEyeView>& views);

/// The poses of the board, given or found; what is not usable says why.
std::vector<BoardHandEyeResult::View> posesOf(const std::vector<BoardHandEyeView>& views, const CameraModel& camera);

/// Where the board stands, on average over the views that are used.
Eigen::Isometry3d averageBoardToTracker(const std::vector<BoardHandEyeView>& views,
  const std::vector<BoardHandEyeResult::View>& found, const Eigen::Isometry3d& markerToCamera);

/// Fills the residuals of the views and of the result from markerToCamera and boardToTracker (or the views' own, if tracked).
void addResiduals(
  const std::vector<BoardHandEyeView>& views, const CameraModel& camera, bool isBoardTracked, BoardHandEyeResult& result);

/// Corresponding rays of the points that the views of a motion share, spread over the board.
/// @param used the views that the motions' indices count
std::vector<EpipolarPair> epipolarPairs(const std::vector<HandEyeMotion>& motions, const std::vector<const BoardHandEyeView*>& used,
  const CameraModel& camera, int pointsPerPair);

}  // namespace handeye
