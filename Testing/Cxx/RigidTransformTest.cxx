// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RigidTransform.h"

#include "GeometryMatchers.h"
#include "Simulation.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>

using namespace handeye;
using namespace handeye::test;

TEST(RigidTransform, RotationFromVector_TurnsAKnownPoint)
{
  const Eigen::Matrix3d quarter = rotationFromVector({ 0, 0, EIGEN_PI / 2 });
  EXPECT_TRUE(pointNear(quarter * Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(-2, 1, 3), 1e-14));
  EXPECT_EQ(rotationFromVector(Eigen::Vector3d::Zero()), Eigen::Matrix3d::Identity());
}

TEST(RigidTransform, RotationAngle_IsAccurateAtBothEnds)
{
  constexpr double pi = EIGEN_PI;
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 0.5).normalized();
  for (const double angle : { 0.0, 1e-14, 1e-9, 1e-6, 0.3, 2.0, pi - 1e-6, pi - 1e-9, pi })
  {
    EXPECT_NEAR(rotationAngle(rotationFromVector(angle * axis)), angle, 1e-15 + 1e-14 * angle) << angle;
  }
}

TEST(RigidTransform, Skew_IsTheCrossProduct)
{
  const Eigen::Vector3d a(1, -2, 3), b(0.4, 5, -6);
  EXPECT_TRUE(pointNear(skew(a) * b, a.cross(b), 1e-15));
}

TEST(RigidTransform, NearestRotation_IsProperAndNearest)
{
  Random random(5);
  for (int i = 0; i < 50; ++i)
  {
    Eigen::Matrix3d matrix;
    matrix << random.normal3(1), random.normal3(1), random.normal3(1);
    const Eigen::Matrix3d nearest = nearestRotation(matrix);
    EXPECT_NEAR(nearest.determinant(), 1, 1e-13);
    EXPECT_LT((nearest.transpose() * nearest - Eigen::Matrix3d::Identity()).norm(), 1e-13);
    for (int k = 0; k < 20; ++k)
    {
      EXPECT_GE((random.rotation() - matrix).norm(), (nearest - matrix).norm());
      EXPECT_GE((rotationFromVector(random.normal3(1e-3)) * nearest - matrix).norm(), (nearest - matrix).norm() - 1e-13);
    }
  }
}

TEST(RigidTransform, ToRigid_TakesARoundedMatrix)
{
  Random random(6);
  const Eigen::Isometry3d truth = random.rigid(100);
  Eigen::Matrix4d rounded = (truth.matrix() * 1e4).array().round() / 1e4;
  const std::optional<Eigen::Isometry3d> rigid = toRigid(rounded);
  ASSERT_TRUE(rigid.has_value());
  EXPECT_TRUE(rigid3dNear(*rigid, truth, 2e-4, 1e-3));
  EXPECT_LT((rigid->linear().transpose() * rigid->linear() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_FALSE(toRigid(rounded, 1e-7).has_value());
}

TEST(RigidTransform, ToRigid_RefusesWhatIsNotRigid)
{
  const auto changed = [](int row, int column, double value)
  {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix(row, column) = value;
    return matrix;
  };
  EXPECT_TRUE(toRigid(Eigen::Matrix4d::Identity()).has_value());
  EXPECT_FALSE(toRigid(changed(0, 0, -1)).has_value()) << "mirrored";
  EXPECT_FALSE(toRigid(changed(0, 0, 1.01)).has_value()) << "scaled";
  EXPECT_FALSE(toRigid(changed(0, 1, 0.01)).has_value()) << "sheared";
  EXPECT_FALSE(toRigid(changed(3, 0, 0.1)).has_value()) << "projective";
  EXPECT_FALSE(toRigid(changed(3, 3, 2)).has_value()) << "homogeneous scale";
  EXPECT_FALSE(toRigid(changed(1, 1, std::nan(""))).has_value());
  EXPECT_FALSE(toRigid(changed(1, 3, INFINITY)).has_value());
  EXPECT_FALSE(toRigid(Eigen::Matrix4d::Zero()).has_value());
}
