// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PivotCalibration.h"

#include "GeometryMatchers.h"
#include "PivotSimulation.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Poses = std::vector<Eigen::Isometry3d>;
using Status = PivotCalibrationResult::Status;

/// Moves some poses to where no tip can be: jumps of centimetres, turns, reflections of another marker.
std::set<int> addGrossErrors(Poses& poses, double share, Random& random)
{
  std::set<int> wrong;
  while (double(wrong.size()) < share * double(poses.size()))
  {
    const int i = random.integer(0, int(poses.size()) - 1);
    if (wrong.insert(i).second)
    {
      Eigen::Isometry3d& pose = poses[std::size_t(i)];
      pose.translation() += random.uniform(4, 60) * random.direction();
      pose.linear() = rotationFromVector(random.normal3(0.1)) * pose.linear();
    }
  }
  return wrong;
}

}  // namespace

TEST(PivotCalibration, NoiseFree_IsExact)
{
  Random random(1);
  PivotSimulation stylus;
  stylus.sigmaMm = stylus.sigmaRad = 0;
  const PivotCalibrationResult result = calibratePivot(stylus.recordPivoting(60, 35 * Degree, random));
  ASSERT_EQ(result.status, Status::Ok) << result.message;
  EXPECT_TRUE(pointNear(result.tip_Stylus, stylus.tip_Stylus, 1e-9));
  EXPECT_TRUE(pointNear(result.pivot_Tracker, stylus.pivot_Tracker, 1e-9));
  EXPECT_LT(result.rmsMm, 1e-9);
  EXPECT_EQ(result.used.size(), 60U);
}

TEST(PivotCalibration, ChangeOfFrames_ChangesTheTipAlike)
{
  Random random(2);
  const PivotSimulation stylus;
  const Poses poses = stylus.recordPivoting(100, 35 * Degree, random);
  for (const PivotMethod method : { PivotMethod::Robust, PivotMethod::AlgebraicOneStep, PivotMethod::AlgebraicTwoStep })
  {
    PivotCalibrationOptions options;
    options.method = method;
    const PivotCalibrationResult plain = calibratePivot(poses, options);
    Eigen::Isometry3d stylusToNewStylus = random.rigid(100);
    if (method == PivotMethod::Robust)
    {
      // The tracker's noise acts at the marker's origin: to move that is to have another noise model, and rightly another
      // weighting.
      stylusToNewStylus.translation().setZero();
    }
    const Eigen::Isometry3d trackerToNewTracker = random.rigid(500);
    Poses moved = poses;
    for (Eigen::Isometry3d& pose : moved)
    {
      const Eigen::Isometry3d stylusToNewTracker = trackerToNewTracker * pose;
      pose = stylusToNewTracker * stylusToNewStylus.inverse();
    }
    const PivotCalibrationResult result = calibratePivot(moved, options);
    EXPECT_TRUE(pointNear(result.tip_Stylus, stylusToNewStylus * plain.tip_Stylus, 1e-8)) << toString(method);
    EXPECT_TRUE(pointNear(result.pivot_Tracker, trackerToNewTracker * plain.pivot_Tracker, 1e-8)) << toString(method);
    EXPECT_NEAR(result.rmsMm, plain.rmsMm, 1e-9);
    EXPECT_EQ(result.used, plain.used);
  }
}

TEST(PivotCalibration, NoiseAndOutliers_LeaveTheTipWithinATenthOfAMillimetre)
{
  std::vector<double> errorsMm;
  for (unsigned seed = 0; seed < 200; ++seed)
  {
    Random random(300 + seed);
    const PivotSimulation stylus;
    Poses poses = stylus.recordPivoting(300, 35 * Degree, random);
    const std::set<int> wrong = addGrossErrors(poses, 0.05, random);
    const PivotCalibrationResult result = calibratePivot(poses);
    ASSERT_EQ(result.status, Status::Ok) << result.message;
    EXPECT_TRUE(pointNear(result.tip_Stylus, stylus.tip_Stylus, 0.1)) << "seed " << seed;
    errorsMm.push_back((result.tip_Stylus - stylus.tip_Stylus).norm());
    for (int i : wrong)
    {
      EXPECT_TRUE(std::binary_search(result.rejected.begin(), result.rejected.end(), i)) << "seed " << seed << ", pose " << i;
    }
    EXPECT_LT(double(result.rejected.size() - wrong.size()), 0.02 * 300) << "good poses lost";
    EXPECT_EQ(result.used.size() + result.rejected.size(), poses.size());
  }
  std::sort(errorsMm.begin(), errorsMm.end());
  std::cout << "tip error of 200 recordings: " << errorsMm[100] << " mm (median), " << errorsMm.back() << " mm at most\n";
}

TEST(PivotCalibration, ThirtyPercentOutliers_AreStillThrownOut)
{
  Random random(4);
  const PivotSimulation stylus;
  Poses poses = stylus.recordPivoting(300, 35 * Degree, random);
  const std::set<int> wrong = addGrossErrors(poses, 0.3, random);
  const PivotCalibrationResult result = calibratePivot(poses);
  ASSERT_EQ(result.status, Status::Ok) << result.message;
  EXPECT_TRUE(pointNear(result.tip_Stylus, stylus.tip_Stylus, 0.15));
  EXPECT_TRUE(std::includes(result.rejected.begin(), result.rejected.end(), wrong.begin(), wrong.end()));
}

TEST(PivotCalibration, Covariance_IsHonest)
{
  double sum = 0;
  int beyond99 = 0;
  constexpr int runs = 200;
  for (unsigned seed = 0; seed < runs; ++seed)
  {
    Random random(1000 + seed);
    const PivotSimulation stylus;
    const PivotCalibrationResult result = calibratePivot(stylus.recordPivoting(120, 35 * Degree, random));
    ASSERT_EQ(result.status, Status::Ok) << result.message;
    const Eigen::Vector3d error = result.tip_Stylus - stylus.tip_Stylus;
    const double chiSquare = error.dot(result.tipCovariance.inverse() * error);
    sum += chiSquare;
    beyond99 += chiSquare > 11.34 ? 1 : 0;
  }
  // Three degrees of freedom: the mean of 200 is 3 with a standard deviation of 0.17.
  EXPECT_GT(sum / runs, 2.3);
  EXPECT_LT(sum / runs, 3.8);
  EXPECT_LE(beyond99, 10);
}

TEST(PivotCalibration, Rms_IsARootMeanSquareOfTheUsedPoses)
{
  Random random(6);
  Poses poses = PivotSimulation().recordPivoting(200, 35 * Degree, random);
  addGrossErrors(poses, 0.05, random);
  const PivotCalibrationResult result = calibratePivot(poses);
  ASSERT_EQ(result.residualsMm.size(), poses.size());
  double sum = 0, squares = 0, largest = 0;
  for (int i : result.used)
  {
    const Eigen::Vector3d tip_Tracker = poses[std::size_t(i)] * result.tip_Stylus;
    const double length = (tip_Tracker - result.pivot_Tracker).norm();
    EXPECT_NEAR(result.residualsMm[std::size_t(i)], length, 1e-12);
    sum += length;
    squares += length * length;
    largest = std::max(largest, length);
  }
  EXPECT_NEAR(result.rmsMm, std::sqrt(squares / double(result.used.size())), 1e-12);
  EXPECT_GT(result.rmsMm, 1.05 * sum / double(result.used.size())) << "a mean is smaller";
  EXPECT_NEAR(result.maximumMm, largest, 1e-12);
  EXPECT_NEAR(result.meanMm, sum / double(result.used.size()), 1e-12);
  EXPECT_NEAR(result.rmsMm, std::hypot(0.12 * std::sqrt(3.0), 158 * 0.025 * Degree * std::sqrt(2.0)), 0.03);
}

TEST(PivotCalibration, TurningAboutOneAxis_IsReported)
{
  const PivotSimulation stylus;
  for (int run = 0; run < 24; ++run)
  {
    Random random(700U + unsigned(run));
    const Eigen::Vector3d axis = run < 3 ? Eigen::Vector3d::Unit(run) : random.direction();
    const double reach = run % 2 ? 40 * Degree : 170 * Degree;
    const Eigen::Matrix3d held = random.rotation();
    const auto turn = [&] { return Eigen::Matrix3d(held * rotationFromVector(random.uniform(-reach, reach) * axis)); };
    const PivotCalibrationResult result = calibratePivot(stylus.record(200, turn, random));
    EXPECT_EQ(result.status, Status::RotationAboutOneAxis) << "axis " << axis.transpose() << ": " << result.message;
    EXPECT_TRUE(says(result.message, { "one axis", "left and right" }));
    EXPECT_NEAR(std::abs(result.weakAxis_Stylus.dot(axis)), 1, 1e-3);
    const Eigen::Vector3d along = axis * axis.dot(stylus.tip_Stylus);
    EXPECT_NEAR(result.weakAxisDistanceMm, (stylus.tip_Stylus - along).norm(), 0.5) << "the line runs through the tip";
    if (run < 3)
    {
      const std::string name = std::string("its ") + "xyz"[run] + " axis";
      EXPECT_TRUE(says(result.message, { name, run == 2 ? "(0.00, 0.00, 1.00)" : "in the stylus' frame" }));
    }
  }
}

TEST(PivotCalibration, SwingInOnePlaneWithAnUnsteadyHand_IsReported)
{
  Random random(8);
  const auto swing = [&] {
    return Eigen::Matrix3d(rotationFromVector({ random.uniform(-0.6, 0.6), 0, 0 }) * rotationFromVector(random.normal3(0.02)));
  };
  EXPECT_EQ(calibratePivot(PivotSimulation().record(200, swing, random)).status, Status::RotationAboutOneAxis);
}

TEST(PivotCalibration, HardlyAnyMotion_IsReported)
{
  Random random(9);
  const auto still = [&] { return rotationFromVector(random.normal3(0.01)); };
  const PivotCalibrationResult result = calibratePivot(PivotSimulation().record(200, still, random));
  EXPECT_EQ(result.status, Status::TooLittleRotation) << result.message;
  EXPECT_TRUE(says(result.message, { "hardly turned", "deg" }));
}

TEST(PivotCalibration, TheSamePoseAgainAndAgain_IsReported)
{
  const PivotCalibrationResult result = calibratePivot(Poses(100, makeRigid({ 0.3, 0.2, 0.1 }, { 10, 20, -900 })));
  EXPECT_EQ(result.status, Status::TooLittleRotation) << result.message;
}

TEST(PivotCalibration, SmallTilt_IsEnoughWhereTheCovarianceSaysSo)
{
  Random random(10);
  const PivotSimulation stylus;
  const PivotCalibrationResult result = calibratePivot(stylus.recordPivoting(300, 15 * Degree, random));
  ASSERT_EQ(result.status, Status::Ok) << result.message;
  EXPECT_TRUE(pointNear(result.tip_Stylus, stylus.tip_Stylus, 5 * std::sqrt(result.tipCovariance.trace())));
}

TEST(PivotCalibration, TooFewPoses_AreReported)
{
  Random random(11);
  const Poses poses = PivotSimulation().recordPivoting(19, 35 * Degree, random);
  const PivotCalibrationResult result = calibratePivot(poses);
  EXPECT_EQ(result.status, Status::TooFewPoses);
  EXPECT_TRUE(says(result.message, { "only 19", "at least 20" }));
  EXPECT_EQ(calibratePivot({}).status, Status::TooFewPoses);
}

TEST(PivotCalibration, HalfOfTheRecordingAtAnotherDivot_IsReported)
{
  Random random(12);
  PivotSimulation stylus;
  Poses poses = stylus.recordPivoting(150, 35 * Degree, random);
  stylus.pivot_Tracker += Eigen::Vector3d(6, -8, 3);
  const Poses others = stylus.recordPivoting(150, 35 * Degree, random);
  poses.insert(poses.end(), others.begin(), others.end());
  const PivotCalibrationResult result = calibratePivot(poses);
  EXPECT_EQ(result.status, Status::TooManyRejected) << result.message;
  EXPECT_TRUE(says(result.message, { "of 300 poses", "divot" }));
  EXPECT_FALSE(result.isUsable());
}

TEST(PivotCalibration, DivotThatMovedNearTheEnd_IsReportedWithPlaceAndTime)
{
  Random random(21);
  PivotSimulation stylus;
  Poses poses = stylus.recordPivoting(240, 35 * Degree, random);
  stylus.pivot_Tracker += Eigen::Vector3d(0, 4, -3);
  const Poses others = stylus.recordPivoting(60, 35 * Degree, random);
  poses.insert(poses.end(), others.begin(), others.end());
  const PivotCalibrationResult result = calibratePivot(poses);
  EXPECT_EQ(result.status, Status::TipMoved) << result.message;
  EXPECT_TRUE(says(result.message, { "5.0 mm away", "poses 240 to 299", "divot" }));
}

TEST(PivotCalibration, AFewPosesBesideTheDivotAtTheEnd_AreLeftOut)
{
  // The stylus was lifted out before the recording was stopped.
  Random random(22);
  const PivotSimulation stylus;
  Poses poses = stylus.recordPivoting(300, 35 * Degree, random);
  for (int i = 0; i < 25; ++i)
  {
    Eigen::Isometry3d lifted = stylus.pose(rotationFromVector(random.normal3(0.2)), random);
    lifted.translation() += Eigen::Vector3d(0.5 * i, 2.0 * i, 3.0 + 2 * i);
    poses.push_back(lifted);
  }
  const PivotCalibrationResult result = calibratePivot(poses);
  ASSERT_EQ(result.status, Status::Ok) << result.message;
  EXPECT_TRUE(pointNear(result.tip_Stylus, stylus.tip_Stylus, 0.1));
  EXPECT_GE(result.rejected.size(), 25U);
}

TEST(PivotCalibration, MostlyRepeatedPoses_DoNoHarm)
{
  // A tracker that is asked three times as often as it measures, and that froze for the second half of the recording.
  for (unsigned seed = 0; seed < 10; ++seed)
  {
    Random random(500 + seed);
    const PivotSimulation stylus;
    const Poses measured = stylus.recordPivoting(150, 35 * Degree, random);
    Poses poses;
    for (const Eigen::Isometry3d& pose : measured)
    {
      poses.insert(poses.end(), 3, pose);
    }
    poses.insert(poses.end(), 450, measured.back());
    const PivotCalibrationResult result = calibratePivot(poses);
    ASSERT_EQ(result.status, Status::Ok) << result.message;
    EXPECT_TRUE(pointNear(result.tip_Stylus, calibratePivot(measured).tip_Stylus, 1e-6));
    EXPECT_EQ(result.repeated.size(), 750U);
    EXPECT_EQ(result.used.size() + result.rejected.size() + result.repeated.size(), poses.size());
    EXPECT_EQ(result.rejections.size(), result.rejected.size() + result.repeated.size());
    EXPECT_EQ(result.rejections.front().index, 1);
    EXPECT_EQ(result.rejections.front().reason, PivotRejection::Reason::Repeated);
  }
}

TEST(PivotCalibration, StylusAtRestForMostOfTheRecording_DoesNoHarm)
{
  for (unsigned seed = 0; seed < 10; ++seed)
  {
    Random random(600 + seed);
    const PivotSimulation stylus;
    Poses poses = stylus.recordPivoting(120, 35 * Degree, random);
    addGrossErrors(poses, 0.05, random);
    const Poses resting = stylus.record(
      480,
      [] {
        return rotationFromVector({ 0.3, -0.4, 1.1 });
      },
      random);
    poses.insert(poses.begin(), resting.begin(), resting.end());
    const PivotCalibrationResult result = calibratePivot(poses);
    ASSERT_EQ(result.status, Status::Ok) << "seed " << seed << ": " << result.message;
    EXPECT_TRUE(pointNear(result.tip_Stylus, stylus.tip_Stylus, 0.15)) << "seed " << seed;
  }
}

TEST(PivotCalibration, AngularRange_IsThatOfTwoPerpendicularDirections)
{
  Random random(23);
  const auto lean = [&] { return rotationFromVector({ random.uniform(-0.5, 0.5), random.uniform(-0.2, 0.2), 0 }); };
  PivotSimulation stylus;
  stylus.tip_Stylus = { 0, 0, -150 };
  const PivotCalibrationResult result = calibratePivot(stylus.record(1000, lean, random));
  ASSERT_EQ(result.status, Status::Ok) << result.message;
  EXPECT_NEAR(result.angularRange(0), 1.0, 0.03);
  EXPECT_NEAR(result.angularRange(1), 0.4, 0.03);
}

TEST(PivotCalibration, TipThatJitters_IsTooNoisy)
{
  Random random(13);
  PivotSimulation stylus;
  stylus.sigmaMm = 2.5;
  const PivotCalibrationResult result = calibratePivot(stylus.recordPivoting(2000, 35 * Degree, random));
  EXPECT_EQ(result.status, Status::TooNoisy) << result.message;
  EXPECT_TRUE(says(result.message, { "mm (RMS)", "3.0 mm" }));
}

TEST(PivotCalibration, TipThatCreepsAlong_IsReported)
{
  Random random(15);
  PivotSimulation stylus;
  Poses poses;
  for (int i = 0; i < 300; ++i)
  {
    stylus.pivot_Tracker.x() += 1.6 / 300;
    poses.push_back(stylus.recordPivoting(1, 35 * Degree, random).front());
  }
  const PivotCalibrationResult result = calibratePivot(poses);
  EXPECT_EQ(result.status, Status::TipMoved) << toString(result.status) << ": " << result.message;
  EXPECT_TRUE(says(result.message, { "first and the second half", "mm" }));
}

TEST(PivotCalibration, PosesInMetres_GiveAnImplausibleTip)
{
  Random random(16);
  Poses poses = PivotSimulation().recordPivoting(100, 35 * Degree, random);
  for (Eigen::Isometry3d& pose : poses)
  {
    pose.translation() /= 1000;
  }
  const PivotCalibrationResult result = calibratePivot(poses);
  EXPECT_EQ(result.status, Status::ImplausibleTip) << toString(result.status) << ": " << result.message;
  EXPECT_TRUE(says(result.message, { "0.2 mm from the marker", "poses in mm" }));
}

TEST(PivotCalibration, BadInput_Throws)
{
  Random random(14);
  Poses poses = PivotSimulation().recordPivoting(30, 35 * Degree, random);
  poses[7].translation().y() = std::nan("");
  expectInvalidArgument([&] { (void)calibratePivot(poses); }, { "pivot", "pose 7", "finite" });
  PivotCalibrationOptions options;
  options.rejectionFactor = 0.5;
  expectInvalidArgument([&] { (void)calibratePivot({}, options); }, { "rejection factor" });
  options = {};
  options.minimumPoses = 2;
  expectInvalidArgument([&] { options.check(); }, { "at least 3 poses" });
  options = {};
  options.noise.positionMm = 0;
  expectInvalidArgument([&] { options.check(); }, { "noise", "mm" });
}

TEST(PivotCalibration, ToString_NamesEachStatusDifferently)
{
  std::set<std::string> names;
  for (const Status status : { Status::Ok, Status::TooFewPoses, Status::RotationAboutOneAxis, Status::TooLittleRotation,
         Status::TooManyRejected, Status::TooNoisy, Status::TipMoved, Status::ImplausibleTip })
  {
    names.insert(toString(status));
  }
  EXPECT_EQ(names.size(), 8U);
  EXPECT_EQ(names.count("unknown"), 0U);
}
