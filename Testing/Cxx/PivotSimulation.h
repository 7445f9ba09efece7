// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "RigidTransform.h"
#include "Simulation.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <functional>
#include <vector>

namespace handeye::test
{

constexpr double Degree = EIGEN_PI / 180;

/// A stylus whose tip rests in a divot, seen by a tracker with an NDI-like noise.
struct PivotSimulation
{
  Eigen::Vector3d tip_Stylus = { 2.4, -3.1, -158 };
  Eigen::Vector3d pivot_Tracker = { 42, -25, -1150 };
  double sigmaMm = 0.12;
  double sigmaRad = 0.025 * Degree;

  /// The pose of the stylus when it is held like this, with the tracker's noise.
  Eigen::Isometry3d pose(const Eigen::Matrix3d& stylusToTrackerRotation, Random& random) const
  {
    Eigen::Isometry3d stylusToTracker = Eigen::Isometry3d::Identity();
    stylusToTracker.linear() = stylusToTrackerRotation;
    stylusToTracker.translation() = pivot_Tracker - stylusToTrackerRotation * tip_Stylus + random.normal3(sigmaMm);
    stylusToTracker.linear() = rotationFromVector(random.normal3(sigmaRad)) * stylusToTracker.linear();
    return stylusToTracker;
  }

  /// Poses for rotations of the stylus that a function gives.
  std::vector<Eigen::Isometry3d> record(int count, const std::function<Eigen::Matrix3d()>& rotation, Random& random) const
  {
    std::vector<Eigen::Isometry3d> poses;
    for (int i = 0; i < count; ++i)
    {
      poses.push_back(pose(rotation(), random));
    }
    return poses;
  }

  /// As the instructions ask for: leant in all directions by up to `largestTilt`, turned a little in the fingers.
  std::vector<Eigen::Isometry3d> recordPivoting(int count, double largestTilt, Random& random) const
  {
    const Eigen::Matrix3d upright = rotationFromVector({ 0.3, -0.4, 1.1 });
    return record(
      count,
      [&]
      {
        const double heading = random.uniform(0, 2 * EIGEN_PI), tilt = random.uniform(0, largestTilt);
        const Eigen::Vector3d lean(tilt * std::cos(heading), tilt * std::sin(heading), 0);
        const Eigen::Vector3d spin(0, 0, random.uniform(-0.5, 0.5));
        return Eigen::Matrix3d(upright * rotationFromVector(lean) * rotationFromVector(spin));
      },
      random);
  }
};

}  // namespace handeye::test
