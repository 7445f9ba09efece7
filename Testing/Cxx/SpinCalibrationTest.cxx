// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SpinCalibration.h"

#include "GeometryMatchers.h"
#include "PivotSimulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Poses = std::vector<Eigen::Isometry3d>;
using Status = SpinCalibrationResult::Status;

/// A stylus whose shaft runs askew of its own axes, spun in the fingers with its tip in a divot.
struct SpinSimulation : PivotSimulation
{
  Eigen::Vector3d shaft_Stylus = Eigen::Vector3d(0.12, -0.08, 1).normalized();
  double reach = 90 * Degree;
  double wobble = 2 * Degree;

  Poses spun(int count, Random& random) const
  {
    const Eigen::Matrix3d held = rotationFromVector({ 0.3, -0.4, 1.1 });
    return this->record(
      count,
      [&]
      {
        const Eigen::Vector3d lean = random.normal3(wobble);
        return Eigen::Matrix3d(held * rotationFromVector(lean) * rotationFromVector(random.uniform(-reach, reach) * shaft_Stylus));
      },
      random);
  }
};

double degreesBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  return std::atan2(a.cross(b).norm(), a.dot(b)) / Degree;
}

}  // namespace

TEST(SpinCalibration, NoiseFree_IsExact)
{
  for (unsigned seed = 0; seed < 10; ++seed)
  {
    Random random(seed);
    SpinSimulation stylus;
    stylus.sigmaMm = stylus.sigmaRad = stylus.wobble = 0;
    stylus.shaft_Stylus = random.direction();
    stylus.tip_Stylus = -150 * stylus.shaft_Stylus + 3 * random.direction();
    const SpinCalibrationResult result = calibrateSpin(stylus.spun(60, random), stylus.tip_Stylus);
    ASSERT_EQ(result.status, Status::Ok) << result.message;
    EXPECT_TRUE(pointNear(result.shaft_Stylus, stylus.shaft_Stylus, 1e-7)) << "from the tip along the shaft";
    ASSERT_TRUE(result.tipToAxisMm);
    EXPECT_NEAR(*result.tipToAxisMm, 0, 1e-5) << "spun about a line through the tip, which rests";
  }
}

TEST(SpinCalibration, TipFrame_HasItsOriginInTheTipAndMinusZAlongTheShaft)
{
  Random random(1);
  const SpinSimulation stylus;
  const SpinCalibrationResult result = calibrateSpin(stylus.spun(300, random), stylus.tip_Stylus);
  ASSERT_EQ(result.status, Status::Ok) << result.message;
  const Eigen::Isometry3d& frame = result.stylusTipToStylus;
  EXPECT_TRUE(pointNear(frame * Eigen::Vector3d(0, 0, 0), stylus.tip_Stylus, 1e-12));
  EXPECT_TRUE(pointNear(frame * Eigen::Vector3d(0, 0, -150), stylus.tip_Stylus + 150 * stylus.shaft_Stylus, 1.2));
  EXPECT_LT((frame * Eigen::Vector3d(0, 0, -150)).norm(), 30) << "towards the marker, which is near the shaft's other end";
  EXPECT_NEAR(frame.linear().determinant(), 1, 1e-12);
  EXPECT_LT((frame.linear() * frame.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_TRUE(pointNear(tipFrame({ 1, 2, 3 }, { 0, 0, 5 }) * Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 2, 4), 1e-12));
}

TEST(SpinCalibration, NoiseAndWobble_LeaveAFewTenthsOfADegree)
{
  for (unsigned seed = 0; seed < 30; ++seed)
  {
    Random random(100 + seed);
    const SpinSimulation stylus;
    Poses poses = stylus.spun(300, random);
    for (std::size_t i = 0; i < poses.size(); i += 20)
    {
      poses[i].linear() = rotationFromVector(random.normal3(0.4)) * poses[i].linear();
    }
    poses.insert(poses.end(), 100, poses[5]);
    const SpinCalibrationResult result = calibrateSpin(poses, stylus.tip_Stylus);
    ASSERT_EQ(result.status, Status::Ok) << result.message;
    EXPECT_LT(degreesBetween(result.shaft_Stylus, stylus.shaft_Stylus), 0.7) << seed;
    EXPECT_GE(result.rejected.size(), 110U) << "repeated ones and most of the wrong ones";
    EXPECT_EQ(result.used.size() + result.rejected.size(), poses.size());
    EXPECT_NEAR(result.wobble / Degree, std::sqrt(2.0) * 2, 0.8);
  }
}

TEST(SpinCalibration, StandardError_IsHonest)
{
  double squares = 0, predicted = 0;
  constexpr unsigned runs = 100;
  for (unsigned seed = 0; seed < runs; ++seed)
  {
    Random random(500 + seed);
    const SpinSimulation stylus;
    const SpinCalibrationResult result = calibrateSpin(stylus.spun(200, random), stylus.tip_Stylus);
    squares += std::pow(degreesBetween(result.shaft_Stylus, stylus.shaft_Stylus) * Degree, 2) / runs;
    predicted += std::pow(result.shaftSigma, 2) / runs;
  }
  EXPECT_NEAR(std::sqrt(squares / predicted), 1, 0.35);
}

TEST(SpinCalibration, BentStylus_ShowsInTheTipsDistanceFromTheAxis)
{
  Random random(2);
  SpinSimulation stylus;
  stylus.wobble = 0.2 * Degree;
  // Spun in a guide: the axis rests, the bent tip runs round it.
  Poses poses;
  const Eigen::Vector3d bend(4, 0, 0);
  for (const Eigen::Isometry3d& pose : stylus.spun(200, random))
  {
    poses.push_back(pose);
  }
  const Eigen::Vector3d bentTip = stylus.tip_Stylus + bend - bend.dot(stylus.shaft_Stylus) * stylus.shaft_Stylus;
  const SpinCalibrationResult result = calibrateSpin(poses, bentTip);
  ASSERT_TRUE(result.tipToAxisMm);
  EXPECT_NEAR(*result.tipToAxisMm, 4, 0.4);
}

TEST(SpinCalibration, PivotingOrSwinging_IsNoSpin)
{
  Random random(3);
  const PivotSimulation stylus;
  const SpinCalibrationResult pivoted = calibrateSpin(stylus.recordPivoting(300, 35 * Degree, random), stylus.tip_Stylus);
  EXPECT_FALSE(pivoted.isUsable()) << pivoted.message;
  const auto swing = [&] { return rotationFromVector({ random.uniform(-0.8, 0.8), 0, 0 }); };
  const SpinCalibrationResult swung = calibrateSpin(stylus.record(300, swing, random), stylus.tip_Stylus);
  EXPECT_EQ(swung.status, Status::UnclearDirection) << swung.message;
  EXPECT_TRUE(says(swung.message, { "not spun about its shaft", "deg" }));
}

TEST(SpinCalibration, HardlyAnySpinAndTooFewPoses_AreReported)
{
  Random random(4);
  SpinSimulation stylus;
  EXPECT_EQ(calibrateSpin(stylus.spun(19, random), stylus.tip_Stylus).status, Status::TooFewPoses);
  EXPECT_EQ(calibrateSpin(Poses(100, Eigen::Isometry3d::Identity()), stylus.tip_Stylus).status, Status::TooFewPoses);
  stylus.reach = 10 * Degree;
  stylus.wobble = 0.5 * Degree;
  const SpinCalibrationResult result = calibrateSpin(stylus.spun(200, random), stylus.tip_Stylus);
  EXPECT_EQ(result.status, Status::TooLittleSpin) << result.message;
  EXPECT_TRUE(says(result.message, { "hardly turned", "90 deg" }));
}

TEST(SpinCalibration, BadInput_Throws)
{
  Random random(5);
  Poses poses = SpinSimulation().spun(30, random);
  expectInvalidArgument([&] { (void)calibrateSpin(poses, { 0, std::nan(""), 0 }); }, { "tip", "finite" });
  poses[4].translation().x() = std::nan("");
  expectInvalidArgument([&] { (void)calibrateSpin(poses, { 0, 0, -150 }); }, { "pose 4", "finite" });
  expectInvalidArgument([&] { (void)tipFrame({ 0, 0, 0 }, { 0, 0, 0 }); }, { "shaft" });
  SpinCalibrationOptions options;
  options.rejectionFactor = 1;
  expectInvalidArgument([&] { options.check(); }, { "rejection factor" });
}

TEST(SpinCalibration, ToString_NamesEachStatusDifferently)
{
  std::set<std::string> names;
  for (const Status status :
    { Status::Ok, Status::TooFewPoses, Status::TooLittleSpin, Status::NotOneAxis, Status::UnclearDirection })
  {
    names.insert(toString(status));
  }
  EXPECT_EQ(names.size(), 5U);
  EXPECT_EQ(names.count("unknown"), 0U);
}
