// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SimulatedRoom.h"
#include "BallDetection.h"
#include "SphereRenderer.h"
#include "SpinCalibration.h"

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

/// About the origin of its frame.
RoomMesh sphereOfTriangles(double radiusMm)
{
  constexpr int Rings = 48, Sectors = 96;
  std::vector<Eigen::Vector3d> points_Model;
  std::vector<std::array<int, 3>> triangles;
  for (int ring = 0; ring <= Rings; ++ring)
  {
    for (int sector = 0; sector < Sectors; ++sector)
    {
      const double down = EIGEN_PI * ring / Rings, turn = 2 * EIGEN_PI * sector / Sectors;
      points_Model.push_back(
        radiusMm * Eigen::Vector3d(std::sin(down) * std::cos(turn), std::sin(down) * std::sin(turn), std::cos(down)));
      const int here = ring * Sectors, next = (sector + 1) % Sectors;
      if (ring < Rings)
      {
        triangles.push_back({ here + sector, here + Sectors + sector, here + Sectors + next });
        triangles.push_back({ here + sector, here + Sectors + next, here + next });
      }
    }
  }
  return { points_Model, triangles };
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

TEST(SimulatedRoom, Spin_FindsTheShaftOfTheStylus)
{
  RoomOptions options;
  options.motion = RoomMotion::Spin;
  const SimulatedRoom room(options);
  std::vector<Eigen::Isometry3d> stylusToTracker;
  for (double timeSec = 0; timeSec < 6; timeSec += 1.0 / 60)
  {
    stylusToTracker.push_back(room.track(timeSec)[1].transform);
  }
  const SpinCalibrationResult spin = calibrateSpin(stylusToTracker, options.tip_Stylus);
  ASSERT_TRUE(spin.isUsable()) << spin.message;
  const Eigen::Vector3d shaft_Stylus = -options.tip_Stylus.normalized();
  EXPECT_LT(std::acos(std::min(1.0, spin.shaft_Stylus.dot(shaft_Stylus))) * 180 / EIGEN_PI, 0.3) << spin.message;
  EXPECT_GT(spin.spin, 0.6) << spin.message;
}

TEST(SimulatedRoom, Rest_HoldsTheWholeBallStillInTheView)
{
  const SimulatedRoom room(quiet(RoomMotion::Rest));
  const CameraModel& camera = room.options().camera;
  const Eigen::Vector2d first = camera.project(room.truth(0).ball_Camera).point_Image;
  for (double timeSec = 0; timeSec < 60; timeSec += 0.5)
  {
    ASSERT_TRUE(room.isHeldStill(timeSec));
    const Eigen::Vector2d now = camera.project(room.truth(timeSec).ball_Camera).point_Image;
    EXPECT_LT((now - first).norm(), 8) << timeSec;  // the camera in the hand; the ball's radius is 37 px
  }
  const BallDetection ball = detectBall(room.picture(3), camera, room.options().ballRadiusMm);
  ASSERT_TRUE(ball.isFound()) << ball.message;
  EXPECT_GT(ball.radiusPx, 30);
  EXPECT_GT(ball.visibleShare, 0.8);
}

/// A sphere of triangles is where the sphere worked out exactly is, through the lens; its far side is not seen.
TEST(SimulatedRoom, Mesh_IsSeenWhereItIs)
{
  const CameraModel camera = RoomOptions().camera;
  RenderedBall ball;
  ball.radiusMm = 40;
  ball.center_Camera = { -70, 55, 260 };  // where the lens bends
  Eigen::Isometry3d modelToCamera = Eigen::Isometry3d::Identity();
  modelToCamera.translation() = ball.center_Camera;
  const Eigen::Vector3d near_Model = -ball.radiusMm * ball.center_Camera.normalized();
  RoomMeshLook look;
  look.color = { 0, 0.5F, 0 };
  look.dotColor = { 0.9F, 0, 0 };
  look.dots_Model = { near_Model, Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitY()) * near_Model };
  SphereScene exact(camera, Light(0, 0, 0)), drawn(camera, Light(0, 0, 0));
  exact.add(ball);
  drawMesh(drawn.light(), camera, sphereOfTriangles(ball.radiusMm), modelToCamera, look);

  int seen = 0, wrong = 0, dotPixels = 0;
  Eigen::Vector2d dotSum = Eigen::Vector2d::Zero();
  for (int row = 0; row < camera.height(); ++row)
  {
    for (int column = 0; column < camera.width(); ++column)
    {
      const Light here = drawn.light().at<Light>(row, column);
      const bool isThere = exact.light().at<Light>(row, column)[2] > 0.5F * ball.color[2];
      seen += isThere ? 1 : 0;
      wrong += isThere != (here[0] + here[1] > 0.06F) ? 1 : 0;
      if (here[0] > here[1])
      {
        ++dotPixels;
        dotSum += Eigen::Vector2d(column, row);
      }
    }
  }
  EXPECT_GT(seen, 20000);
  EXPECT_LT(wrong, 0.01 * seen);  // half covered pixels of the outline
  ASSERT_GT(dotPixels, 30);
  const Eigen::Vector2d dot_Image = camera.project(modelToCamera * near_Model).point_Image;
  EXPECT_LT((dotSum / dotPixels - dot_Image).norm(), 0.5);
}

TEST(SimulatedRoom, MeshOfThePhantom_LeavesTheBallToBeFound)
{
  RoomOptions options = quiet(RoomMotion::Landmarks);
  options.phantomMesh = std::make_shared<RoomMesh>(sphereOfTriangles(30));
  options.landmarks_Model = { { 30, 0, 0 }, { 0, 30, 0 }, { 0, 0, 30 } };
  const SimulatedRoom room(options);
  for (int landmark = 0; landmark < 3; ++landmark)
  {
    const double timeSec = landmark * (options.holdSec + options.moveSec) + 1;
    const BallDetection ball = detectBall(room.picture(timeSec), options.camera, options.ballRadiusMm);
    ASSERT_TRUE(ball.isFound()) << landmark << ": " << ball.message;
    EXPECT_LT((ball.ball_Image - options.camera.project(room.truth(timeSec).ball_Camera).point_Image).norm(), 0.2);
  }
  EXPECT_THROW(RoomMesh({ { 0, 0, 0 } }, { { 0, 0, 1 } }), std::invalid_argument);
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
