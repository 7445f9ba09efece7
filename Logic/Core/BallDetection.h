// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallColor.h"
#include "CameraModel.h"

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <limits>
#include <string>
#include <vector>

namespace handeye
{

struct BallDetectionOptions
{
  enum class Method
  {
    Exact,  ///< the outline's rays lie on a cone about the ray to the ball's centre: sub-pixel edges, robust fit
    Hough   ///< the paper's pipeline (HSV threshold, Gaussian, median, Hough circle), kept for comparison: see HoughBall.h
  };

  Method method = Method::Exact;
  BallColor color;
  /// Smallest apparent radius (px) of a ball that is looked for.
  double minimumRadiusPx = 5;
  /// Least share of the outline that must be seen as a sharp edge of the ball.
  double minimumVisibleShare = 0.35;
  /// Least share of what the seen part of the outline encloses that must have the ball's colour or be a highlight; where a finger is in
  /// front of the ball, of its rim.
  double minimumFill = 0.75;
  /// Two balls are told apart when one is better than the other by this factor; otherwise neither is taken.
  double distinctionFactor = 1.25;
  /// The working range (mm): a ball that by its apparent size is nearer or further away is not the ball. The distance is known to
  /// 15 %, so much is allowed beyond.
  double nearestMm = 0;
  double furthestMm = std::numeric_limits<double>::infinity();

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// What was found in one image. The ball's centre is given as a ray and as the pixel that this ray is seen at.
struct BallDetection
{
  enum class Status
  {
    Found,
    NotFound,          ///< nothing in the image looks like the ball
    SeveralBalls,      ///< two or more places look equally like it
    TooLittleVisible,  ///< a ball is there, but too little of its outline is seen
    OutOfRange,        ///< what looks like the ball is outside of the working range
    Blurred,           ///< a ball is there, but its outline is smeared by motion
    Elsewhere          ///< what looks like the ball is not where the tracker puts it
  };

  Status status = Status::NotFound;
  std::string message;                                         ///< for a person
  Eigen::Vector3d ray_Camera = Eigen::Vector3d::UnitZ();       ///< unit ray to the ball's centre
  Eigen::Vector2d ball_Image = Eigen::Vector2d::Zero();        ///< px of the recorded image: where the ball's centre projects
  Eigen::Matrix2d covariance_Image = Eigen::Matrix2d::Zero();  ///< of ball_Image, px^2: scatter of the edges, shading, motion
  double radiusPx = 0;                                         ///< apparent radius: the root of the outline's area over pi
  double distanceMm = 0;                                       ///< of the ball's centre from the camera, from its apparent size
  double visibleShare = 0;                                     ///< share of the outline that was seen
  double confidence = 0;  ///< 0 to 1: visible share, times share of the inside that has the ball's colour, less for scattered edges
  std::vector<Eigen::Vector2d> outline_Image;  ///< the edge points (px) that the fit rests on

  bool isFound() const { return status == Status::Found; }
};

/// Finds the ball in an image.
///
/// Frames: `Camera` and pixels as CameraModel has them; the image is the recorded, distorted one.
/// @param image BGR or BGRA, 8 or 16 bit, rows may have a stride (options.color says when it is RGB or RGBA); grey images are refused, the ball is found by its colour
/// @param camera the lens; its image size, if known, must be that of the image
/// @param ballRadiusMm radius of the ball, mm
/// @throws std::invalid_argument for an empty image, another type, another size than the camera's, a radius that is not positive
/// Thread-safe.
[[nodiscard]] BallDetection detectBall(
  const cv::Mat& image, const CameraModel& camera, double ballRadiusMm, const BallDetectionOptions& options = {});

/// "ok", "not_found", ...: the word that result files use.
std::string toString(BallDetection::Status status);

}  // namespace handeye
