// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "RigidTransform.h"

#include <Eigen/Geometry>

#include <random>

namespace handeye::study
{

/// Random numbers from a fixed seed. Internal.
class StudyRandom
{
public:
  explicit StudyRandom(unsigned seed)
    : engine_(seed)
  {
  }

  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(engine_); }
  double normal(double sigma) { return sigma * normal_(engine_); }
  Eigen::Vector2d normal2(double sigma)
  {
    const double x = normal(sigma), y = normal(sigma);
    return { x, y };
  }
  Eigen::Vector3d normal3(double sigma)
  {
    const double x = normal(sigma), y = normal(sigma), z = normal(sigma);
    return { x, y, z };
  }
  /// All rotations equally likely.
  Eigen::Matrix3d rotation()
  {
    const double w = normal(1);
    const Eigen::Vector3d xyz = normal3(1);
    return Eigen::Quaterniond(w, xyz.x(), xyz.y(), xyz.z()).normalized().toRotationMatrix();
  }
  unsigned seed() { return unsigned(engine_()); }

private:
  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
};

}  // namespace handeye::study
