// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RigidTransform.h"

#include <Eigen/SVD>

#include <cmath>

namespace handeye
{

std::optional<Eigen::Isometry3d> toRigid(const Eigen::Matrix4d& matrix, double tolerance)
{
  if (!matrix.allFinite() || (matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > 1e-6)
  {
    return std::nullopt;
  }
  const Eigen::Matrix3d linear = matrix.topLeftCorner<3, 3>();
  const Eigen::Matrix3d deviation = linear.transpose() * linear - Eigen::Matrix3d::Identity();
  if (deviation.cwiseAbs().maxCoeff() > tolerance || linear.determinant() < 0)
  {
    return std::nullopt;
  }
  Eigen::Isometry3d rigid = Eigen::Isometry3d::Identity();
  rigid.linear() = nearestRotation(linear);
  rigid.translation() = matrix.topRightCorner<3, 1>();
  return rigid;
}

Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& matrix)
{
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handedness = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1.0 : 1.0;
  return svd.matrixU() * Eigen::Vector3d(1, 1, handedness).asDiagonal() * svd.matrixV().transpose();
}

Eigen::Matrix3d rotationFromVector(const Eigen::Vector3d& rotationVector)
{
  const double angle = rotationVector.norm();
  if (angle < 1e-9)
  {
    return nearestRotation(Eigen::Matrix3d::Identity() + skew(rotationVector));
  }
  return Eigen::AngleAxisd(angle, rotationVector / angle).toRotationMatrix();
}

double rotationAngle(const Eigen::Matrix3d& rotation)
{
  const Eigen::Quaterniond quaternion(rotation);
  return 2 * std::atan2(quaternion.vec().norm(), std::abs(quaternion.w()));
}

Eigen::Matrix3d skew(const Eigen::Vector3d& vector)
{
  Eigen::Matrix3d matrix;
  matrix << 0, -vector.z(), vector.y(), vector.z(), 0, -vector.x(), -vector.y(), vector.x(), 0;
  return matrix;
}

}  // namespace handeye
