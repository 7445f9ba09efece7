// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PoseTrack.h"
#include "RigidTransform.h"
#include "Simulation.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{

using namespace handeye;
using test::makeRigid;
using Status = PoseAtTime::Status;

/// Turns by 1 rad/s about an axis and moves by 100 mm/s.
Eigen::Isometry3d motionAt(double timeSec)
{
  return makeRigid(Eigen::Vector3d(0.6, 0, 0.8) * timeSec, Eigen::Vector3d(100, -50, 20) * timeSec);
}

PoseTrack trackOf(int count, double stepSec = 0.02)
{
  PoseTrack track;
  for (int i = 0; i < count; ++i)
  {
    track.add(i * stepSec, motionAt(i * stepSec));
  }
  return track;
}

TEST(PoseTrack, BetweenPoses_FollowsASteadyTurn)
{
  const PoseTrack track = trackOf(50);
  for (double timeSec : { 0.0, 0.001, 0.013, 0.5, 0.973, 0.98 })
  {
    const PoseAtTime pose = track.at(timeSec);
    ASSERT_EQ(pose.status, Status::Ok) << pose.message;
    EXPECT_LT((pose.transform.matrix() - motionAt(timeSec).matrix()).norm(), 1e-9);
    EXPECT_LE(pose.gapSec, 0.0201);
    EXPECT_EQ(pose.extrapolationSec, 0);
  }
}

TEST(PoseTrack, TurnNearPi_TakesTheShortWay)
{
  PoseTrack track;
  track.add(0, makeRigid({ 0, 0, 3.1 }, { 0, 0, 0 }));
  track.add(0.05, makeRigid({ 0, 0, -3.1 }, { 0, 0, 0 }));
  const Eigen::Matrix3d half = track.at(0.025).transform.linear();
  EXPECT_LT(rotationAngle(half.transpose() * rotationFromVector({ 0, 0, EIGEN_PI })), 1e-9);
}

TEST(PoseTrack, Gap_IsStoredAndRefusedBeyondTheLimit)
{
  PoseTrack track;
  track.add(0, motionAt(0));
  track.add(0.09, motionAt(0.09));
  track.add(0.25, motionAt(0.25));
  EXPECT_EQ(track.at(0.05).status, Status::Ok);
  EXPECT_NEAR(track.at(0.05).gapSec, 0.09, 1e-12);
  const PoseAtTime refused = track.at(0.1);
  EXPECT_EQ(refused.status, Status::GapTooLarge);
  EXPECT_NE(refused.message.find("160 ms"), std::string::npos) << refused.message;
}

TEST(PoseTrack, InvalidPoseOnEitherSide_IsInvalid)
{
  PoseTrack track = trackOf(3);
  track.add(0.06, Eigen::Isometry3d::Identity(), false);
  track.add(0.08, motionAt(0.08));
  EXPECT_EQ(track.at(0.03).status, Status::Ok);
  EXPECT_EQ(track.at(0.05).status, Status::Invalid);
  EXPECT_EQ(track.at(0.06).status, Status::Invalid);
  EXPECT_EQ(track.at(0.07).status, Status::Invalid);
  EXPECT_EQ(track.at(0.08).status, Status::Ok);
}

TEST(PoseTrack, Extrapolation_IsRefusedUnlessAllowed)
{
  PoseTrackOptions options;
  options.maximumExtrapolationSec = 0.01;
  PoseTrack track(options);
  EXPECT_EQ(track.at(0).status, Status::NoPose);
  track.add(1, motionAt(1));
  track.add(1.02, motionAt(1.02));
  const PoseAtTime near = track.at(1.028);
  EXPECT_EQ(near.status, Status::Ok);
  EXPECT_NEAR(near.extrapolationSec, 0.008, 1e-12);
  EXPECT_EQ(track.at(1.04).status, Status::Extrapolated);
  EXPECT_EQ(track.at(0.98).status, Status::Extrapolated);
  EXPECT_LT(track.at(0.98).extrapolationSec, 0);
  EXPECT_EQ(trackOf(5).at(0.081).status, Status::Extrapolated);
}

TEST(PoseTrack, TheSameBitsForTooLong_AreStale)
{
  PoseTrack track;
  for (int i = 0; i <= 100; ++i)
  {
    track.add(0.02 * i, motionAt(0.02 * std::min(i, 40)));  // stops at 0.8 s
  }
  EXPECT_EQ(track.at(1.2).status, Status::Ok);
  EXPECT_EQ(track.at(1.5).status, Status::Stale);
  EXPECT_NEAR(track.at(1.5).repeatSec, 0.7, 0.03);
}

TEST(PoseTrack, LateAndOldPoses_AreSortedInOrRefused)
{
  PoseTrack track;
  track.add(10, motionAt(10));
  track.add(10.04, motionAt(10.04));
  EXPECT_TRUE(track.add(10.02, motionAt(10.02)));
  EXPECT_NEAR(track.at(10.01).gapSec, 0.02, 1e-9);
  EXPECT_FALSE(track.add(3, motionAt(3)));
  EXPECT_EQ(track.size(), 3U);
  for (int i = 0; i < 2000; ++i)
  {
    track.add(10 + 0.02 * i, motionAt(0.02 * i));
  }
  EXPECT_LE(track.size(), 252U);  // five seconds
}

TEST(PoseTrack, WhatIsNotFinite_IsACallersMistake)
{
  PoseTrack track;
  Eigen::Isometry3d bad = Eigen::Isometry3d::Identity();
  bad(0, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(track.add(0, bad), std::invalid_argument);
  EXPECT_THROW(track.add(std::numeric_limits<double>::infinity(), motionAt(0)), std::invalid_argument);
  EXPECT_TRUE(track.add(0, bad, false));  // not valid: its numbers do not matter
  PoseTrackOptions options;
  options.maximumGapSec = -1;
  EXPECT_THROW(PoseTrack{ options }, std::invalid_argument);
}

}  // namespace
