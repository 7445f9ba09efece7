// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"

#include <Eigen/Core>

#include <vector>

namespace handeye
{

/// The cone of rays that touch a sphere.
///
/// A sphere does not project to a circle, and the centre of its outline is not the projection of its centre. On the unit sphere of
/// rays, however, the outline lies in a plane: every ray u that touches the ball makes the same angle alpha with the ray c to the
/// ball's centre, hence u . n = 1 with n = c / cos(alpha). The fit is linear in n, and the lens enters exactly, through the rays.
struct SphereCone
{
  Eigen::Vector3d axis_Camera = Eigen::Vector3d::UnitZ();  ///< unit ray to the ball's centre
  double halfAngle = 0;                                    ///< alpha, rad; sin(alpha) = radius / distance

  /// Distance (mm) of the centre of a ball of this radius (mm).
  double distance(double radiusMm) const;

  /// `count` points (px) of the outline and their outward unit normals in the image, evenly spaced about the axis. Points that the
  /// lens model cannot place are left out.
  struct Outline
  {
    std::vector<Eigen::Vector2d> points_Image;
    std::vector<Eigen::Vector2d> normals_Image;
    std::vector<double> turns;           ///< rad about the axis
    std::vector<Eigen::Vector3d> rates;  ///< px along the normal per rad of moved()'s three parameters
  };
  Outline outline(const CameraModel& camera, int count) const;

  /// The cone with its axis tipped (rad) towards the directions of a turn of 0 and of pi / 2, and its half angle changed (rad).
  SphereCone moved(const Eigen::Vector3d& step) const;
  /// Whether place and size differ by less than a share of the size.
  bool isCloseTo(const SphereCone& other, double share) const;
  /// The directions of a turn of 0 and of pi / 2, as columns.
  Eigen::Matrix<double, 3, 2> across() const;
};

/// The cone through three rays (unit length). @return a half angle of 0 if they lie on one great circle or the cone is not narrower
/// than a half space.
SphereCone coneThrough(const Eigen::Vector3d& a_Camera, const Eigen::Vector3d& b_Camera, const Eigen::Vector3d& c_Camera);

struct SphereConeFit
{
  bool isUsable = false;  ///< enough rays, and a cone came out
  SphereCone cone;
  std::vector<double> residualsPx;  ///< signed distance of each edge point to the fitted outline, outside positive
  std::vector<double> weights;      ///< 0 (an outlier) to 1
  double sigmaPx = 0;               ///< robust standard deviation of the edge points about the outline
  Eigen::Matrix3d axisCovariance = Eigen::Matrix3d::Zero();  ///< of axis_Camera (unit ray), rank 2
};

/// Fits the cone to edge points of the outline: the linear fit, repeated with Tukey's weights, then Gauss-Newton on the distances
/// in px.
///
/// @param rays_Camera unit rays of the edge points, at least 6
/// @param camera gives the pixels per radian at each ray
/// @param start the cone that the weights start from: rays more than `startTolerancePx` from it have no say at first
/// @throws std::invalid_argument if there are fewer than 6 rays
/// Thread-safe.
[[nodiscard]] SphereConeFit fitSphereCone(
  const std::vector<Eigen::Vector3d>& rays_Camera, const CameraModel& camera, const SphereCone& start, double startTolerancePx);

}  // namespace handeye
