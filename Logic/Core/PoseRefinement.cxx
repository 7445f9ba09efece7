// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PoseRefinement.h"

#include "RigidTransform.h"

namespace handeye
{

namespace
{

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

struct Normals
{
  double cost = 0;
  Matrix6 hessian = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
};

/// Derivatives by (rotation vector, translation) from the left in the camera frame.
std::optional<Normals> linearize(const std::vector<Eigen::Vector3d>& points_Board, const std::vector<Eigen::Vector2d>& points_Image,
  const CameraModel& camera, const Eigen::Isometry3d& boardToCamera)
{
  Normals normals;
  for (std::size_t i = 0; i < points_Board.size(); ++i)
  {
    const Eigen::Vector3d point_Camera = boardToCamera * points_Board[i];
    Eigen::Matrix<double, 2, 3> byPoint;
    const CameraModel::Projection seen = camera.project(point_Camera, &byPoint);
    if (!seen.isUsable())
    {
      return std::nullopt;
    }
    Eigen::Matrix<double, 2, 6> jacobian;
    jacobian << -byPoint * skew(point_Camera), byPoint;
    const Eigen::Vector2d residual = seen.point_Image - points_Image[i];
    normals.cost += residual.squaredNorm();
    normals.hessian += jacobian.transpose() * jacobian;
    normals.gradient += jacobian.transpose() * residual;
  }
  return normals;
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const Vector6& step)
{
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = nearestRotation(rotationFromVector(step.head<3>()) * pose.linear());
  result.translation() = rotationFromVector(step.head<3>()) * pose.translation() + step.tail<3>();
  return result;
}

}  // namespace

std::optional<RefinedPose> refinePose(const std::vector<Eigen::Vector3d>& points_Board,
  const std::vector<Eigen::Vector2d>& points_Image, const CameraModel& camera, const Eigen::Isometry3d& start)
{
  RefinedPose refined;
  refined.boardToCamera = start;
  std::optional<Normals> normals = linearize(points_Board, points_Image, camera, start);
  if (!normals)
  {
    return std::nullopt;
  }
  double damping = 1e-6;
  for (int iteration = 0; iteration < 100 && damping < 1e12; ++iteration)
  {
    Matrix6 damped = normals->hessian;
    damped.diagonal() *= 1 + damping;
    const Vector6 step = -damped.ldlt().solve(normals->gradient);
    const Eigen::Isometry3d candidate = moved(refined.boardToCamera, step);
    const std::optional<Normals> next = step.allFinite() ? linearize(points_Board, points_Image, camera, candidate) : std::nullopt;
    if (!next || next->cost > normals->cost)
    {
      damping *= 10;
      continue;
    }
    const bool isDone = step.norm() < 1e-11 || normals->cost - next->cost < 1e-15 * normals->cost;
    refined.boardToCamera = candidate;
    normals = next;
    damping = std::max(damping / 10, 1e-12);
    if (isDone)
    {
      break;
    }
  }
  for (std::size_t i = 0; i < points_Board.size(); ++i)
  {
    const Eigen::Vector3d point_Camera = refined.boardToCamera * points_Board[i];
    refined.residualsPx.push_back((camera.project(point_Camera).point_Image - points_Image[i]).norm());
  }
  const double count = double(points_Board.size());
  refined.rmsPx = std::sqrt(normals->cost / count);
  const double variance = normals->cost / std::max(1.0, 2 * count - 6);
  refined.covariance = variance * normals->hessian.ldlt().solve(Matrix6::Identity());
  return refined;
}

}  // namespace handeye
