// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeCalibration.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace handeye
{

struct HandEyeGuidanceOptions
{
  double nearestMm = 150;  ///< the working volume: the image, between these depths (z of the camera)
  double furthestMm = 700;
  double trackingSigmaMm = 0.35;
  double segmentationSigmaPx = 0.25;
  /// Of the image's width and height that stays free at each border.
  double borderShare = 0.1;
  /// Of a near ball more stays free, so that all of it is seen; 0: its size is not known.
  double ballRadiusMm = 0;
  /// Two placements are at least this far apart.
  double separationMm = 15;
  /// A further sample that lowers the largest predicted error by less than this share is not worth while.
  double minimumGain = 0.05;

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

struct HandEyeGuidance
{
  enum class Status
  {
    HoldHere,  ///< the placement is worth while
    Enough,    ///< the best placement would gain less than the share asked for
    NoPlace    ///< no pixel of the image has a ray in the lens model, or there is a ball everywhere already
  };

  Status status = Status::NoPlace;
  std::string message;                                    ///< for a person
  Eigen::Vector2d ball_Image = Eigen::Vector2d::Zero();   ///< where to hold the ball's centre, px; not meaningful with NoPlace
  Eigen::Vector3d ball_Camera = Eigen::Vector3d::Zero();  ///< the same in mm, z being the depth
  double maximumPx = 0;       ///< largest predicted error over the working volume with the samples so far (infinity below 4)
  double maximumAfterPx = 0;  ///< and with this one more
  double gain = 0;            ///< the share by which it falls

  bool isWorthwhile() const { return status == Status::HoldHere; }
};

/// Where to hold the ball next, so that the largest projection error that the calibration will have over the working volume falls
/// most: of a grid of 9 x 7 pixels and 5 depths the place whose expected information lowers it most. With fewer than four balls
/// there is no error to speak of yet; then the place that adds most to the determinant of the information is taken.
///
/// @param balls_Camera where the ball has been (mm, camera frame), as the solution so far or the ball's apparent size says; may be
///        empty. Sampling noise is not looked at: the plan depends on the places alone.
/// @throws std::invalid_argument if a number is not finite (naming the ball, counted from 1), a ball is not in front of the camera
///         or the options do not check
/// Thread-safe, deterministic.
[[nodiscard]] HandEyeGuidance suggestPlacement(
  const std::vector<Eigen::Vector3d>& balls_Camera, const Eye& eye, const HandEyeGuidanceOptions& options = {});

/// "hold_here", "enough", "no_place": the word that result files use.
std::string toString(HandEyeGuidance::Status status);

}  // namespace handeye
