// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SimulatedRoom.h"
#include "BallDetection.h"

#include <gtest/gtest.h>

namespace
{

using namespace handeye;
using namespace handeye::simulation;

RoomOptions quiet(RoomMotion motion)
{
  RoomOptions options;
  options.motion = motion;
  options.trackingSigmaMm = options.trackingSigmaDeg = options.dropOutShare = options.imageNoise = 0;
  return options;
}

const RoomPose& poseOf(const std::vector<RoomPose>& poses, const std::string& name)
{
  return *std::find_if(poses.begin(), poses.end(), [&](const RoomPose& pose) { return pose.name == name; });
}

TEST(SimulatedRoom, TheBallIsSeenWhereTheTruthSays)
{
  const SimulatedRoom room(quiet(RoomMotion::Placements));
  for (int place = 0; place < 15; ++place)
  {
    const double timeSec = place * 2.6 + 1;
    ASSERT_TRUE(room.isHeldStill(timeSec));
    const BallDetection ball = detectBall(room.picture(timeSec), room.options().camera, room.options().ballRadiusMm);
    ASSERT_TRUE(ball.isFound()) << place << ": " << ball.message;
    const Eigen::Vector3d ball_Camera = room.truth(timeSec).ball_Camera;
    EXPECT_LT((ball.ball_Image - room.options().camera.project(ball_Camera).point_Image).norm(), 0.1) << place;
    EXPECT_NEAR(ball.distanceMm, ball_Camera.norm(), 0.01 * ball_Camera.norm());
  }
}

TEST(SimulatedRoom, PosesAndTruthBelongTogether)
{
  const SimulatedRoom room(quiet(RoomMotion::Free));
  const std::vector<RoomPose> poses = room.track(3.2);
  const Eigen::Vector3d tip_Tracker = poseOf(poses, "StylusToTracker").transform * room.options().tip_Stylus;
  const Eigen::Vector3d tip_Marker = poseOf(poses, "MarkerToTracker").transform.inverse() * tip_Tracker;
  EXPECT_LT((room.options().markerToCamera * tip_Marker - room.truth(3.2).ball_Camera).norm(), 1e-9);
}

TEST(SimulatedRoom, Pivot_KeepsTheTip)
{
  const SimulatedRoom room(quiet(RoomMotion::Pivot));
  const Eigen::Vector3d first = room.track(0)[1].transform * room.options().tip_Stylus;
  double turned = 0;
  for (double timeSec = 0; timeSec < 10; timeSec += 0.1)
  {
    const Eigen::Isometry3d stylusToTracker = room.track(timeSec)[1].transform;
    EXPECT_LT((stylusToTracker * room.options().tip_Stylus - first).norm(), 1e-9);
    turned = std::max(turned, (stylusToTracker.linear() - room.track(0)[1].transform.linear()).norm());
  }
  EXPECT_GT(turned, 0.5);
}

TEST(SimulatedRoom, Delay_ShowsAnEarlierMoment)
{
  RoomOptions options = quiet(RoomMotion::Free);
  options.videoDelaySec = 0.05;
  const SimulatedRoom late(options), prompt(quiet(RoomMotion::Free));
  EXPECT_EQ(cv::norm(late.picture(2.05), prompt.picture(2.0), cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(late.picture(2.0), prompt.picture(2.0), cv::NORM_INF), 0);
}

TEST(SimulatedRoom, NoiseAndDropOuts_AreAsAskedAndRepeatable)
{
  RoomOptions options;
  options.dropOutShare = 0.1;
  const SimulatedRoom room(options), again(options);
  int hidden = 0, count = 0;
  double squared = 0;
  RoomOptions exact = quiet(RoomMotion::Tour);
  const SimulatedRoom silent(exact);
  for (double timeSec = 0; timeSec < 100; timeSec += 0.05, ++count)
  {
    const std::vector<RoomPose> poses = room.track(timeSec);
    EXPECT_EQ(poses[1].transform.matrix(), again.track(timeSec)[1].transform.matrix());
    hidden += poses[1].isValid ? 0 : 1;
    squared += (poses[0].transform.translation() - silent.track(timeSec)[0].transform.translation()).squaredNorm() / 3;
  }
  EXPECT_NEAR(double(hidden) / count, 0.1, 0.05);  // 500 pieces: three sigma are 0.04
  EXPECT_NEAR(std::sqrt(squared / count), options.trackingSigmaMm, 0.005);
  EXPECT_EQ(cv::norm(room.picture(3), again.picture(3), cv::NORM_INF), 0);
}

TEST(SimulatedRoom, OptionsThatMakeNoSense_AreRefused)
{
  RoomOptions options;
  options.furthestMm = options.nearestMm;
  EXPECT_THROW(SimulatedRoom{ options }, std::invalid_argument);
}

}  // namespace
