// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The methods of calibratePivot() side by side.
#include "GeometryMatchers.h"
#include "PivotCalibration.h"
#include "PivotSimulation.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Poses = std::vector<Eigen::Isometry3d>;
using Status = PivotCalibrationResult::Status;

constexpr PivotMethod Classical[] = { PivotMethod::AlgebraicOneStep, PivotMethod::AlgebraicTwoStep, PivotMethod::SphereFit };
constexpr PivotMethod All[] = { PivotMethod::Robust, PivotMethod::AlgebraicOneStep, PivotMethod::AlgebraicTwoStep,
  PivotMethod::SphereFit };

PivotCalibrationResult calibrateBy(PivotMethod method, const Poses& poses, const TrackerNoise& noise = {})
{
  PivotCalibrationOptions options;
  options.method = method;
  options.noise = noise;
  return calibratePivot(poses, options);
}

/// Root mean square distance of the tip from the truth over some recordings.
double tipErrorRms(PivotMethod method, double sigmaMm, double sigmaDeg, int poses, double tilt, unsigned runs)
{
  double squares = 0;
  for (unsigned seed = 0; seed < runs; ++seed)
  {
    Random random(9000 + seed);
    PivotSimulation stylus;
    stylus.sigmaMm = sigmaMm;
    stylus.sigmaRad = sigmaDeg * Degree;
    const PivotCalibrationResult result =
      calibrateBy(method, stylus.recordPivoting(poses, tilt, random), TrackerNoise::fromDegrees(sigmaMm, sigmaDeg));
    EXPECT_TRUE(result.isUsable()) << toString(method) << ": " << result.message;
    squares += (result.tip_Stylus - stylus.tip_Stylus).squaredNorm();
  }
  return std::sqrt(squares / runs);
}

}  // namespace

TEST(PivotMethods, NoiseFree_AgreeWithEachOtherAndWithTheTruth)
{
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    Random random(100 + seed);
    PivotSimulation stylus;
    stylus.tip_Stylus = random.uniform(40, 400) * random.direction();
    stylus.pivot_Tracker = random.uniform3(1500);
    stylus.sigmaMm = stylus.sigmaRad = 0;
    const Poses poses = stylus.recordPivoting(60, random.uniform(20, 50) * Degree, random);
    const Eigen::Vector3d oneStep = calibrateBy(PivotMethod::AlgebraicOneStep, poses).tip_Stylus;
    for (const PivotMethod method : All)
    {
      const PivotCalibrationResult result = calibrateBy(method, poses);
      ASSERT_EQ(result.status, Status::Ok) << toString(method) << ": " << result.message;
      EXPECT_EQ(result.method, method);
      EXPECT_TRUE(pointNear(result.tip_Stylus, oneStep, 1e-6)) << toString(method);
      EXPECT_TRUE(pointNear(result.tip_Stylus, stylus.tip_Stylus, 1e-6)) << toString(method);
      EXPECT_TRUE(pointNear(result.pivot_Tracker, stylus.pivot_Tracker, 1e-6)) << toString(method);
      EXPECT_LT(result.rmsMm, 1e-6);
    }
  }
}

struct NoiseRow
{
  double sigmaMm, sigmaDeg;
  double robustMm, oneStepMm, twoStepMm, sphereMm;  ///< largest root mean square error of the tip that is allowed
};

class PivotNoiseTable : public ::testing::TestWithParam<NoiseRow>
{
};

TEST_P(PivotNoiseTable, TipIsAsNearAsTheNoiseAllows)
{
  // 300 poses over 35 deg, tip 158 mm from the marker. The sphere fit does without the orientations and pays for it.
  const NoiseRow row = GetParam();
  const double allowed[] = { row.robustMm, row.oneStepMm, row.twoStepMm, row.sphereMm };
  for (std::size_t k = 0; k < 4; ++k)
  {
    const double error = tipErrorRms(All[k], row.sigmaMm, row.sigmaDeg, 300, 35 * Degree, 40);
    EXPECT_LT(error, allowed[k]) << toString(All[k]);
    EXPECT_GT(error, 0.2 * allowed[k]) << toString(All[k]) << ": the table is too generous";
  }
}

INSTANTIATE_TEST_SUITE_P(Noise, PivotNoiseTable,
  ::testing::Values(NoiseRow{ 0.03, 0.005, 0.02, 0.02, 0.02, 0.04 }, NoiseRow{ 0.12, 0.025, 0.06, 0.06, 0.06, 0.15 },
    NoiseRow{ 0.3, 0.1, 0.2, 0.2, 0.2, 0.4 }, NoiseRow{ 0.6, 0.3, 0.5, 0.5, 0.5, 0.8 }));

TEST(PivotMethods, NoisyOrientations_ShortenTheLeastSquaresStylusButNotTheRobustOne)
{
  // An electromagnetic tracker's noise and a small tilt: the least squares see noise in their own matrix.
  Eigen::Vector3d oneStep = Eigen::Vector3d::Zero(), robust = Eigen::Vector3d::Zero();
  constexpr unsigned runs = 40;
  for (unsigned seed = 0; seed < runs; ++seed)
  {
    Random random(2000 + seed);
    PivotSimulation stylus;
    stylus.sigmaMm = 0.1;
    stylus.sigmaRad = 0.6 * Degree;
    const Poses poses = stylus.recordPivoting(1000, 20 * Degree, random);
    const TrackerNoise noise = TrackerNoise::fromDegrees(0.1, 0.6);
    oneStep += calibrateBy(PivotMethod::AlgebraicOneStep, poses, noise).tip_Stylus / runs;
    robust += calibrateBy(PivotMethod::Robust, poses, noise).tip_Stylus / runs;
  }
  EXPECT_LT(oneStep.norm(), 157.7) << "of 158.05 mm";
  EXPECT_NEAR(robust.norm(), PivotSimulation().tip_Stylus.norm(), 0.06);
}

TEST(PivotMethods, RightNoiseModel_HelpsTheTip)
{
  const double robust = tipErrorRms(PivotMethod::Robust, 0.05, 0.4, 200, 35 * Degree, 60);
  const double oneStep = tipErrorRms(PivotMethod::AlgebraicOneStep, 0.05, 0.4, 200, 35 * Degree, 60);
  EXPECT_LT(robust, 0.9 * oneStep) << robust << " against " << oneStep << " mm";
}

TEST(PivotMethods, Covariance_IsHonestForEach)
{
  for (const PivotMethod method : All)
  {
    double sum = 0;
    constexpr int runs = 150;
    for (unsigned seed = 0; seed < runs; ++seed)
    {
      Random random(4000 + seed);
      const PivotSimulation stylus;
      const PivotCalibrationResult result = calibrateBy(method, stylus.recordPivoting(200, 35 * Degree, random));
      const Eigen::Vector3d error = result.tip_Stylus - stylus.tip_Stylus;
      sum += error.dot(result.tipCovariance.inverse() * error);
    }
    // Three degrees of freedom: the mean of 150 is 3 with a standard deviation of 0.2.
    EXPECT_GT(sum / runs, 2.2) << toString(method);
    EXPECT_LT(sum / runs, 4.0) << toString(method);
  }
}

TEST(PivotMethods, NoiseFactor_IsTheNoiseOverThatOfTheModel)
{
  Random random(5);
  PivotSimulation stylus;
  stylus.sigmaMm *= 2;
  stylus.sigmaRad *= 2;
  for (const PivotMethod method : { PivotMethod::Robust, PivotMethod::AlgebraicOneStep })
  {
    EXPECT_NEAR(calibrateBy(method, stylus.recordPivoting(1000, 35 * Degree, random)).noiseFactor, 2, 0.1) << toString(method);
  }
}

TEST(PivotMethods, SpinAboutOneAxis_IsRefusedByEach)
{
  for (const PivotMethod method : All)
  {
    Random random(6);
    const auto spin = [&] { return rotationFromVector({ 0, 0, random.uniform(-3, 3) }); };
    const PivotCalibrationResult result = calibrateBy(method, PivotSimulation().record(300, spin, random));
    EXPECT_EQ(result.status, Status::RotationAboutOneAxis) << toString(method);
    EXPECT_TRUE(says(result.message, { "about one axis only", "its z axis", "4 mm from its marker" })) << toString(method);
  }
}

TEST(PivotMethods, ClassicalOnes_TakeAllPosesAndSayThatTheyAreNoisy)
{
  Random random(7);
  Poses poses = PivotSimulation().recordPivoting(300, 35 * Degree, random);
  for (std::size_t i = 0; i < poses.size(); i += 10)
  {
    poses[i].translation() += 60 * random.direction();
  }
  for (const PivotMethod method : Classical)
  {
    const PivotCalibrationResult result = calibrateBy(method, poses);
    EXPECT_FALSE(result.isUsable()) << toString(method);
    EXPECT_EQ(result.used.size(), 300U);
  }
  EXPECT_TRUE(calibrateBy(PivotMethod::Robust, poses).isUsable());
}

TEST(PivotMethods, ToString_NamesEachDifferently)
{
  std::set<std::string> names;
  for (const PivotMethod method : All)
  {
    names.insert(toString(method));
  }
  EXPECT_EQ(names, (std::set<std::string>{ "robust", "algebraic-one-step", "algebraic-two-step", "sphere-fit" }));
}
