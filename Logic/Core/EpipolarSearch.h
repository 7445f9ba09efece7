// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardHandEye.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace handeye
{

/// The branch and bound of Heller, Havlena and Pajdla. Internal.
///
/// With R the rotation of markerToCamera and c the camera's centre in the marker's frame, a point that two views see on the unit
/// rays u and v (each in its camera) is seen, in the second marker's frame, from  M c  along  R_M R^T u  and from  c  along  R^T v,
/// M = (R_M, t_M) being the marker's motion. The rays meet when the baseline  b = M c - c = t_M + (R_M - I) c  lies between v' and
/// -u'. The epipolar error is the smallest angle by which both rays have to be bent for that; bent by up to e they leave room
/// between two planes that touch the cones of half angle e, which is linear in b and so in c: for a given R, whether some c has all
/// errors below e is a linear program.
///
/// A rotation that differs from R by an angle d bends no ray by more than d, so the least error of R, less d, bounds that of a
/// whole
/// cube of rotation vectors whose corners are d away from its middle. The search divides cubes until no part of the rotation space
/// can hold a solution that is better than the best found by more than the gap asked for.
struct EpipolarPair
{
  Eigen::Isometry3d marker = Eigen::Isometry3d::Identity();               ///< M
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> rays_Cameras;  ///< (u, v)
};

struct EpipolarSolution
{
  Eigen::Matrix3d markerToCamera = Eigen::Matrix3d::Identity();  ///< R
  Eigen::Vector3d center_Marker = Eigen::Vector3d::Zero();       ///< c, mm
  double errorRad = 0;
};

struct EpipolarSearchResult
{
  std::optional<EpipolarSolution> solution;
  BranchAndBoundState state;
  bool isCancelled = false;
};

/// The largest error of all pairs for a rotation and a centre, rad; half the angle between two rays that miss each other
/// altogether.
double epipolarErrorRad(
  const std::vector<EpipolarPair>& pairs, const Eigen::Matrix3d& markerToCamera, const Eigen::Vector3d& center_Marker);

/// @param start a first candidate, as good as any closed form; may be empty
EpipolarSearchResult searchEpipolar(const std::vector<EpipolarPair>& pairs, const std::optional<Eigen::Isometry3d>& start,
  const BoardHandEyeOptions& options, const BranchAndBoundProgress& progress);

}  // namespace handeye
