// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <vector>

namespace handeye
{

/// The motions of a camera and of its marker between two views, and the classical equation  C X = X M  on them. Internal.

/// Where camera and marker were in one view.
struct HandEyePoses
{
  Eigen::Isometry3d markerToTracker = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d boardToCamera = Eigen::Isometry3d::Identity();
};

struct HandEyeMotion
{
  int from = 0;  ///< indices of the views
  int to = 0;
  Eigen::Isometry3d camera = Eigen::Isometry3d::Identity();  ///< p_CameraTo = camera * p_CameraFrom, for a point that stands still
  Eigen::Isometry3d marker = Eigen::Isometry3d::Identity();  ///< the same of the marker
  Eigen::Vector3d turn_Marker = Eigen::Vector3d::Zero();     ///< the marker's rotation vector, rad
};

/// The motions between all pairs of views that turn by between `minimumTurnRad` and pi minus it.
std::vector<HandEyeMotion> motionsOf(const std::vector<HandEyePoses>& views, double minimumTurnRad);

/// How far the turning axes are from being parallel (rad): 0 for one axis, pi / 4 where two directions are as strong. Turns count
/// by their size.
double axisSpreadRad(const std::vector<HandEyeMotion>& motions);

/// The motions, at most so many of them, that together say most about all directions: large turns about different axes.
std::vector<HandEyeMotion> selectMotions(const std::vector<HandEyeMotion>& motions, int count);

/// The closed forms, for at least two motions about different axes. @return p_Camera = result * p_Marker
Eigen::Isometry3d solveTsai(const std::vector<HandEyeMotion>& motions);
Eigen::Isometry3d solvePark(const std::vector<HandEyeMotion>& motions);
Eigen::Isometry3d solveHoraud(const std::vector<HandEyeMotion>& motions);
Eigen::Isometry3d solveDaniilidis(const std::vector<HandEyeMotion>& motions);

}  // namespace handeye
