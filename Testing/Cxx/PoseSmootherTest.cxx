// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PoseSmoother.h"
#include "RigidTransform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

using namespace handeye;

namespace
{

constexpr double StepSec = 1 / 60.0;

Eigen::Isometry3d pose(const Eigen::Vector3d& rotationVector, const Eigen::Vector3d& translation)
{
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = rotationFromVector(rotationVector);
  result.translation() = translation;
  return result;
}

double angleBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b)
{
  return rotationAngle(a.linear().transpose() * b.linear());
}

}  // namespace

TEST(PoseSmoother, StillTool_IsMuchCalmer)
{
  std::mt19937 random(3);
  std::normal_distribution<double> mm(0, 0.25), rad(0, 0.002);
  const auto noise = [&](auto& distribution)
  { return Eigen::Vector3d(distribution(random), distribution(random), distribution(random)); };
  const Eigen::Isometry3d truth = pose({ 0.4, -1.2, 0.7 }, { 40, -20, 900 });
  PoseSmoother smoother;
  double rawMm = 0, smoothMm = 0, rawRad = 0, smoothRad = 0;
  for (int i = 0; i < 1200; ++i)
  {
    const Eigen::Isometry3d measured = truth * pose(noise(rad), noise(mm));
    const SmoothedPose shown = smoother.add(i * StepSec, measured);
    if (i > 120)
    {
      rawMm += (measured.translation() - truth.translation()).squaredNorm();
      smoothMm += (shown.transform.translation() - truth.translation()).squaredNorm();
      rawRad += std::pow(angleBetween(measured, truth), 2);
      smoothRad += std::pow(angleBetween(shown.transform, truth), 2);
    }
  }
  EXPECT_LT(std::sqrt(smoothMm / rawMm), 0.35);
  EXPECT_LT(std::sqrt(smoothRad / rawRad), 0.35);
}

TEST(PoseSmoother, SteadyMotion_LagsByTheDelayItReports)
{
  for (const double speed : { 5.0, 50.0, 300.0 })
  {
    PoseSmoother smoother;
    const Eigen::Vector3d velocity = speed * Eigen::Vector3d(1, 2, -2) / 3;
    SmoothedPose shown;
    double timeSec = 0;
    for (int i = 0; i < 600; ++i)
    {
      timeSec = i * StepSec;
      shown = smoother.add(timeSec, pose({ 0, 0, 0 }, timeSec * velocity));
    }
    const double lagSec = (timeSec * velocity - shown.transform.translation()).norm() / speed;
    const double expectedSec = 1 / (2 * M_PI * shown.cutoffHz);
    EXPECT_NEAR(lagSec, expectedSec, 0.03 * expectedSec) << speed;
    EXPECT_LE(lagSec, shown.delaySec * 1.03) << speed;
  }
}

TEST(PoseSmoother, SteadyTurn_LagsByTheDelayItReports)
{
  PoseSmootherOptions options;
  options.cutoffPerMmPerSec = 0;
  PoseSmoother smoother(options);
  const Eigen::Vector3d rate(0.3, -0.6, 0.2);  // rad/s
  SmoothedPose shown;
  double timeSec = 0;
  for (int i = 0; i < 400; ++i)
  {
    timeSec = i * StepSec;
    shown = smoother.add(timeSec, pose(timeSec * rate, { 0, 0, 0 }));
  }
  const double lagSec = angleBetween(shown.transform, pose(timeSec * rate, { 0, 0, 0 })) / rate.norm();
  const double expectedSec = 1 / (2 * M_PI * (options.restCutoffHz + options.cutoffPerRadPerSec * rate.norm()));
  EXPECT_NEAR(lagSec, expectedSec, 0.03 * expectedSec);
}

TEST(PoseSmoother, FastMotion_IsDelayedLess)
{
  const auto delayAt = [](double speed)
  {
    PoseSmoother smoother;
    SmoothedPose shown;
    for (int i = 0; i < 300; ++i)
    {
      const double angle = 0.002 * speed * i * StepSec;
      shown = smoother.add(i * StepSec, pose({ angle, 0, 0 }, { speed * i * StepSec, 0, 0 }));
    }
    return shown.delaySec;
  };
  EXPECT_GT(delayAt(0), 0.1);
  EXPECT_LT(delayAt(100), 0.5 * delayAt(0));
  EXPECT_LT(delayAt(500), 0.4 * delayAt(100));
}

TEST(PoseSmoother, AfterAGap_StartsAnew)
{
  PoseSmoother smoother;
  static_cast<void>(smoother.add(0, pose({ 0, 0, 0 }, { 0, 0, 100 })));
  static_cast<void>(smoother.add(0.02, pose({ 0, 0, 0 }, { 1, 0, 100 })));
  const Eigen::Isometry3d elsewhere = pose({ 1, 0, 0 }, { 80, 0, 300 });
  const SmoothedPose shown = smoother.add(1.0, elsewhere);
  EXPECT_EQ(shown.transform.matrix(), elsewhere.matrix());
  EXPECT_EQ(shown.delaySec, 0);
}

TEST(PoseSmoother, TimeThatDoesNotAdvance_ChangesNothing)
{
  PoseSmoother smoother;
  static_cast<void>(smoother.add(0, pose({ 0, 0, 0 }, { 0, 0, 100 })));
  const SmoothedPose before = smoother.add(0.02, pose({ 0, 0, 0 }, { 1, 0, 100 }));
  const SmoothedPose again = smoother.add(0.02, pose({ 0, 0, 0 }, { 50, 0, 100 }));
  EXPECT_EQ(again.transform.matrix(), before.transform.matrix());
}

TEST(PoseSmoother, HalfTurns_StayRotations)
{
  PoseSmoother smoother;
  for (int i = 0; i < 2000; ++i)
  {
    const SmoothedPose shown = smoother.add(i * StepSec, pose(Eigen::Vector3d(0, 0, 0.031 * i), { 0, 0, 0 }));
    ASSERT_LT((shown.transform.linear().transpose() * shown.transform.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
  }
}

TEST(PoseSmoother, Nonsense_IsRefused)
{
  PoseSmoother smoother;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(smoother.add(nan, Eigen::Isometry3d::Identity())), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(smoother.add(0, pose({ 0, 0, 0 }, { nan, 0, 0 }))), std::invalid_argument);
  PoseSmootherOptions options;
  options.restCutoffHz = 0;
  EXPECT_THROW(PoseSmoother{ options }, std::invalid_argument);
}
