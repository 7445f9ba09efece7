// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SecondLook.h"

#include "CaptureSimulation.h"
#include "GeometryMatchers.h"

#include <gtest/gtest.h>

using namespace handeye;
using namespace handeye::test;
using handeye::io::test::TemporaryFolder;

namespace
{

/// A capture in one of whose frames a second ball lies on the table.
class SecondLook : public testing::Test
{
protected:
  static constexpr std::size_t Doubtful = 2;
  const SimulatedSession session{ 5 };
  const TemporaryFolder folder;

  io::Recording record() const
  {
    const std::filesystem::path path = session.write(folder.path() / "capture", session.trackAll());
    const Eigen::Vector2d held_Image = session.camera.project(session.balls_Camera[Doubtful]).point_Image;
    const bool isLeft = held_Image.x() < session.camera.width() / 2.0;
    RenderedBall held, other = ballSeenAt(session.camera, isLeft ? 0.85 : 0.15, 0.5, 22, session.ballRadiusMm);
    held.center_Camera = session.balls_Camera[Doubtful];
    held.radiusMm = session.ballRadiusMm;
    SimulatedSession::writePicture(path, int(Doubtful), SphereScene(session.camera).add(held).add(other).photograph());
    return io::Recording::open(path);
  }
};

}  // namespace

TEST_F(SecondLook, FrameWithTwoBalls_IsDecidedByTheTracker)
{
  const io::Recording recording = record();
  std::vector<CapturedFrame> frames = readCapture(recording, {}, session.camera, session.tip_Stylus, session.ballRadiusMm);
  ASSERT_EQ(frames[Doubtful].status, "several_balls") << frames[Doubtful].message;
  const std::vector<CapturedFrame> before = frames;
  const std::vector<int> decided =
    lookAgain(recording, session.camera, session.ballRadiusMm, {}, session.markerToCamera, 5, frames);
  EXPECT_EQ(decided, std::vector<int>{ int(Doubtful) });
  ASSERT_TRUE(frames[Doubtful].isSample());
  const Eigen::Vector2d expected = session.camera.project(session.balls_Camera[Doubtful]).point_Image;
  EXPECT_TRUE(pointNear(frames[Doubtful].ball.ball_Image, expected, 0.05));
  for (const std::size_t other : { 0U, 1U, 3U, 4U })
  {
    EXPECT_EQ(frames[other].ball.ball_Image, before[other].ball.ball_Image) << "frames with one ball are left alone";
  }
}

TEST_F(SecondLook, WrongCalibration_DecidesNothing)
{
  const io::Recording recording = record();
  std::vector<CapturedFrame> frames = readCapture(recording, {}, session.camera, session.tip_Stylus, session.ballRadiusMm);
  const Eigen::Isometry3d wrong = Eigen::Translation3d(0, 90, 0) * session.markerToCamera;
  EXPECT_TRUE(lookAgain(recording, session.camera, session.ballRadiusMm, {}, wrong, 5, frames).empty());
  EXPECT_EQ(frames[Doubtful].status, "several_balls");
}
