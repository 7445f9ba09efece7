// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StillnessDetector.h"

#include "GeometryMatchers.h"
#include "PivotSimulation.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Touch = StillnessOptions::Touch;

/// A stream with samples at a fixed rate, and the rests that were recognised in it.
struct Stream
{
  explicit Stream(const StillnessOptions& options = {}, double samplesPerSec = 30)
    : detector(PivotSimulation().tip_Stylus, options)
    , stepSec(1 / samplesPerSec)
  {
  }

  void add(const Eigen::Vector3d& tip_World, const Eigen::Matrix3d& rotation)
  {
    stylus.pivot_Tracker = tip_World;
    keep(detector.add(timeSec, stylus.pose(rotation, random)));
    timeSec += stepSec;
  }

  void rest(const Eigen::Vector3d& tip_World, double seconds, double tremorMm = 0, double turn = 0)
  {
    const double end = timeSec + seconds - stepSec / 2;
    while (timeSec < end)
    {
      const Eigen::Vector3d lean(turn * std::sin(3 * timeSec), turn * std::cos(2 * timeSec), 0);
      add(tip_World + random.normal3(tremorMm), rotationFromVector(lean));
    }
  }

  /// 200 mm/s.
  void travel(const Eigen::Vector3d& from, const Eigen::Vector3d& to)
  {
    const int steps = int((to - from).norm() / (200 * stepSec));
    for (int i = 1; i < steps; ++i)
    {
      add(from + (to - from) * i / steps, Eigen::Matrix3d::Identity());
    }
  }

  void keep(const std::optional<Rest>& rest)
  {
    if (rest)
    {
      rests.push_back(*rest);
    }
  }

  void finish() { keep(detector.finish()); }

  StillnessDetector detector;
  PivotSimulation stylus;
  Random random{ 1 };
  double stepSec;
  double timeSec = 100;
  std::vector<Rest> rests;
};

const Eigen::Vector3d A(0, 0, -800), B(90, 0, -800), C(90, 70, -790);

}  // namespace

TEST(StillnessDetector, HeldAtThreePlaces_GivesTheirAveragesInOrder)
{
  StillnessOptions options;
  options.touch = Touch::Held;
  Stream stream(options);
  stream.rest(A, 2, 0.15);
  stream.travel(A, B);
  stream.rest(B, 3, 0.15);
  stream.travel(B, C);
  stream.rest(C, 1.5, 0.15);
  stream.finish();
  ASSERT_EQ(stream.rests.size(), 3U);
  const Eigen::Vector3d places[] = { A, B, C };
  const double seconds[] = { 2, 3, 1.5 };
  for (std::size_t i = 0; i < 3; ++i)
  {
    const Rest& rest = stream.rests[i];
    EXPECT_EQ(rest.kind, Rest::Kind::Held);
    EXPECT_TRUE(pointNear(rest.tip_World, places[i], 0.12)) << i;
    EXPECT_NEAR(rest.endSec - rest.beginSec, seconds[i], 0.1);
    EXPECT_NEAR(rest.count, 30 * seconds[i], 3);
    EXPECT_EQ(rest.lastSample - rest.firstSample + 1, rest.count + rest.leftOut);
    // Tremor and tracker noise add up in all three axes.
    EXPECT_NEAR(rest.rmsMm, std::sqrt(3 * 0.15 * 0.15 + 3 * 0.12 * 0.12 + 2 * std::pow(158 * 0.025 * Degree, 2)), 0.07);
    EXPECT_NEAR(rest.tipCovariance.trace(), rest.rmsMm * rest.rmsMm, 0.02);
    EXPECT_TRUE(pointNear(rest.toolToWorld * PivotSimulation().tip_Stylus, rest.tip_World, 1e-9));
    EXPECT_LT(rest.turn, 0.1 * Degree);
  }
}

TEST(StillnessDetector, PivotingTip_IsARestUnlessHoldingIsAskedFor)
{
  for (const Touch touch : { Touch::Either, Touch::Pivoted, Touch::Held })
  {
    StillnessOptions options;
    options.touch = touch;
    Stream stream(options);
    stream.rest(A, 3, 0, 25 * Degree);
    stream.travel(A, B);
    stream.rest(B, 3);
    stream.finish();
    if (touch == Touch::Held)
    {
      ASSERT_EQ(stream.rests.size(), 1U);
      EXPECT_TRUE(pointNear(stream.rests[0].tip_World, B, 0.1));
      continue;
    }
    ASSERT_EQ(stream.rests.size(), touch == Touch::Either ? 2U : 1U);
    EXPECT_EQ(stream.rests[0].kind, Rest::Kind::Pivoted);
    EXPECT_TRUE(pointNear(stream.rests[0].tip_World, A, 0.1));
    EXPECT_NEAR(stream.rests[0].turn, 25 * Degree, 6 * Degree);
  }
}

TEST(StillnessDetector, LimitsInMmDegAndSec_AreKept)
{
  const auto restsFor = [](double tremorMm, double turnDeg, double seconds)
  {
    StillnessOptions options;
    options.touch = Touch::Held;
    options.maximumMotionMm = 1;
    options.maximumTurn = 2 * Degree;
    options.minimumDurationSec = 0.8;
    Stream stream(options);
    stream.travel(C, A);
    stream.rest(A, seconds, tremorMm, turnDeg * Degree);
    stream.travel(A, B);
    stream.finish();
    return stream.rests.size();
  };
  EXPECT_EQ(restsFor(0.1, 0.5, 1), 1U);
  EXPECT_EQ(restsFor(1.5, 0.5, 3), 0U) << "mm";
  EXPECT_EQ(restsFor(0.1, 8, 3), 0U) << "deg";
  EXPECT_EQ(restsFor(0.1, 0.5, 0.7), 0U) << "s";
}

TEST(StillnessDetector, ShortExcursion_IsLeftOutAndALongOneEndsTheRest)
{
  Stream stream;
  stream.rest(A, 1.5);
  stream.add(A + Eigen::Vector3d(40, 0, 0), Eigen::Matrix3d::Identity());
  stream.add(A + Eigen::Vector3d(40, 0, 0), Eigen::Matrix3d::Identity());
  stream.rest(A, 1.5);
  EXPECT_TRUE(stream.rests.empty());
  ASSERT_TRUE(stream.detector.current());
  EXPECT_EQ(stream.detector.current()->leftOut, 2);
  EXPECT_TRUE(pointNear(stream.detector.current()->tip_World, A, 0.1));
  stream.rest(B, 0.5);
  ASSERT_EQ(stream.rests.size(), 1U);
  EXPECT_FALSE(stream.detector.current());
}

TEST(StillnessDetector, HiddenTool_EndsTheRest)
{
  Stream stream;
  stream.rest(A, 1.5);
  for (int i = 0; i < 30; ++i)
  {
    stream.keep(stream.detector.addInvalid(stream.timeSec));
    stream.timeSec += stream.stepSec;
  }
  EXPECT_EQ(stream.rests.size(), 1U);
  stream.rest(A, 0.5);
  EXPECT_FALSE(stream.detector.current()) << "half a second is no rest yet";
  stream.timeSec += 5;
  stream.rest(A, 0.9);
  EXPECT_FALSE(stream.detector.current()) << "a gap is not stillness";
}

TEST(StillnessDetector, SlowDrift_IsNotOneRest)
{
  Stream stream;
  for (int i = 0; i < 600; ++i)
  {
    stream.add(A + Eigen::Vector3d(0.2 * i, 0, 0), Eigen::Matrix3d::Identity());
  }
  stream.finish();
  for (const Rest& rest : stream.rests)
  {
    EXPECT_LT(rest.rmsMm, 1.5);
    EXPECT_LT(rest.endSec - rest.beginSec, 1.5);
  }
}

TEST(StillnessDetector, AnyRate_GivesTheSame)
{
  for (const double rate : { 10.0, 60.0, 1000.0 })
  {
    Stream stream({}, rate);
    stream.travel(C, A);
    stream.rest(A, 2, 0.1);
    stream.travel(A, B);
    stream.finish();
    ASSERT_EQ(stream.rests.size(), 1U) << rate;
    EXPECT_TRUE(pointNear(stream.rests[0].tip_World, A, 0.2)) << rate;
    EXPECT_NEAR(stream.rests[0].endSec - stream.rests[0].beginSec, 2, 0.15) << rate;
  }
}

TEST(StillnessDetector, Progress_FillsWhileTheToolKeepsStill)
{
  Stream stream;
  stream.travel(C, A);
  EXPECT_LT(stream.detector.progress(), 0.2);
  stream.rest(A, 0.5);
  EXPECT_NEAR(stream.detector.progress(), 0.5, 0.15);
  stream.rest(A, 0.7);
  EXPECT_EQ(stream.detector.progress(), 1);
}

TEST(StillnessDetector, NoiseFreeRest_IsOne)
{
  Stream stream;
  stream.stylus.sigmaMm = stream.stylus.sigmaRad = 0;
  stream.rest(A, 2);
  stream.finish();
  ASSERT_EQ(stream.rests.size(), 1U);
  EXPECT_TRUE(pointNear(stream.rests[0].tip_World, A, 1e-9));
  EXPECT_LT(stream.rests[0].rmsMm, 1e-6);
}

TEST(StillnessDetector, TimeThatGoesBack_IsLeftOut)
{
  Stream stream;
  stream.rest(A, 0.5);
  EXPECT_FALSE(stream.detector.add(stream.timeSec - 0.2, makeRigid({ 0, 0, 0 }, C)));
  stream.rest(A, 0.6);
  EXPECT_TRUE(stream.detector.current());
}

TEST(StillnessDetector, ClockThatWasSet_EndsTheRestAndTheNextIsFound)
{
  Stream stream;
  stream.rest(A, 2);
  ASSERT_TRUE(stream.detector.current());
  stream.timeSec -= 3600;
  stream.rest(B, 2);
  stream.finish();
  ASSERT_EQ(stream.rests.size(), 2U);
  EXPECT_TRUE(pointNear(stream.rests[0].tip_World, A, 0.2));
  EXPECT_TRUE(pointNear(stream.rests[1].tip_World, B, 0.2));
}

TEST(StillnessDetector, OneSampleFromTheFuture_DoesNotSilenceTheRest)
{
  Stream stream;
  stream.rest(A, 0.5);
  (void)stream.detector.addInvalid(stream.timeSec + 1e6);
  stream.rest(A, 2);
  EXPECT_TRUE(stream.detector.current());
}

TEST(StillnessDetector, BadInput_Throws)
{
  StillnessOptions options;
  options.maximumMotionMm = 0;
  expectInvalidArgument([&] { StillnessDetector detector({ 0, 0, 0 }, options); }, { "mm", "rad", "time" });
  expectInvalidArgument([&] { StillnessDetector detector({ 0, std::nan(""), 0 }); }, { "tip", "finite" });
  StillnessDetector detector({ 0, 0, -100 });
  expectInvalidArgument([&] { (void)detector.add(std::nan(""), Eigen::Isometry3d::Identity()); }, { "sample 0", "finite" });
}
