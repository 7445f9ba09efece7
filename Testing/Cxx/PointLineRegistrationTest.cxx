// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointLineRegistration.h"

#include "GeometryMatchers.h"
#include "PointLineSupport.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Method = PointLineOptions::Method;
using Status = PointLineResult::Status;

PointLineResult solveGlobally(const Pairs& pairs, bool linesAreRays)
{
  return registerPointsToLines(pairs, pointLineOptions(Method::Global, linesAreRays));
}

}  // namespace

TEST(PointLineRegistration, KnownTransform_OfAKnownPoint)
{
  // Lines along the axes through the corners that a quarter turn about z and a shift of (10, 20, 30) put there.
  const Pairs pairs = { { { 1, 0, 0 }, { 10, 21, 0 }, { 0, 0, 5 }, 1 }, { { 0, 2, 0 }, { 0, 20, 30 }, { -1, 0, 0 }, 1 },
    { { 0, 0, 3 }, { 10, 0, 33 }, { 0, 2, 0 }, 1 }, { { 1, 2, 3 }, { 8, 21, 0 }, { 0, 0, 1 }, 1 },
    { { 4, -1, 1 }, { 0, 24, 31 }, { 1, 0, 0 }, 1 } };
  const PointLineResult result = solveGlobally(pairs, false);
  ASSERT_EQ(result.status, Status::Ok) << result.message;
  EXPECT_TRUE(pointNear(result.pointsToLines * Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(8, 21, 33), 1e-9));
}

TEST(PointLineRegistration, RaysThroughOneCentre_NoiseFreeIsExact)
{
  Random random(1);
  for (int run = 0; run < 100; ++run)
  {
    const Eigen::Isometry3d truth = random.rigid(100);
    const View view = run % 2 ? narrowView() : View{};
    const PointLineResult result = solveGlobally(viewPairs(truth, random.integer(6, 15), view, 0, 0, random), true);
    ASSERT_EQ(result.status, Status::Ok) << result.message;
    ASSERT_TRUE(rigid3dNear(result.pointsToLines, truth, 1e-9, 1e-9));
    ASSERT_LT(result.rmsMm, 1e-9);
  }
}

TEST(PointLineRegistration, SkewLines_NoiseFreeIsExact)
{
  Random random(2);
  for (int run = 0; run < 100; ++run)
  {
    const Eigen::Isometry3d truth = random.rigid(100);
    const PointLineResult result = solveGlobally(skewPairs(truth, random.integer(6, 20), 0, random), false);
    ASSERT_EQ(result.status, Status::Ok) << result.message;
    ASSERT_TRUE(rigid3dNear(result.pointsToLines, truth, 1e-9, 1e-9));
  }
}

TEST(PointLineRegistration, Procrustes_NoiseFreeConvergesToTheTruth)
{
  Random random(3);
  for (int run = 0; run < 30; ++run)
  {
    const Eigen::Isometry3d truth = random.rigid(100);
    const PointLineResult result =
      registerPointsToLines(viewPairs(truth, 15, {}, 0, 0, random), pointLineOptions(Method::Procrustes, true));
    ASSERT_EQ(result.status, Status::Ok) << result.message;
    // It converges linearly and stops when the distance changes by less than 1e-12 mm: it ends a little short of the minimum.
    ASSERT_TRUE(rigid3dNear(result.pointsToLines, truth, 1e-9, 1e-7));
  }
}

TEST(PointLineRegistration, IdentityAndNearPiRotations_AreExact)
{
  constexpr double pi = EIGEN_PI;
  Random random(4);
  for (const double angle : { 0.0, 1e-8, 1e-4, pi / 2, pi - 1e-4, pi - 1e-8, pi })
  {
    for (int axis = 0; axis < 6; ++axis)
    {
      const Eigen::Vector3d direction = axis < 3 ? Eigen::Vector3d::Unit(axis) : random.direction();
      const Eigen::Isometry3d truth = makeRigid(angle * direction, { 5, -40, 12 });
      const PointLineResult rays = solveGlobally(viewPairs(truth, 12, {}, 0, 0, random), true);
      EXPECT_TRUE(rays.isUsable() && rigid3dNear(rays.pointsToLines, truth, 1e-9, 1e-9)) << angle << " rad: " << rays.message;
      const PointLineResult lines = solveGlobally(skewPairs(truth, 12, 0, random), false);
      EXPECT_TRUE(lines.isUsable() && rigid3dNear(lines.pointsToLines, truth, 1e-9, 1e-9)) << angle << " rad: " << lines.message;
    }
  }
}

TEST(PointLineRegistration, ChangeOfFrames_ChangesTheResultAlike)
{
  Random random(5);
  for (int run = 0; run < 20; ++run)
  {
    const Pairs pairs = viewPairs(random.rigid(100), 12, {}, 0.5, 0.0005, random);
    const Eigen::Isometry3d newPointsToPoints = random.rigid(500), linesToNewLines = random.rigid(500);
    Pairs moved = pairs;
    for (PointLinePair& pair : moved)
    {
      pair.point_Points = newPointsToPoints.inverse() * pair.point_Points;
      pair.origin_Lines = linesToNewLines * pair.origin_Lines;
      pair.direction_Lines = linesToNewLines.linear() * pair.direction_Lines;
    }
    const PointLineResult here = solveGlobally(pairs, true), there = solveGlobally(moved, true);
    ASSERT_TRUE(here.isUsable() && there.isUsable());
    const Eigen::Isometry3d pointsToNewLines = linesToNewLines * here.pointsToLines;
    ASSERT_TRUE(rigid3dNear(there.pointsToLines, pointsToNewLines * newPointsToPoints, 1e-9, 1e-6));
    ASSERT_NEAR(there.rmsMm, here.rmsMm, 1e-9);
    ASSERT_NEAR(there.conditionNumber / here.conditionNumber, 1, 1e-6);
  }
}

TEST(PointLineRegistration, ScaledData_ScaleTheTranslationAlone)
{
  Random random(6);
  const Pairs pairs = skewPairs(random.rigid(100), 12, 0.5, random);
  const PointLineResult plain = solveGlobally(pairs, false);
  for (const double scale : { 1e-3, 1e3 })
  {
    Pairs scaled = pairs;
    for (PointLinePair& pair : scaled)
    {
      pair.point_Points *= scale;
      pair.origin_Lines *= scale;
      pair.direction_Lines *= -7 * scale;  // any length and sign but zero is the same line
    }
    const PointLineResult result = solveGlobally(scaled, false);
    ASSERT_TRUE(result.isUsable()) << result.message;
    Eigen::Isometry3d unscaled = result.pointsToLines;
    unscaled.translation() /= scale;
    EXPECT_TRUE(rigid3dNear(unscaled, plain.pointsToLines, 1e-9, 1e-7));
    EXPECT_NEAR(result.rmsMm / scale, plain.rmsMm, 1e-9);
  }
}

TEST(PointLineRegistration, Noise_EndsInTheMinimumThatBruteForceFinds)
{
  Random random(7);
  for (int run = 0; run < 30; ++run)
  {
    const bool isBundle = run % 3 != 2;
    const Eigen::Isometry3d truth = random.rigid(100);
    const View view = run % 3 == 0 ? View{} : narrowView();
    Pairs pairs = isBundle ? viewPairs(truth, random.integer(5, 15), view, 0.5, 0.001, random) : skewPairs(truth, 10, 2, random);
    for (PointLinePair& pair : pairs)
    {
      pair.weight = random.uniform(0.2, 5);
    }
    const PointLineResult result = solveGlobally(pairs, isBundle);
    const Eigen::Isometry3d expected = bruteForceMinimum(pairs, isBundle, 40, random);
    ASSERT_TRUE(result.isUsable()) << result.message;
    const double lowest = pointLineCost(pairs, expected);
    ASSERT_NEAR(pointLineCost(pairs, result.pointsToLines), lowest, 1e-6 * lowest) << "run " << run;
    ASSERT_TRUE(rigid3dNear(result.pointsToLines, expected, 1e-6, 1e-4)) << "run " << run;
  }
}

TEST(PointLineRegistration, PointsNearlyOnALine_StillEndInTheMinimum)
{
  Random random(8);
  for (const double lateralMm : { 0.3, 1.0, 3.0 })
  {
    Pairs pairs;
    const Eigen::Isometry3d truth = random.rigid(100);
    const Eigen::Vector3d along(0.5, -0.3, 0.8);
    for (int i = 0; i < 12; ++i)
    {
      const Eigen::Vector3d point_Lines =
        Eigen::Vector3d(20, -10, 400) + random.uniform(-200, 200) * along + random.normal3(lateralMm);
      pairs.push_back({ truth.inverse() * point_Lines + random.normal3(0.1), Eigen::Vector3d::Zero(), point_Lines, 1 });
    }
    const PointLineResult result = solveGlobally(pairs, true);
    ASSERT_TRUE(result.isUsable()) << result.message;
    EXPECT_TRUE(rigid3dNear(descendPlainly(pairs, result.pointsToLines), result.pointsToLines, 1e-6, 1e-3)) << lateralMm;
    const double lowest = pointLineCost(pairs, bruteForceMinimum(pairs, true, 30, random));
    EXPECT_LE(pointLineCost(pairs, result.pointsToLines), lowest * (1 + 1e-6)) << lateralMm;
  }
}

TEST(PointLineRegistration, Procrustes_ReachesTheSameMinimumWhereItIsNotMirrored)
{
  Random random(9);
  for (int run = 0; run < 50; ++run)
  {
    const Pairs pairs = viewPairs(random.rigid(100), 15, {}, 0.4, 0.0005, random);
    const PointLineResult global = solveGlobally(pairs, true);
    const PointLineResult procrustes = registerPointsToLines(pairs, pointLineOptions(Method::Procrustes, true));
    ASSERT_TRUE(global.isUsable() && procrustes.isUsable()) << procrustes.message;
    ASSERT_NEAR(procrustes.rmsMm, global.rmsMm, 1e-9);
    ASSERT_TRUE(rigid3dNear(procrustes.pointsToLines, global.pointsToLines, 1e-6, 1e-4));
  }
}

TEST(PointLineRegistration, NoiseToleranceTable_HoldsForEachMethod)
{
  struct Row
  {
    const char* view;
    double sigmaMm, sigmaRad;
    double rotationRmsRad, translationRmsMm;  // over 60 runs of 15 pairs
  };
  const Row rows[] = { { "wide", 0.1, 0.0004, 0.0009, 0.4 }, { "wide", 0.35, 0.0004, 0.0016, 0.75 },
    { "wide", 1.0, 0.0004, 0.0042, 2.0 }, { "narrow", 0.1, 0.0002, 0.002, 0.37 }, { "narrow", 0.35, 0.0002, 0.0065, 1.2 },
    { "narrow", 1.0, 0.0002, 0.019, 3.5 }, { "skew", 0.35, 0, 0.002, 0.36 }, { "skew", 1.0, 0, 0.0058, 1.1 } };
  for (const Method method : { Method::Global, Method::Procrustes })
  {
    for (const Row& row : rows)
    {
      const bool isSkew = row.view == std::string("skew");
      const View view = row.view == std::string("narrow") ? narrowView() : View{};
      Random random(10);
      double turned = 0, moved = 0;
      int usable = 0;
      for (int run = 0; run < 60; ++run)
      {
        const Eigen::Isometry3d truth = random.rigid(100);
        const Pairs pairs =
          isSkew ? skewPairs(truth, 15, row.sigmaMm, random) : viewPairs(truth, 15, view, row.sigmaMm, row.sigmaRad, random);
        const PointLineResult result = registerPointsToLines(pairs, pointLineOptions(method, !isSkew));
        usable += result.isUsable() ? 1 : 0;
        turned += result.isUsable() ? std::pow(rotationErrorRad(result.pointsToLines, truth), 2) : 0;
        moved += result.isUsable() ? std::pow(translationErrorMm(result.pointsToLines, truth), 2) : 0;
      }
      SCOPED_TRACE(std::string(row.view) + ", " + std::to_string(row.sigmaMm) + " mm, method " + std::to_string(int(method)));
      EXPECT_GE(usable, method == Method::Global ? 60 : 55);
      EXPECT_LT(std::sqrt(turned / usable), row.rotationRmsRad);
      EXPECT_LT(std::sqrt(moved / usable), row.translationRmsMm);
    }
  }
}

TEST(PointLineRegistration, NarrowView_GlobalNeverEndsMirroredOrFarAway)
{
  Random random(11);
  for (int run = 0; run < 2000; ++run)
  {
    const Eigen::Isometry3d truth = random.rigid(100);
    const Pairs pairs = viewPairs(truth, random.integer(6, 15), narrowView(), 0.35, 0.25 / 1100, random);
    const PointLineResult result = solveGlobally(pairs, true);
    ASSERT_EQ(result.status, Status::Ok) << "run " << run << ": " << result.message;
    ASSERT_EQ(pointsInFront(pairs, result.pointsToLines), int(pairs.size())) << "run " << run;
    ASSERT_LT(rotationErrorRad(result.pointsToLines, truth), 0.15) << "run " << run;
    ASSERT_LE(pointLineCost(pairs, result.pointsToLines), pointLineCost(pairs, truth)) << "run " << run;
  }
}

TEST(PointLineRegistration, Weights_AreHonoured)
{
  Random random(12);
  const Eigen::Isometry3d truth = random.rigid(100);
  Pairs pairs = viewPairs(truth, 10, {}, 0, 0, random);
  pairs[3].point_Points += Eigen::Vector3d(25, -30, 40);
  EXPECT_GT(rotationErrorRad(solveGlobally(pairs, true).pointsToLines, truth), 1e-3);
  pairs[3].weight = 1e-9;
  const PointLineResult result = solveGlobally(pairs, true);
  EXPECT_TRUE(rigid3dNear(result.pointsToLines, truth, 1e-9, 1e-6));
  EXPECT_GT(result.residualsMm[3], 10) << "residuals are distances, whatever their weight";
  EXPECT_NEAR(result.rmsMm, result.residualsMm[3] / std::sqrt(10), 1e-6) << "the RMS is not weighted";
}

TEST(PointLineRegistration, WholeWeights_CountLikeRepeatedPairs)
{
  Random random(13);
  Pairs weighted = viewPairs(random.rigid(100), 8, {}, 1, 0, random);
  Pairs repeated = weighted;
  weighted[2].weight = 3;
  repeated.push_back(repeated[2]);
  repeated.push_back(repeated[2]);
  EXPECT_TRUE(rigid3dNear(solveGlobally(weighted, true).pointsToLines, solveGlobally(repeated, true).pointsToLines, 1e-9, 1e-7));
}

TEST(PointLineRegistration, Residuals_AreDistancesToTheLines)
{
  Random random(14);
  const Pairs pairs = skewPairs(random.rigid(100), 9, 1, random);
  const PointLineResult result = solveGlobally(pairs, false);
  double squares = 0;
  ASSERT_EQ(result.residualsMm.size(), pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    EXPECT_NEAR(result.residualsMm[i], std::sqrt(pointLineCost({ pairs[i] }, result.pointsToLines)), 1e-9);
    squares += result.residualsMm[i] * result.residualsMm[i];
  }
  EXPECT_NEAR(result.rmsMm, std::sqrt(squares / 9), 1e-12);
}

TEST(PointLineRegistration, InformationMatrix_IsHalfTheSecondDerivative)
{
  Random random(15);
  const Eigen::Isometry3d truth = random.rigid(100);
  Pairs pairs = skewPairs(truth, 9, 0, random);  // without noise, for then the residuals' own curvature has no part in it
  pairs[4].weight = 2.5;
  const Eigen::Matrix<double, 6, 6> information = informationMatrix(pairs, truth);
  const Eigen::Matrix<double, 6, 1> step = (Eigen::Matrix<double, 6, 1>() << 1e-4, 1e-4, 1e-4, 1e-2, 1e-2, 1e-2).finished();
  const auto costAt = [&](int i, double a, int k, double b)
  {
    Eigen::Matrix<double, 6, 1> motion = Eigen::Matrix<double, 6, 1>::Zero();
    motion(i) += a * step(i);
    motion(k) += b * step(k);
    Eigen::Isometry3d moved = truth;
    moved.linear() = rotationFromVector(motion.head<3>()) * truth.linear();
    moved.translation() += motion.tail<3>();
    return pointLineCost(pairs, moved);
  };
  for (int i = 0; i < 6; ++i)
  {
    for (int k = 0; k < 6; ++k)
    {
      const double second =
        (costAt(i, 1, k, 1) - costAt(i, 1, k, -1) - costAt(i, -1, k, 1) + costAt(i, -1, k, -1)) / (4 * step(i) * step(k));
      const double size = std::sqrt(information(i, i) * information(k, k));
      EXPECT_NEAR(information(i, k), second / 2, 1e-5 * size) << i << ", " << k;
    }
  }
}
