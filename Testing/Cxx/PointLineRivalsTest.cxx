// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GeometryMatchers.h"
#include "PointLineSupport.h"

#include <gtest/gtest.h>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Status = PointLineResult::Status;

/// A long lens at 250 mm: 1100 px, 0.5 px of segmentation and 0.4 mm of tracking.
constexpr double SigmaRad = 0.5 / 1100;
constexpr double SigmaMm = 0.4;

PointLineResult solve(const Pairs& pairs)
{
  PointLineOptions options = pointLineOptions(PointLineOptions::Method::MaximumLikelihood, true);
  options.findRivals = true;
  return registerPointsToLines(pairs, options);
}

/// The twin is 25 to 75 deg away; noise alone turns six flat placements by up to 17.
/// Placements nearly in a plane across the line of sight, whose twin turned the other way fits nearly as well.
Pairs flatPairs(const Eigen::Isometry3d& pointsToLines, int count, Random& random)
{
  const View view{ 0.22, 0.17, 245, 255 };
  return viewPairs(pointsToLines, count, view, SigmaMm, SigmaRad, random);
}

double turnDeg(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b)
{
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle() * 180 / EIGEN_PI;
}

}  // namespace

TEST(PointLineRivals, FlatPlacements_AreNeverFarOffAndOk)
{
  Random random(41);
  int ambiguous = 0;
  for (int run = 0; run < 120; ++run)
  {
    const Eigen::Isometry3d truth = random.rigid(100);
    const PointLineResult result = solve(flatPairs(truth, run % 2 ? 15 : 6, random));
    if (result.status == Status::Ok)
    {
      EXPECT_LT(turnDeg(result.pointsToLines, truth), 20) << "run " << run << ": the twin was taken for the solution";
    }
    else if (result.status == Status::Ambiguous)
    {
      ++ambiguous;
      ASSERT_GE(result.solutions.size(), 2U);
      const auto isTruth = [&](const Eigen::Isometry3d& solution) { return turnDeg(solution, truth) < 20; };
      EXPECT_TRUE(std::any_of(result.solutions.begin(), result.solutions.end(), isTruth)) << "run " << run;
    }
  }
  EXPECT_GT(ambiguous, 0) << "such data do leave it open";
}

TEST(PointLineRivals, SpreadPlacements_AreNotAmbiguous)
{
  Random random(42);
  for (int run = 0; run < 60; ++run)
  {
    const Eigen::Isometry3d truth = random.rigid(100);
    const PointLineResult result = solve(viewPairs(truth, 12, run % 2 ? narrowView() : View(), SigmaMm, SigmaRad, random));
    EXPECT_EQ(result.status, Status::Ok) << "run " << run << ": " << result.message;
    EXPECT_LT(turnDeg(result.pointsToLines, truth), 3) << "run " << run;
  }
}

TEST(PointLineRivals, NoiseOfDirectionsWithoutRays_IsRefused)
{
  PointLineOptions options = pointLineOptions(PointLineOptions::Method::MaximumLikelihood, false);
  options.sigmaRad = 0.001;
  Random random(43);
  const Pairs pairs = viewPairs(random.rigid(100), 12, {}, SigmaMm, SigmaRad, random);
  expectInvalidArgument([&] { (void)registerPointsToLines(pairs, options); }, { "rays" });
}
