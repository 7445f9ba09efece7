// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardHandEye.h"
#include "BoardHandEyeViews.h"
#include "BoardPose.h"
#include "RigidTransform.h"

namespace handeye
{

namespace
{

/// The number that a point has when the board is turned by so many quarters.
int turnedId(const BoardDescription& board, int id, int quarters)
{
  const int columns = board.pointColumns(), count = board.pointCount();
  const int column = id % columns, row = id / columns;
  switch (quarters)
  {
    case 1:
      return column * columns + columns - 1 - row;
    case 2:
      return count - 1 - id;
    case 3:
      return (columns - 1 - column) * columns + row;
    default:
      return id;
  }
}

BoardHandEyeView turned(const BoardHandEyeView& view, const BoardDescription& board, int quarters)
{
  BoardHandEyeView result = view;
  for (std::size_t i = 0; i < view.ids.size(); ++i)
  {
    result.ids[i] = turnedId(board, view.ids[i], quarters);
    result.points_Board[i] = boardPoint(board, result.ids[i]);
  }
  return result;
}

}  // namespace

std::optional<int> resolveHalfTurns(std::vector<BoardHandEyeView>& views, const BoardDescription& board, const CameraModel& camera)
{
  board.check();
  checkViews(views);
  // A camera's motion and its marker's turn by the same angle; each view is compared with all that are settled.
  constexpr double LeastDifferenceRad = 0.05;
  const bool isSquare = board.pointColumns() == board.pointRows() && board.kind != BoardDescription::Kind::AsymmetricCircles;
  std::vector<HandEyePoses> settled;
  int turnedCount = 0;
  for (BoardHandEyeView& view : views)
  {
    const BoardHandEyeView original = view;
    double least = std::numeric_limits<double>::infinity(), second = least;
    int best = 0;
    HandEyePoses bestPoses;
    for (int quarters = 0; quarters < 4; quarters += isSquare ? 1 : 2)
    {
      const BoardHandEyeView candidate = turned(original, board, quarters);
      const BoardPose pose = estimateBoardPose(candidate.points_Board, candidate.points_Image, camera);
      if (!pose.isUsable())
      {
        break;
      }
      double sum = 0;
      for (const HandEyePoses& other : settled)
      {
        const Eigen::Matrix3d byCamera = pose.boardToCamera.linear() * other.boardToCamera.linear().transpose();
        const Eigen::Matrix3d byMarker = view.markerToTracker.linear().transpose() * other.markerToTracker.linear();
        sum += std::abs(rotationAngle(byCamera) - rotationAngle(byMarker)) / double(settled.size());
      }
      if (sum < least)
      {
        second = least;
        least = sum;
        best = quarters;
        bestPoses = { view.markerToTracker, pose.boardToCamera };
      }
      else
      {
        second = std::min(second, sum);
      }
      if (settled.empty())
      {
        break;
      }
    }
    if (!std::isfinite(least))
    {
      continue;  // no pose: not used later either
    }
    if (!settled.empty() && second - least < LeastDifferenceRad)
    {
      return std::nullopt;
    }
    view = turned(original, board, best);
    view.boardToCamera = original.boardToCamera ? std::optional(bestPoses.boardToCamera) : std::nullopt;
    settled.push_back(bestPoses);
    turnedCount += best == 0 ? 0 : 1;
  }
  return turnedCount;
}

}  // namespace handeye
