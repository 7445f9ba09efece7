// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComparedBoardMethods.h"

#include "GeometryMatchers.h"
#include "Simulation.h"
#include "TestCameras.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace handeye;
using namespace handeye::test;

namespace
{

const CameraModel Camera = makeCamera(640, 480, 600, 602, 322, 238, { -0.1, 0.03, 0.0004, -0.0003 });

/// Views of a board that stands still, without noise; `boardToTracker` says whether the board is tracked, too.
std::vector<BoardHandEyeView> makeViews(int count, bool isTracked, bool turns, unsigned seed = 3)
{
  BoardDescription board;
  board.spacingMm = 20;
  Random random(seed);
  const Eigen::Isometry3d boardToTracker = random.rigid(300);
  std::vector<BoardHandEyeView> views;
  for (int i = 0; i < count; ++i)
  {
    const Eigen::Vector3d turn = turns
      ? Eigen::Vector3d(random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6), random.uniform(-0.8, 0.8))
      : Eigen::Vector3d(0, 0, 0.1 * i);
    Eigen::Isometry3d boardToCamera = makeRigid(turn, { -80, -50, random.uniform(380, 500) });
    boardToCamera.translation() =
      Eigen::Vector3d(0, 0, boardToCamera.translation().z()) - boardToCamera.linear() * boardCenter(board);
    BoardHandEyeView view;
    view.frame = i;
    const Eigen::Isometry3d boardToMarker = typicalMarkerToCamera().inverse() * boardToCamera;
    view.markerToTracker = boardToTracker * boardToMarker.inverse();
    view.points_Board = boardPoints(board);
    for (std::size_t k = 0; k < view.points_Board.size(); ++k)
    {
      view.ids.push_back(int(k));
      view.points_Image.push_back(Camera.project(boardToCamera * view.points_Board[k]).point_Image);
    }
    if (isTracked)
    {
      view.boardToTracker = boardToTracker;
    }
    views.push_back(view);
  }
  return views;
}

BoardMethodsOptions quick()
{
  BoardMethodsOptions options;
  options.options.timeLimitSec = 3;
  return options;
}

}  // namespace

TEST(ComparedBoardMethods, NoiseFree_AllRecoverTheTruth)
{
  const std::vector<ComparedMethod> methods = boardMethods({ makeViews(10, true, true) }, Camera, quick());
  ASSERT_EQ(methods.size(), 7U);
  for (const ComparedMethod& method : methods)
  {
    const MethodAnswer answer = method.calibrate(0);
    ASSERT_TRUE(answer.isUsable()) << method.name << ": " << answer.message;
    EXPECT_EQ(answer.sampleCount, 10);
    const bool isSearch = method.name == "branch-and-bound";
    EXPECT_EQ(answer.gap.has_value(), isSearch) << method.name;
    // The search ends when the largest angle is within its gap of the least one, which fixes the position less well.
    EXPECT_TRUE(rigid3dNear(*answer.markerToCamera, typicalMarkerToCamera(), isSearch ? 0.02 : 1e-5, isSearch ? 10 : 1e-3))
      << method.name;
    EXPECT_EQ(method.calibrateSome != nullptr, !isSearch) << "minutes, not seconds: " << method.name;
  }
}

TEST(ComparedBoardMethods, BoardWithoutMarker_HasNoTrackedRows)
{
  EXPECT_EQ(boardMethods({ makeViews(6, false, true) }, Camera, quick()).size(), 5U);
  BoardMethodsOptions options = quick();
  options.withBranchAndBound = false;
  EXPECT_EQ(boardMethods({ makeViews(6, false, true) }, Camera, options).size(), 4U);
  EXPECT_TRUE(boardMethods({}, Camera).empty());
}

TEST(ComparedBoardMethods, ParallelMotions_AreRefusedInWords)
{
  for (const ComparedMethod& method : boardMethods({ makeViews(8, false, false) }, Camera, quick()))
  {
    const MethodAnswer answer = method.calibrate(0);
    EXPECT_FALSE(answer.isUsable()) << method.name;
    EXPECT_EQ(answer.status, "parallel_motions") << method.name << ": " << answer.message;
    EXPECT_FALSE(answer.message.empty());
  }
}

TEST(ComparedBoardMethods, Subsets_AreOfTheViewsAskedFor)
{
  const std::vector<ComparedMethod> methods = boardMethods({ makeViews(10, false, true) }, Camera, quick());
  const MethodAnswer few = methods[1].calibrateSome({ 0, 4 });
  EXPECT_EQ(few.status, "too_few_views");
  const MethodAnswer some = methods[1].calibrateSome({ 0, 4, 7, 9 });
  EXPECT_EQ(some.sampleCount, 4);
  EXPECT_TRUE(some.isUsable()) << some.message;
}
