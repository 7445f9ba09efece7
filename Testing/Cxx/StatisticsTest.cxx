// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Statistics.h"

#include "GeometryMatchers.h"
#include "Simulation.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace handeye;
using namespace handeye::test;

TEST(Statistics, Median_TakesTheMiddleOrTheLowerOfTwo)
{
  EXPECT_EQ(median({ 7 }), 7);
  EXPECT_EQ(median({ 9, -1, 4 }), 4);
  EXPECT_EQ(median({ 8, 1, 3, 2 }), 2);
  EXPECT_EQ(median({ 5, 5, 5, 1000 }), 5);
}

TEST(Statistics, MedianOfNothing_Throws)
{
  expectInvalidArgument([] { (void)median({}); }, { "median" });
}

TEST(Statistics, Summary_OfKnownNumbers)
{
  const Summary summary = summarize({ 3, 4, 0, 5 });
  EXPECT_EQ(summary.count, 4);
  EXPECT_DOUBLE_EQ(summary.mean, 3);
  EXPECT_DOUBLE_EQ(summary.rms, std::sqrt(12.5));
  EXPECT_DOUBLE_EQ(summary.standardDeviation, std::sqrt(14.0 / 3));
  EXPECT_EQ(summary.minimum, 0);
  EXPECT_EQ(summary.maximum, 5);
}

TEST(Statistics, Summary_OfOneAndOfNoNumber)
{
  const Summary one = summarize({ 2.5 });
  EXPECT_EQ(one.count, 1);
  EXPECT_EQ(one.mean, 2.5);
  EXPECT_EQ(one.standardDeviation, 0);
  EXPECT_EQ(one.rms, 2.5);
  const Summary none = summarize({});
  EXPECT_EQ(none.count, 0);
  EXPECT_EQ(none.rms, 0);
  EXPECT_EQ(none.maximum, 0);
}

TEST(Statistics, Summary_KeepsTheDeviationOfLargeNumbers)
{
  EXPECT_NEAR(summarize({ 1e9 + 1, 1e9 + 2, 1e9 + 3 }).standardDeviation, 1, 1e-6);
}

TEST(Statistics, MedianConstants_AreThoseOfNormalNumbers)
{
  Random random(11);
  std::vector<double> one, two, three;
  for (int i = 0; i < 40000; ++i)
  {
    const Eigen::Vector3d vector = random.normal3(1);
    one.push_back(std::abs(vector.x()));
    two.push_back(vector.head<2>().norm());
    three.push_back(vector.norm());
  }
  EXPECT_NEAR(median(one), MedianOfChi1, 0.015);
  EXPECT_NEAR(median(two), MedianOfChi2, 0.015);
  EXPECT_NEAR(median(three), MedianOfChi3, 0.015);
}
