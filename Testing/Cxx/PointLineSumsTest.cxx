// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointLineSums.h"

#include "GeometryMatchers.h"
#include "PointLineMethods.h"
#include "PointLineSupport.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace
{

using namespace handeye;
using namespace handeye::test;

/// Pairs that fill blocks and pairs that leave rests of them.
const std::vector<int> Counts = { 1, 2, 7, 15, 16, 17, 31, 32, 33, 100 };

/// The same sums, pair by pair.
PointLineSums sumPlainly(const Pairs& pairs)
{
  PointLineSums sums;
  for (const PointLinePair& pair : pairs)
  {
    sums.totalWeight += pair.weight;
    sums.centroid_Points += pair.weight * pair.point_Points;
    sums.hasCommonOrigin = sums.hasCommonOrigin && pair.origin_Lines == pairs.front().origin_Lines;
  }
  sums.centroid_Points /= sums.totalWeight;
  for (const PointLinePair& pair : pairs)
  {
    const Eigen::Vector3d x = pair.point_Points - sums.centroid_Points, d = pair.direction_Lines.normalized();
    const Eigen::Matrix3d across = pair.weight * (Eigen::Matrix3d::Identity() - d * d.transpose());
    Eigen::Matrix<double, 6, 1> packed;
    packed << across(0, 0), across(0, 1), across(0, 2), across(1, 1), across(1, 2), across(2, 2);
    Eigen::Matrix<double, 10, 1> products;
    products << 1, x, x(0) * x(0), x(0) * x(1), x(0) * x(2), x(1) * x(1), x(1) * x(2), x(2) * x(2);
    sums.products += packed * products.transpose();
  }
  return sums;
}

Pairs weightedPairs(int count, bool haveCommonOrigin, Random& random)
{
  const Eigen::Isometry3d pose = random.rigid(100);
  Pairs pairs = haveCommonOrigin ? viewPairs(pose, count, {}, 0.3, 0.001, random) : skewPairs(pose, count, 0.3, random);
  for (PointLinePair& pair : pairs)
  {
    pair.weight = random.uniform(0.1, 3);
    pair.direction_Lines *= random.uniform(0.5, 20);
  }
  return pairs;
}

void expectSame(const PointLineSums& sums, const PointLineSums& plain, double tolerance)
{
  EXPECT_LT((sums.centroid_Points - plain.centroid_Points).norm(), tolerance * (1 + plain.centroid_Points.norm()));
  EXPECT_NEAR(sums.totalWeight, plain.totalWeight, tolerance * plain.totalWeight);
  EXPECT_EQ(sums.hasCommonOrigin, plain.hasCommonOrigin);
  const double spread = std::sqrt(plain.products.rightCols<6>().norm() / plain.products.col(0).norm());
  const double scales[3] = { 1, spread, spread * spread };
  for (int column = 0; column < 10; ++column)
  {
    const double scale = plain.products.col(0).norm() * scales[column == 0 ? 0 : column < 4 ? 1 : 2];
    EXPECT_LE((sums.products.col(column) - plain.products.col(column)).norm(), tolerance * scale) << "column " << column;
  }
}

TEST(PointLineSums, Blocks_SumToWhatThePairsSumTo)
{
  Random random(1);
  for (const int count : Counts)
  {
    for (const bool haveCommonOrigin : { true, false })
    {
      SCOPED_TRACE(count);
      const Pairs pairs = weightedPairs(count, haveCommonOrigin, random);
      expectSame(sumPairs(pairs), sumPlainly(pairs), 1e-12);
    }
  }
}

TEST(PointLineSums, FirstPointsFarFromTheRest_CostNoDigits)
{
  // All the weight lies in points close together, and the first block is a kilometre away from them.
  Random random(2);
  Pairs pairs = weightedPairs(40, true, random);
  for (int i = 0; i < 16; ++i)
  {
    pairs[std::size_t(i)].point_Points += Eigen::Vector3d(1e6, -2e6, 1e6);
    pairs[std::size_t(i)].weight = 1e-18;
  }
  expectSame(sumPairs(pairs), sumPlainly(pairs), 1e-9);
}

TEST(PointLineSums, OneOtherOrigin_IsNoticedWhereverItIs)
{
  Random random(3);
  for (const int place : { 1, 15, 16, 31, 32 })
  {
    Pairs pairs = weightedPairs(33, true, random);
    ASSERT_TRUE(sumPairs(pairs).hasCommonOrigin);
    pairs[std::size_t(place)].origin_Lines.y() = 1e-9;
    EXPECT_FALSE(sumPairs(pairs).hasCommonOrigin) << place;
  }
}

TEST(PointLineSums, BadNumber_IsNamedWhereverItIs)
{
  Random random(4);
  const Pairs good = weightedPairs(37, true, random);
  const std::vector<std::function<void(PointLinePair&)>> damages = {
    [](PointLinePair& pair) { pair.point_Points.z() = std::nan(""); },
    [](PointLinePair& pair) { pair.point_Points.x() = -INFINITY; },
    [](PointLinePair& pair) { pair.origin_Lines.x() = std::nan(""); },
    [](PointLinePair& pair) { pair.direction_Lines.y() = INFINITY; },
    [](PointLinePair& pair) { pair.direction_Lines.setZero(); },
    [](PointLinePair& pair) { pair.weight = 0; },
    [](PointLinePair& pair) { pair.weight = -1; },
    [](PointLinePair& pair) { pair.weight = std::nan(""); },
  };
  for (const int place : { 0, 7, 15, 16, 32, 36 })
  {
    for (const auto& damage : damages)
    {
      Pairs pairs = good;
      damage(pairs[std::size_t(place)]);
      damage(pairs.back());
      expectInvalidArgument([&] { (void)sumPairs(pairs); }, { "point and line " + std::to_string(place + 1) + ":", "finite" });
    }
  }
  for (PointLinePair pair : good)
  {
    pair.origin_Lines.setConstant(INFINITY);
    expectInvalidArgument([&] { (void)sumPairs(Pairs(3, pair)); }, { "point and line 1:" });
  }
}

TEST(PointLineSums, Distances_AreThoseOfEachPairAlone)
{
  Random random(5);
  for (const int count : Counts)
  {
    for (const bool haveCommonOrigin : { true, false })
    {
      const Pairs pairs = weightedPairs(count, haveCommonOrigin, random);
      const Eigen::Isometry3d pose = random.rigid(100);
      std::vector<double> distances(pairs.size());
      const PointLineDistances all = measureDistances(pairs, pose, haveCommonOrigin, distances);
      double squares = 0;
      for (std::size_t i = 0; i < pairs.size(); ++i)
      {
        const double distance = offsetFromLine(pairs[i], pose).norm();
        EXPECT_NEAR(distances[i], distance, 1e-10 * (1 + distance)) << "pair " << i << " of " << count;
        squares += distance * distance;
      }
      EXPECT_NEAR(all.squaresMm2, squares, 1e-10 * squares);
      EXPECT_EQ(int(all.inFront), pointsInFront(pairs, pose));
    }
  }
}

}  // namespace
