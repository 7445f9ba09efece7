// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyePrediction.h"

#include "GeometryMatchers.h"
#include "RigidTransform.h"
#include "Simulation.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>

using namespace handeye;
using namespace handeye::test;

TEST(HandEyePrediction, PoseCovarianceIn_IsThatOfTheSameMotionsSeenFromThere)
{
  // A hundred thousand small motions of the one frame, each as the motion of the other frame that it is, made without any formula:
  // fromToTo * motion * inverse(fromToTo).
  Random random(11);
  const Eigen::Isometry3d fromToTo = makeRigid({ 0.4, -1.1, 0.7 }, { 60, -25, 140 });
  Eigen::Matrix<double, 6, 6> root = 2e-4 * Eigen::Matrix<double, 6, 6>::Identity();
  root.bottomRightCorner<3, 3>() = Eigen::Vector3d(0.05, 0.1, 0.2).asDiagonal();
  root(3, 1) = -0.06;
  root(5, 0) = 0.03;
  const Eigen::Matrix<double, 6, 6> covariance_From = root * root.transpose();
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  constexpr int count = 100000;
  for (int i = 0; i < count; ++i)
  {
    Eigen::Matrix<double, 6, 1> unit;
    unit << random.normal3(1), random.normal3(1);
    const Eigen::Matrix<double, 6, 1> motion = root * unit;
    Eigen::Isometry3d moved_From = Eigen::Isometry3d::Identity();
    moved_From.linear() = rotationFromVector(motion.head<3>());
    moved_From.translation() = motion.tail<3>();
    const Eigen::Isometry3d motionAfter = fromToTo * moved_From;
    const Eigen::Isometry3d moved_To = motionAfter * fromToTo.inverse();
    const Eigen::AngleAxisd turn(moved_To.linear());
    Eigen::Matrix<double, 6, 1> seen;
    seen << turn.angle() * turn.axis(), moved_To.translation();
    sum += seen * seen.transpose();
  }
  const Eigen::Matrix<double, 6, 6> sampled = sum / count, predicted = poseCovarianceIn(fromToTo, covariance_From);
  for (int row = 0; row < 6; ++row)
  {
    for (int column = 0; column < 6; ++column)
    {
      const double scale = std::sqrt(predicted(row, row) * predicted(column, column));
      EXPECT_NEAR(sampled(row, column) / scale, predicted(row, column) / scale, 0.02) << row << " " << column;
    }
  }
  // A known point: a turn about z by 1 mrad with a spread, seen from 100 mm beside, is a shift along y by 0.1 mm.
  Eigen::Matrix<double, 6, 6> turnAboutZ = Eigen::Matrix<double, 6, 6>::Zero();
  turnAboutZ(2, 2) = 1e-6;
  Eigen::Isometry3d beside = Eigen::Isometry3d::Identity();
  beside.translation().x() = -100;
  EXPECT_NEAR(poseCovarianceIn(beside, turnAboutZ)(4, 4), 0.01, 1e-15);
  EXPECT_NEAR(poseCovarianceIn(beside, turnAboutZ)(4, 2), 1e-4, 1e-15);
}

TEST(HandEyePrediction, PoseCovarianceIn_ThereAndBackIsTheSame)
{
  Random random(12);
  const Eigen::Isometry3d fromToTo = random.rigid(100);
  const Eigen::Matrix<double, 6, 6> root = Eigen::Matrix<double, 6, 6>::Random(), covariance = root * root.transpose();
  const Eigen::Matrix<double, 6, 6> back = poseCovarianceIn(fromToTo.inverse(), poseCovarianceIn(fromToTo, covariance));
  EXPECT_LT((back - covariance).norm(), 1e-8 * covariance.norm());
  EXPECT_EQ(poseCovarianceIn(Eigen::Isometry3d::Identity(), covariance), covariance);
}
