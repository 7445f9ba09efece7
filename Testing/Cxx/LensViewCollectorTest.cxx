// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LensViewCollector.h"

#include "BoardSimulation.h"
#include "GeometryMatchers.h"
#include "TestCameras.h"

#include <gtest/gtest.h>

namespace
{

using namespace handeye;
using namespace handeye::test;
using Status = LensViewVerdict::Status;

const BoardDescription Board = parseBoard("chessboard:9x6:20");

BoardDetection seen(const Eigen::Isometry3d& boardToCamera, double edgeWidthPx = 2)
{
  Random random(1);
  const LensView view = seenBoard(0, Board, pinhole(), boardToCamera, 0, random);
  BoardDetection detection;
  detection.status = BoardDetection::Status::Ok;
  detection.ids = view.ids;
  detection.points_Board = view.points_Board;
  detection.points_Image = view.points_Image;
  detection.edgeWidthPx = edgeWidthPx;
  return detection;
}

Eigen::Isometry3d at(const Eigen::Vector3d& middle_Camera, const Eigen::Vector3d& tilt)
{
  Eigen::Isometry3d boardToCamera = Eigen::Isometry3d::Identity();
  boardToCamera.linear() = rotationFromVector(tilt);
  boardToCamera.translation() = middle_Camera - boardToCamera.linear() * boardCenter(Board);
  return boardToCamera;
}

const Eigen::Isometry3d Middle = at({ 0, 0, 400 }, { 0, 0, 0 });

}  // namespace

TEST(LensViewCollector, AStillBoard_IsTakenOnce)
{
  LensViewCollector collector(640, 480);
  EXPECT_EQ(collector.add(0, seen(Middle)).status, Status::Moving);
  EXPECT_EQ(collector.add(1, seen(Middle)).status, Status::Moving);
  EXPECT_EQ(collector.add(2, seen(Middle)).status, Status::Taken);
  EXPECT_EQ(collector.add(3, seen(Middle)).status, Status::NotNew);
  ASSERT_EQ(collector.views().size(), 1U);
  EXPECT_EQ(collector.views()[0].frame, 2);
}

TEST(LensViewCollector, MovingAndBlurredBoards_AreNotTaken)
{
  LensViewCollector collector(640, 480);
  for (int i = 0; i < 20; ++i)
  {
    EXPECT_EQ(collector.add(i, seen(at({ 3.0 * i, 0, 400 }, { 0, 0, 0 }))).status, Status::Moving) << "5 px a picture";
  }
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_NE(collector.add(i, seen(Middle, 8)).status, Status::Taken);
  }
  EXPECT_EQ(collector.add(7, seen(Middle, 8)).status, Status::Blurred);
  EXPECT_EQ(collector.add(8, BoardDetection()).status, Status::NoBoard);
  EXPECT_EQ(collector.add(9, seen(Middle)).status, Status::Moving) << "stillness begins anew";
  EXPECT_TRUE(collector.views().empty());
}

TEST(LensViewCollector, AnotherPlaceOrTilt_IsNew)
{
  LensViewCollectorOptions options;
  options.stillFrames = 1;
  LensViewCollector collector(640, 480, options);
  EXPECT_TRUE(collector.add(0, seen(Middle)).isTaken());
  EXPECT_EQ(collector.add(1, seen(at({ 10, 0, 400 }, { 0, 0, 0 }))).status, Status::NotNew);
  EXPECT_TRUE(collector.add(2, seen(at({ 60, 0, 400 }, { 0, 0, 0 }))).isTaken());
  EXPECT_TRUE(collector.add(3, seen(at({ 0, 0, 400 }, { 0.4, 0, 0 }))).isTaken());
  EXPECT_EQ(collector.add(4, seen(at({ 0, 0, 400 }, { 0.45, 0, 0 }))).status, Status::NotNew);
}

/// x runs to the right and y down: turned about y by a positive angle, the board's right side comes nearer.
TEST(LensViewCollector, Tilts_AreTheSidesThatAreNearer)
{
  LensViewCollectorOptions options;
  options.stillFrames = 1;
  LensViewCollector collector(640, 480, options);
  const Eigen::Isometry3d turned = at({ 0, 0, 400 }, { 0, 0.4, 0 });
  EXPECT_LT((turned * boardPoint(Board, 8)).z(), (turned * boardPoint(Board, 0)).z()) << "the right side is the nearer one";
  collector.add(0, seen(turned));
  EXPECT_EQ(collector.tilts().right, 1);
  EXPECT_EQ(collector.tilts().left, 0);
  collector.add(1, seen(at({ 0, 0, 400 }, { 0.4, 0, 0 })));  // about x: what is below goes away
  EXPECT_EQ(collector.tilts().top, 1);
  EXPECT_EQ(collector.tilts().bottom, 0);
  collector.add(2, seen(Middle));
  EXPECT_EQ(collector.tilts().square, 1);
}

/// Whoever does what the hints say is done soon; the map says where points were seen, and what is taken back is gone.
TEST(LensViewCollector, FollowingTheHints_Completes)
{
  LensViewCollectorOptions options;
  options.stillFrames = 1;
  LensViewCollector collector(640, 480, options);
  EXPECT_TRUE(says(collector.hint(), { "Show the board" }));
  Random random(2);
  const std::pair<const char*, Eigen::Vector3d> tilts[] = { { "left side", { 0, -0.5, 0 } }, { "right side", { 0, 0.5, 0 } },
    { "upper side", { 0.5, 0, 0 } }, { "lower side", { -0.5, 0, 0 } } };
  const std::pair<const char*, Eigen::Vector2d> places[] = { { "left", { -1, 0 } }, { "right", { 1, 0 } }, { "upper", { 0, -1 } },
    { "lower", { 0, 1 } } };
  int pictures = 0;
  for (; pictures < 120 && !collector.isComplete(); ++pictures)
  {
    const std::string hint = collector.hint();
    Eigen::Vector3d tilt = random.uniform3(0.3), middle(random.uniform(-30, 30), random.uniform(-20, 20), random.uniform(360, 420));
    const bool isTilt = hint.find("Tilt") != std::string::npos;
    for (const auto& [words, wanted] : tilts)
    {
      tilt = isTilt && hint.find(words) != std::string::npos ? wanted : tilt;
    }
    for (const auto& [words, way] : places)
    {
      if (!isTilt && hint.find(words) != std::string::npos)
      {
        middle.x() += way.x() * random.uniform(70, 110);
        middle.y() += way.y() * random.uniform(50, 80);
      }
    }
    const BoardDetection detection = seen(at(middle, tilt));
    if (int(detection.ids.size()) == Board.pointCount())
    {
      collector.add(pictures, detection);
    }
  }
  EXPECT_TRUE(collector.isComplete()) << collector.hint() << " " << collector.completeness();
  EXPECT_LT(pictures, 80);
  EXPECT_TRUE(says(collector.hint(), { "enough" }));
  int points = 0;
  for (const LensView& view : collector.views())
  {
    points += int(view.ids.size());
  }
  EXPECT_EQ(collector.coverage().sum(), points);
  const int before = int(collector.views().size());
  collector.remove(0);
  EXPECT_EQ(int(collector.views().size()), before - 1);
  EXPECT_EQ(collector.coverage().sum(), points - Board.pointCount());
  EXPECT_THROW(collector.remove(before), std::out_of_range);
  collector.clear();
  EXPECT_EQ(collector.coverageShare(), 0);
  expectInvalidArgument([] { LensViewCollector(0, 480); }, { "width" });
}
