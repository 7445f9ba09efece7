// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FramePairing.h"
#include "Simulation.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{

using namespace handeye::devices;
using handeye::PoseAtTime;
using handeye::test::makeRigid;

DeviceSample poseAt(double timeSec, bool isValid = true, const std::string& name = "StylusToTracker")
{
  TrackedPose pose;
  pose.isValid = isValid;
  pose.transform = makeRigid({ 0, 0, 0 }, { 100 * timeSec, 0, 0 });
  return { name, timeSec, timeSec, {}, pose };
}

DeviceSample imageAt(double timeSec, const std::string& name = "Video")
{
  VideoFrame frame;
  frame.image = cv::Mat(2, 2, CV_8UC3, cv::Scalar::all(1));
  return { name, timeSec, timeSec, {}, frame };
}

double xOf(const PairedFrame& frame)
{
  return frame.poses.at("StylusToTracker").transform.translation().x();
}

TEST(FramePairing, PosesOfTheImagesMoment_WhateverTheOrderOfArrival)
{
  FramePairing pairing;
  pairing.add(imageAt(1.005));
  EXPECT_FALSE(pairing.take());
  pairing.add(poseAt(1.0));
  EXPECT_FALSE(pairing.take());  // the other side is not there yet
  pairing.add(poseAt(1.02));
  const std::optional<PairedFrame> frame = pairing.take();
  ASSERT_TRUE(frame);
  EXPECT_NEAR(xOf(*frame), 100.5, 1e-9);
  EXPECT_FALSE(pairing.take());
}

TEST(FramePairing, Latency_MovesThePosesMoment)
{
  FramePairingOptions options;
  options.latencySec = -0.04;
  FramePairing pairing(options);
  for (int i = 0; i < 20; ++i)
  {
    pairing.add(poseAt(1 + 0.01 * i));
  }
  pairing.add(imageAt(1.1));
  EXPECT_NEAR(xOf(*pairing.take()), 106, 1e-9);
  options.latencySec = 0.04;
  FramePairing later(options);
  later.add(imageAt(1.1));
  later.add(poseAt(1.1));
  EXPECT_FALSE(later.take());
  later.add(poseAt(1.15));
  EXPECT_NEAR(xOf(*later.take()), 114, 1e-9);
}

/// A recording that was made with a latency is played: what is in it already is not applied again, and is still said.
TEST(FramePairing, LatencyOfARecording_IsAppliedOnce)
{
  for (double wantedSec : { 0.0, -0.04, -0.05 })
  {
    FramePairingOptions options;
    options.latencySec = wantedSec;
    FramePairing pairing(options);
    for (int i = 0; i < 20; ++i)
    {
      pairing.add(poseAt(1 + 0.01 * i));
    }
    DeviceSample image = imageAt(1.1);
    image.metadata[AppliedLatencyKey] = "-0.04";
    pairing.add(image);
    const std::optional<PairedFrame> frame = pairing.take();
    ASSERT_TRUE(frame);
    EXPECT_NEAR(xOf(*frame), wantedSec == -0.05 ? 109 : 110, 1e-9) << wantedSec;
    EXPECT_NEAR(frame->latencySec, wantedSec == 0 ? -0.04 : wantedSec, 1e-12) << wantedSec;
  }
}

TEST(FramePairing, HiddenTool_IsSaidSo)
{
  FramePairing pairing;
  pairing.add(poseAt(1));
  pairing.add(poseAt(1.02, false));
  pairing.add(imageAt(1.01));
  const std::optional<PairedFrame> frame = pairing.take();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->poses.at("StylusToTracker").status, PoseAtTime::Status::Invalid);
}

TEST(FramePairing, ToolThatNeverComes_DoesNotHoldTheImageForEver)
{
  FramePairingOptions options;
  options.toolNames = { "StylusToTracker", "MarkerToTracker" };
  FramePairing pairing(options);
  pairing.add(imageAt(1));
  for (int i = 0; i <= 20; ++i)
  {
    pairing.add(poseAt(0.99 + 0.02 * i));
  }
  const std::optional<PairedFrame> frame = pairing.take();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->poses.at("StylusToTracker").status, PoseAtTime::Status::Ok);
  EXPECT_EQ(frame->poses.at("MarkerToTracker").status, PoseAtTime::Status::NoPose);
}

TEST(FramePairing, TrackerThatStopped_LeavesImagesWithoutPoses)
{
  FramePairing pairing;
  pairing.add(poseAt(1));
  int without = 0;
  for (int i = 0; i < 60; ++i)
  {
    pairing.add(imageAt(1.1 + i / 30.0));
    while (const std::optional<PairedFrame> frame = pairing.take())
    {
      EXPECT_EQ(frame->poses.at("StylusToTracker").status, PoseAtTime::Status::Extrapolated);
      ++without;
    }
  }
  EXPECT_GT(without, 45);
}

TEST(FramePairing, ImagesThatWait_AreBounded)
{
  FramePairingOptions options;
  options.toolNames = { "StylusToTracker" };
  FramePairing pairing(options);
  int taken = 0;
  for (int i = 0; i < 100; ++i)
  {
    pairing.add(imageAt(1 + 1e-4 * i));
    taken += pairing.take() ? 1 : 0;
  }
  EXPECT_EQ(taken, 40);
}

TEST(FramePairing, OldTimes_AreRefusedAndAClockThatWasSetIsFollowed)
{
  FramePairing pairing;
  pairing.add(poseAt(100));
  pairing.add(poseAt(93));  // older than the history, but no jump
  EXPECT_EQ(pairing.refusedCount(), 1U);
  pairing.add(poseAt(-5));
  pairing.add(poseAt(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ(pairing.refusedCount(), 3U);
  pairing.add(poseAt(5));
  EXPECT_EQ(pairing.clockJumpCount(), 1U);
  pairing.add(imageAt(5.01));
  pairing.add(poseAt(5.02));
  const std::optional<PairedFrame> frame = pairing.take();
  ASSERT_TRUE(frame);
  EXPECT_NEAR(xOf(*frame), 501, 1e-9);
}

TEST(FramePairing, SeveralVideos_AreNotMixed)
{
  for (const std::string asked : { "", "Endoscope" })
  {
    FramePairingOptions options;
    options.imageName = asked;
    FramePairing pairing(options);
    pairing.add(poseAt(1));
    pairing.add(poseAt(1.09));
    for (const char* name : { "Room", "Endoscope", "Room", "Endoscope" })
    {
      pairing.add(imageAt(1.05, name));
    }
    const std::string taken = asked.empty() ? "Room" : "Endoscope", other = asked.empty() ? "Endoscope" : "Room";
    int count = 0;
    while (const std::optional<PairedFrame> frame = pairing.takeRest())
    {
      EXPECT_EQ(frame->image.name, taken);
      ++count;
    }
    EXPECT_EQ(count, 2);
    EXPECT_EQ(pairing.imageName(), taken);
    EXPECT_EQ(pairing.otherImages(), std::set<std::string>({ other }));
  }
}

TEST(ClockOffset, TakesTheFastestWay)
{
  ClockOffset offset;
  handeye::test::Random random(2);
  double local = 0;
  for (int i = 0; i < 200; ++i)
  {
    const double timeSec = 5 + 0.01 * i;
    local = offset.toLocalSec(timeSec, timeSec + 1000 + std::abs(random.normal(0.01)));
  }
  EXPECT_NEAR(local, 5 + 1.99 + 1000, 0.001);
}

}  // namespace
