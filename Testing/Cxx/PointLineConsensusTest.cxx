// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GeometryMatchers.h"
#include "PointLineSupport.h"

#include <gtest/gtest.h>

using namespace handeye;
using namespace handeye::test;

namespace
{

constexpr double SigmaMm = 0.4;

PointLineResult registerWithRejection(const Pairs& pairs)
{
  PointLineOptions options;
  options.linesAreRays = true;
  options.rejectOutliers = true;
  return registerPointsToLines(pairs, options);
}

}  // namespace

TEST(PointLineConsensus, OneGrossErrorAmongMany_IsNamed)
{
  struct Case
  {
    int count;
    double sigmas;  ///< of the error
  };
  for (const Case& one : { Case{ 15, 25 }, Case{ 30, 12 }, Case{ 100, 12 }, Case{ 300, 12 } })
  {
    Random random(31);
    for (int run = 0; run < 5; ++run)
    {
      const Eigen::Isometry3d truth = random.rigid(100);
      Pairs pairs = viewPairs(truth, one.count, {}, SigmaMm, 0, random);
      const std::size_t wrong = std::size_t(random.integer(0, one.count - 1));
      // Across the ray: an error along it is none.
      const Eigen::Vector3d across_Lines = pairs[wrong].direction_Lines.normalized().unitOrthogonal();
      pairs[wrong].point_Points += truth.linear().transpose() * (one.sigmas * SigmaMm * across_Lines);
      const PointLineResult result = registerWithRejection(pairs);
      ASSERT_TRUE(result.isUsable()) << result.message;
      EXPECT_EQ(result.rejected, std::vector<int>{ int(wrong) }) << one.count << " pairs, run " << run;
    }
  }
}

TEST(PointLineConsensus, NoiseAlone_RejectsNothing)
{
  Random random(32);
  for (const int count : { 8, 12, 30, 100, 300 })
  {
    for (int run = 0; run < 10; ++run)
    {
      const PointLineResult result = registerWithRejection(viewPairs(random.rigid(100), count, {}, SigmaMm, 0, random));
      ASSERT_TRUE(result.isUsable()) << result.message;
      EXPECT_EQ(result.rejected, std::vector<int>()) << count << " pairs, run " << run;
    }
  }
}
