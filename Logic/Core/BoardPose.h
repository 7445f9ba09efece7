// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace handeye
{

struct BoardPoseOptions
{
  /// A root mean square residual above this share of the image's diagonal is no pose of this board: wrong lens or wrong board.
  double maximumRelativeRms = 0.02;
  /// The mirrored pose (the board tilted the other way) must fit worse by this factor of the root mean square residual.
  double minimumAmbiguityRatio = 1.3;

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// Where a board stands, from one picture.
struct BoardPose
{
  enum class Status
  {
    Ok,
    TooFewPoints,   ///< fewer than four
    NotObservable,  ///< the points lie on one line
    Ambiguous,      ///< the board may as well be tilted the other way: too small or too far away
    PoorFit         ///< no pose explains the points
  };

  Status status = Status::TooFewPoints;
  std::string message;  ///< for a person
  /// p_Camera = boardToCamera * p_Board; meaningless unless usable
  Eigen::Isometry3d boardToCamera = Eigen::Isometry3d::Identity();
  /// Of (rotation vector rad, translation mm) acting from the left in the camera frame, with the noise that the residuals show.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<double> residualsPx;  ///< one per point
  double rmsPx = 0;                 ///< root of the mean square of them

  bool isUsable() const { return status == Status::Ok; }
};

/// The pose of a board (points in one plane) that projects its points to where they are seen: both poses of a plane (IPPE), each
/// refined by Levenberg and Marquardt's iteration on the squared pixel residuals through the exact lens; the better one.
///
/// @param points_Board mm, in one plane; @param points_Image px, one for each
/// @throws std::invalid_argument where the sizes differ or a number is not finite (with the point's index, from 0)
/// Thread-safe.
/// Reference: Collins and Bartoli, "Infinitesimal plane-based pose estimation", IJCV 109:252 (2014).
[[nodiscard]] BoardPose estimateBoardPose(const std::vector<Eigen::Vector3d>& points_Board,
  const std::vector<Eigen::Vector2d>& points_Image, const CameraModel& camera, const BoardPoseOptions& options = {});

/// "ok", "too_few_points", ...: the word that result files use.
std::string toString(BoardPose::Status status);

}  // namespace handeye
