// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeErrorField.h"

#include "GeometryMatchers.h"
#include "RigidTransform.h"
#include "Simulation.h"
#include "TestCameras.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

using namespace handeye;
using namespace handeye::test;

namespace
{

/// A calibration whose turns and shifts make up for each other where the ball was held, as they do: 0.2 deg and 1 mm, about 250
/// mm away.
Covariance6 correlatedCovariance()
{
  Eigen::Matrix<double, 6, 6> root = Eigen::Matrix<double, 6, 6>::Zero();
  root.diagonal() << 0.003, 0.004, 0.002, 0.15, 0.2, 0.3;
  root(4, 0) = 0.7;
  root(3, 1) = -0.95;
  root(5, 2) = 0.1;
  return root * root.transpose();
}

/// As a person would do it: move the point by the motion, look where it is seen then.
Eigen::Matrix2d sampledCovariance(const CameraModel& camera, const Covariance6& covariance, const Eigen::Vector3d& point_Camera)
{
  Random random(3);
  const Eigen::Matrix<double, 6, 6> root = Eigen::LLT<Covariance6>(covariance).matrixL();
  const Eigen::Vector2d still = camera.project(point_Camera).point_Image;
  constexpr int count = 40000;
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (int i = 0; i < count; ++i)
  {
    Eigen::Matrix<double, 6, 1> unit;
    unit << random.normal3(1), random.normal3(1);
    const Eigen::Matrix<double, 6, 1> motion = root * unit;
    const Eigen::Vector3d moved_Camera = rotationFromVector(motion.head<3>()) * point_Camera + motion.tail<3>();
    const Eigen::Vector2d away = camera.project(moved_Camera).point_Image - still;
    sum += away * away.transpose();
  }
  return sum / count;
}

CameraModel wideBarrel()
{
  return makeCamera(640, 480, 420, 425, 322, 236, { -0.3, 0.06, 0.001, -0.0007 });
}

}  // namespace

TEST(HandEyeErrorField, KnownPoints_MoveAsFarAsIsSaid)
{
  const Covariance6 covariance = correlatedCovariance();
  for (const CameraModel& camera : { wideBarrel(), makeCamera(640, 480, 420, 425, 322, 236, {}) })
  {
    const HandEyeErrorField field(camera, covariance);
    for (const Eigen::Vector3d& point_Camera :
      { Eigen::Vector3d(0, 0, 250), Eigen::Vector3d(60, -40, 120), Eigen::Vector3d(-150, 90, 400), Eigen::Vector3d(50, 55, 700) })
    {
      const Eigen::Vector2d pixel = camera.project(point_Camera).point_Image;
      const Eigen::Matrix2d predicted = field.covariancePx(pixel, point_Camera.z());
      const Eigen::Matrix2d sampled = sampledCovariance(camera, covariance, point_Camera);
      // 40,000 samples say a variance to 0.7 %.
      EXPECT_LT((predicted - sampled).norm(), 0.03 * sampled.norm()) << pixel.transpose() << "\n" << predicted << "\n" << sampled;
    }
  }
}

TEST(HandEyeErrorField, BetweenItsNodes_ItIsThePredictionItself)
{
  const Covariance6 covariance = correlatedCovariance();
  Random random(4);
  double worst = 0;
  const CameraModel camera = wideBarrel();
  const HandEyeErrorField field(camera, covariance);
  for (int i = 0; i < 500; ++i)
  {
    const Eigen::Vector2d pixel(random.uniform(0, 639), random.uniform(0, 479));
    const double depthMm = random.uniform(60, 800);
    const double error = std::sqrt(field.covariancePx(pixel, depthMm).trace());
    worst = std::max(worst, std::abs(error / *predictProjectionErrorPx(covariance, { camera }, pixel, depthMm) - 1));
  }
  // In the corners of a very wide lens, where turns and shifts nearly make up for each other.
  EXPECT_LT(worst, 0.04);  // 3.4 % is the worst of 20,000 places
}

TEST(HandEyeErrorField, ShiftsFadeWithTheDistance_TurnsDoNot)
{
  Covariance6 shift = Covariance6::Zero(), turn = Covariance6::Zero();
  shift(3, 3) = 1;
  turn(1, 1) = 1e-4;
  const CameraModel camera = makeCamera(640, 480, 500, 500, 320, 240, {});
  const Eigen::Vector2d middle(320, 240);
  EXPECT_NEAR(HandEyeErrorField(camera, shift).covariancePx(middle, 100)(0, 0), 25, 1e-4);
  EXPECT_NEAR(HandEyeErrorField(camera, shift).covariancePx(middle, 500)(0, 0), 1, 1e-5);
  EXPECT_NEAR(HandEyeErrorField(camera, shift).covariancePx(middle, 100)(1, 1), 0, 1e-9);
  EXPECT_NEAR(HandEyeErrorField(camera, turn).covariancePx(middle, 100)(0, 0), 25, 0.01);  // between two nodes
  EXPECT_NEAR(HandEyeErrorField(camera, turn).covariancePx(middle, 500)(0, 0), 25, 0.01);
}

TEST(HandEyeErrorField, LensThatFolds_HasFiniteNumbersInTheCorners)
{
  // k1 = -0.19 alone turns back before the corners of such a picture.
  const CameraModel camera = makeCamera(960, 720, 571, 571, 480, 360, { -0.19, 0, 0, 0 });
  ASSERT_FALSE(camera.unproject({ 0, 0 }).isUsable());
  const HandEyeErrorField field(camera, correlatedCovariance());
  const Eigen::Matrix2d corner = field.covariancePx({ 0, 0 }, 200);
  EXPECT_TRUE(corner.allFinite());
  EXPECT_GT(corner.trace(), 0);
}

TEST(HandEyeErrorField, CameraWithoutASize_IsRefused)
{
  Eigen::Matrix3d matrix;
  matrix << 500, 0, 320, 0, 500, 240, 0, 0, 1;
  EXPECT_THROW(HandEyeErrorField(CameraModel(0, 0, matrix, {}), Covariance6::Identity()), std::invalid_argument);
}
