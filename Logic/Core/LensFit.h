// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LensCalibration.h"

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace handeye
{

/// One run of Zhang's method over some views. Internal.
struct LensFit
{
  CameraModel camera;
  std::vector<Eigen::Isometry3d> boardToCamera;                  ///< one per view
  std::vector<std::vector<Eigen::Vector2d>> residuals_Image;     ///< seen minus projected, per view and point, px
  std::vector<double> viewRmsPx;                                 ///< one per view
  Eigen::Vector4d cameraMatrixSigmas = Eigen::Vector4d::Zero();  ///< fx fy cx cy, px
  std::vector<double> coefficientSigmas;
  double squares = 0;  ///< sum of the squared distances, px^2
  int pointCount = 0;

  double rmsPx() const { return std::sqrt(squares / std::max(1, pointCount)); }
};

/// @param circleDiameterMm of circle grids: the points are corrected for what perspective does to a circle's centre; otherwise 0
/// @return nothing where there is no such lens
std::optional<LensFit> fitLens(
  const std::vector<const LensView*>& views, int width, int height, int coefficients, double circleDiameterMm);

/// The third largest angle (rad) between a view's plane and the mean of all: how much the boards' attitudes differ.
double tiltSpreadRad(const std::vector<Eigen::Isometry3d>& boardToCamera);

/// @throws std::invalid_argument, naming the view, where sizes differ or a number is not finite
void checkLensViews(const std::vector<LensView>& views, int width, int height);

}  // namespace handeye
