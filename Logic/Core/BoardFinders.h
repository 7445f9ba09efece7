// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardDetection.h"

#include <opencv2/core.hpp>

#include <functional>
#include <vector>

namespace handeye
{

/// The finders of detectBoard(), each for one kind of board; they fill status, message, ids and points_Image. Internal.
void findChessboard(const cv::Mat& grey8, const BoardDescription& board, BoardDetection& detection);
void findCharuco(const cv::Mat& grey8, const BoardDescription& board, int minimumPoints, BoardDetection& detection);
void findCircleGrid(const cv::Mat& grey8, const BoardDescription& board, BoardDetection& detection);

/// The least-squares homography; empty where there is none.
cv::Mat fitHomography(const std::vector<cv::Point2f>& from, const std::vector<cv::Point2f>& to);

/// The points of a complete grid in our numbering, whatever the corner a finder began at: right-handed, lying as the board says.
/// @param isColourRight says of a numbering whether black squares are where they should be; may be empty
std::vector<Eigen::Vector2d> numberGrid(const std::vector<Eigen::Vector2d>& found, const BoardDescription& board,
  const std::function<bool(const std::vector<Eigen::Vector2d>&)>& isColourRight);

}  // namespace handeye
