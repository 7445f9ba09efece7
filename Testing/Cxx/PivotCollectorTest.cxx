// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PivotCollector.h"

#include "GeometryMatchers.h"
#include "PivotSimulation.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <malloc.h>
#include <new>

// Counts the bytes that the whole program holds.
namespace
{

std::atomic<long long> heldBytes{ 0 };

void* counted(std::size_t size)
{
  void* memory = std::malloc(size);
  if (memory == nullptr)
  {
    throw std::bad_alloc();
  }
  heldBytes += (long long)malloc_usable_size(memory);
  return memory;
}

void release(void* memory)
{
  heldBytes -= memory != nullptr ? (long long)malloc_usable_size(memory) : 0;
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size)
{
  return counted(size);
}
void* operator new[](std::size_t size)
{
  return counted(size);
}
void operator delete(void* memory) noexcept
{
  release(memory);
}
void operator delete[](void* memory) noexcept
{
  release(memory);
}
void operator delete(void* memory, std::size_t) noexcept
{
  release(memory);
}
void operator delete[](void* memory, std::size_t) noexcept
{
  release(memory);
}

using namespace handeye;
using namespace handeye::test;

namespace
{

using Outcome = PivotCollector::Outcome;

/// A hand that circles: the shaft's heading goes round while its lean goes up and down.
Eigen::Matrix3d circling(int sample, double largestTilt)
{
  const double heading = 0.05 * sample, tilt = largestTilt * (0.55 + 0.45 * std::sin(0.013 * sample));
  const Eigen::Matrix3d lean = rotationFromVector({ tilt * std::cos(heading), tilt * std::sin(heading), 0 });
  return lean * rotationFromVector({ 0, 0, 0.4 * std::sin(0.007 * sample) });
}

}  // namespace

TEST(PivotCollector, Pivoting_BecomesEnoughAndTheTipIsThatGood)
{
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    Random random(100 + seed);
    const PivotSimulation stylus;
    PivotCollectorOptions options;
    options.enoughTipErrorMm = 0.05;
    PivotCollector collector(options);
    EXPECT_FALSE(collector.isEnough());
    EXPECT_TRUE(std::isinf(collector.predictedTipErrorMm()));
    int needed = 0;
    for (; needed < 3000 && !collector.isEnough(); ++needed)
    {
      collector.add(stylus.pose(circling(needed, 35 * Degree), random));
    }
    ASSERT_TRUE(collector.isEnough()) << collector.estimate().message;
    EXPECT_GT(needed, 30);
    EXPECT_LT(collector.predictedTipErrorMm(), 0.05);
    EXPECT_TRUE(pointNear(collector.estimate().tip_Stylus, stylus.tip_Stylus, 4 * 0.05)) << seed;
    EXPECT_TRUE(pointNear(collector.calibrate().tip_Stylus, stylus.tip_Stylus, 4 * 0.05)) << seed;
  }
}

TEST(PivotCollector, RepeatedAndInvalidPoses_AreDroppedAndCounted)
{
  Random random(1);
  const PivotSimulation stylus;
  PivotCollector collector;
  for (int i = 0; i < 200; ++i)
  {
    const Eigen::Isometry3d pose = stylus.pose(circling(10 * i, 35 * Degree), random);
    EXPECT_EQ(collector.add(pose), Outcome::Kept);
    EXPECT_EQ(collector.add(pose), Outcome::Repeated);
    EXPECT_EQ(collector.add(pose), Outcome::Repeated);
    EXPECT_EQ(collector.addInvalid(), Outcome::Invalid);
  }
  Eigen::Isometry3d broken = Eigen::Isometry3d::Identity();
  broken.translation().x() = std::nan("");
  EXPECT_EQ(collector.add(broken), Outcome::Invalid);
  EXPECT_EQ(collector.counts().repeated, 400);
  EXPECT_EQ(collector.counts().invalid, 201);
  EXPECT_EQ(collector.counts().total(), 801);
  EXPECT_EQ(collector.counts().kept, (long long)collector.poses().size());
}

TEST(PivotCollector, GrossErrors_AreNotKept)
{
  Random random(2);
  const PivotSimulation stylus;
  PivotCollector collector;
  int wrong = 0;
  for (int i = 0; i < 2000; ++i)
  {
    Eigen::Isometry3d pose = stylus.pose(circling(i, 35 * Degree), random);
    if (i % 20 == 7)
    {
      pose.translation() += random.uniform(5, 60) * random.direction();
      ++wrong;
    }
    collector.add(pose);
  }
  EXPECT_GE(collector.counts().disagreeing, wrong);
  EXPECT_LT(collector.counts().disagreeing, wrong + 20) << "good ones lost";
  EXPECT_FALSE(collector.hasTipMoved());
  EXPECT_TRUE(pointNear(collector.estimate().tip_Stylus, stylus.tip_Stylus, 0.1));
}

TEST(PivotCollector, StylusThatSlips_IsNoticedAndNoLongerEnough)
{
  Random random(3);
  PivotSimulation stylus;
  PivotCollector collector;
  for (int i = 0; i < 800; ++i)
  {
    collector.add(stylus.pose(circling(i, 35 * Degree), random));
  }
  ASSERT_TRUE(collector.isEnough());
  stylus.pivot_Tracker += Eigen::Vector3d(5, 0, 0);
  int noticed = 0;
  for (; noticed < 200 && !collector.hasTipMoved(); ++noticed)
  {
    collector.add(stylus.pose(circling(noticed, 35 * Degree), random));
  }
  EXPECT_LT(noticed, 60) << "a second or two";
  EXPECT_FALSE(collector.isEnough());
  collector.reset();
  EXPECT_FALSE(collector.hasTipMoved());
  EXPECT_EQ(collector.counts().total(), 0);
  EXPECT_EQ(collector.estimate().status, PivotCalibrationResult::Status::TooFewPoses);
  stylus.tip_Stylus += Eigen::Vector3d(10, 5, -20);
  for (int i = 0; i < 800; ++i)
  {
    collector.add(stylus.pose(circling(i, 35 * Degree), random));
  }
  EXPECT_TRUE(collector.isEnough());
  EXPECT_TRUE(pointNear(collector.estimate().tip_Stylus, stylus.tip_Stylus, 0.1)) << "nothing of the one before is left";
  EXPECT_TRUE(pointNear(collector.estimate().pivot_Tracker, stylus.pivot_Tracker, 0.1));
}

TEST(PivotCollector, SpinningOnly_IsNeverEnough)
{
  Random random(4);
  const PivotSimulation stylus;
  PivotCollector collector;
  for (int i = 0; i < 3000; ++i)
  {
    collector.add(stylus.pose(rotationFromVector({ 0, 0, std::sin(0.05 * i) }), random));
  }
  EXPECT_FALSE(collector.isEnough());
  EXPECT_EQ(collector.estimate().status, PivotCalibrationResult::Status::RotationAboutOneAxis) << collector.estimate().message;
}

TEST(PivotCollector, Coverage_ShowsWhatIsMissing)
{
  Random random(5);
  PivotSimulation stylus;
  stylus.tip_Stylus = { 0, 0, -158 };
  PivotCollector half;
  EXPECT_EQ(half.coverage().share(), 0);
  for (int i = 0; i < 600; ++i)
  {
    half.add(stylus.pose(rotationFromVector({ random.uniform(-0.55, 0.55), random.uniform(-0.1, 0.1), 0 }), random));
  }
  PivotCollector whole;
  for (int i = 0; i < 2000; ++i)
  {
    whole.add(stylus.pose(circling(i, 35 * Degree), random));
  }
  EXPECT_GT(half.coverage().share(), 0.2);
  EXPECT_LT(half.coverage().share(), 0.7);
  EXPECT_EQ(whole.coverage().share(), 1);
  EXPECT_TRUE(whole.coverage().isEnough());
  EXPECT_FALSE(half.coverage().isEnough());
  int counted = 0;
  for (int poses : whole.coverage().poses)
  {
    counted += poses;
  }
  EXPECT_EQ(counted, int(whole.poses().size()));
}

TEST(PivotCollector, CellsWithFewPoses_AreNotCovered)
{
  DomeCoverage coverage;
  coverage.poses.fill(DomeCoverage::PosesEach - 1);
  EXPECT_EQ(coverage.covered(), 0);
  for (int cell = 0; cell < DomeCoverage::EnoughCells; ++cell)
  {
    EXPECT_FALSE(coverage.isEnough());
    ++coverage.poses[std::size_t(cell)];
  }
  EXPECT_TRUE(coverage.isEnough());
}

TEST(PivotCollector, CountsWithAResult_AddUpToAllThatCame)
{
  Random random(8);
  PivotSimulation stylus;
  PivotCollector collector;
  for (int i = 0; i < 300; ++i)
  {
    Eigen::Isometry3d stylusToTracker = stylus.pose(circling(i, 35 * Degree), random);
    stylusToTracker.translation().x() += i % 50 == 7 ? 8 : 0;  // slipped
    collector.add(stylusToTracker);
    if (i % 30 == 0)
    {
      collector.addInvalid();
      collector.add(stylusToTracker);
    }
  }
  const PivotCalibrationResult result = collector.calibrate();
  ASSERT_TRUE(result.isUsable()) << result.message;
  const PivotCollector::Counts counts = collector.countsWith(result);
  EXPECT_EQ(counts.kept, (long long)result.used.size());
  EXPECT_EQ(counts.total(), 320);
  EXPECT_EQ(counts.invalid, 10);
  EXPECT_GE(counts.disagreeing, 6);
}

TEST(PivotCollector, PosesThatGiveWay_AreCountedAsRedundant)
{
  Random random(9);
  const PivotSimulation stylus;
  PivotCollectorOptions options;
  PivotCollector collector(options);
  const int count = int(6 * options.capacity);
  int replaced = 0;
  for (int i = 0; i < count; ++i)
  {
    const bool isFull = collector.poses().size() == options.capacity;
    const Outcome outcome = collector.add(stylus.pose(circling(i, 35 * Degree), random));
    replaced += isFull && outcome == Outcome::Kept ? 1 : 0;
    ASSERT_EQ(collector.counts().kept, (long long)collector.poses().size()) << i;
    ASSERT_EQ(collector.counts().total(), i + 1);
  }
  EXPECT_GT(replaced, 0);
  EXPECT_GE(collector.counts().redundant, replaced);
  const PivotCalibrationResult result = collector.calibrate();
  ASSERT_TRUE(result.isUsable()) << result.message;
  const PivotCollector::Counts counts = collector.countsWith(result);
  EXPECT_EQ(counts.kept, (long long)result.used.size());
  EXPECT_EQ(counts.total(), count);
}

TEST(PivotCollector, TimeInOnePlace_DoesNotPushTheOthersOut)
{
  Random random(6);
  const PivotSimulation stylus;
  PivotCollector collector;
  for (int i = 0; i < 1000; ++i)
  {
    collector.add(stylus.pose(circling(i, 35 * Degree), random));
  }
  const double before = collector.coverage().share();
  for (int i = 0; i < 20000; ++i)
  {
    collector.add(stylus.pose(circling(0, 35 * Degree), random));
  }
  EXPECT_GE(collector.coverage().share(), before);
  EXPECT_TRUE(pointNear(collector.calibrate().tip_Stylus, stylus.tip_Stylus, 0.1));
}

/// Slower than anything that a person would notice, and long after the collection is full: the poses that stay are in the order of time,
/// so that the judgement sees it.
TEST(PivotCollector, TipThatCreeps_IsNoticedHoweverFullTheCollectionIs)
{
  Random random(8);
  PivotSimulation stylus;
  PivotCollector collector;
  const int count = 6000;  // a minute at 100 poses a second
  for (int i = 0; i < count; ++i)
  {
    collector.add(stylus.pose(circling(i, 35 * Degree), random));
    stylus.pivot_Tracker += Eigen::Vector3d(3.0 / count, 0, 0);
  }
  const PivotCalibrationResult result = collector.calibrate();
  EXPECT_TRUE(collector.hasTipMoved() || result.status == PivotCalibrationResult::Status::TipMoved || !collector.isEnough())
    << result.message << ", " << result.rmsMm << " mm";
}

TEST(PivotCollector, AMillionPoses_KeepMemoryFlat)
{
  Random random(7);
  const PivotSimulation stylus;
  PivotCollector collector;
  const auto stream = [&](int from, int to)
  {
    for (int i = from; i < to; ++i)
    {
      Eigen::Isometry3d pose = stylus.pose(circling(i, 35 * Degree), random);
      pose.translation().x() += i % 20 == 3 ? 30 : 0;
      collector.add(pose);
    }
  };
  stream(0, 20000);
  const long long early = heldBytes;
  EXPECT_GT(early, 0) << "the count works";
  stream(20000, 1000000);
  const long long late = heldBytes;
  EXPECT_EQ(collector.counts().total(), 1000000);
  // The estimate's list of rejections differs in length from one time to the next; nothing else may.
  EXPECT_LT(std::abs(late - early), 20000) << early << " and " << late << " bytes";
  EXPECT_LT(late, 2000000);
  EXPECT_LE(collector.poses().size(), 600U);
  EXPECT_TRUE(collector.isEnough()) << collector.estimate().message;
  EXPECT_TRUE(pointNear(collector.estimate().tip_Stylus, stylus.tip_Stylus, 0.1));
}

TEST(PivotCollector, BadOptions_Throw)
{
  PivotCollectorOptions options;
  options.capacity = 30;
  expectInvalidArgument([&] { PivotCollector collector(options); }, { "capacity" });
  options = {};
  options.enoughTipErrorMm = 0;
  expectInvalidArgument([&] { PivotCollector collector(options); }, { "limit" });
}
