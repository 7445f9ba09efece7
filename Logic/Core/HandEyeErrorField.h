// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyePrediction.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace handeye
{

/// 95 % of vectors with two standard normal entries are shorter than this: so many standard deviations are the half axes of an
/// ellipse that holds 95 % of the errors.
constexpr double ErrorQuantile95 = 2.4477;

/// What the covariance of a hand-eye calibration predicts for every place of an image and every depth, in a form that a graphics
/// card can look up.
///
/// The derivative of a pixel by a motion (w, v) of the camera's frame is  [R, T / Z]  with R and T of the pixel alone: a turn
/// moves a pixel by the same amount at any depth Z, a shift by 1/Z. So the covariance of a pixel (px^2) is a polynomial in 1/Z
/// (1/mm),
///
///     covariance = constant + linear / Z + quadratic / Z^2
///
/// with three symmetric 2x2 matrices for each pixel. They are kept at the nodes of a grid from corner to corner of the image and
/// interpolated between them (bilinear), which is right to 4 % of the error (px) in the corners of a very wide lens.
///
/// Immutable, safe to share between threads.
class HandEyeErrorField
{
public:
  static constexpr int Columns = 33, Rows = 25;

  /// xx, xy, yy of a symmetric matrix (px^2; px^2 mm; px^2 mm^2) at each node, row by row from the image's lower edge up, as
  /// textures have them; x right, y down.
  using Nodes = std::vector<std::array<float, 3>>;

  /// @param camera as the image is shown (a straightened one: without distortion), with an image size
  /// @param covariance of (rotation vector rad, translation mm), `Camera` frame
  /// @throws std::invalid_argument if the camera has no image size
  HandEyeErrorField(const CameraModel& camera, const Covariance6& covariance);

  const Nodes& constant() const { return constant_; }
  const Nodes& linear() const { return linear_; }
  const Nodes& quadratic() const { return quadratic_; }

  /// The interpolated covariance (px^2) of what is seen at this pixel at this depth (mm, Z in the `Camera` frame, more than 0:
  /// nothing else is seen, and it is not checked); pixels outside of the image count as the nearest one inside.
  Eigen::Matrix2d covariancePx(const Eigen::Vector2d& point_Image, double depthMm) const;

private:
  int width_, height_;
  Nodes constant_, linear_, quadratic_;
};

}  // namespace handeye
