// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "LinearLightImage.h"
#include "SphereCone.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace handeye
{

/// The outline of a ball, fitted to sub-pixel edges of an image. Internal to the detection.
struct OutlineFit
{
  SphereCone cone;
  std::vector<Eigen::Vector2d> support_Image;  ///< px: the edge points that the fit rests on, in their order along the outline
  double visibleShare = 0;                     ///< of the outline: where such a point was found
  double blurPx = 0;                           ///< of the edges, standard deviation
  double twoSidedWidthPx = 0;                  ///< how much wider edges are on two opposite sides, which motion does
  double sigmaPx = 0;                          ///< robust standard deviation of the edge points about the outline
  /// Of the cone's axis (unit ray), rank 2. Shading moves neighbouring edge points together, so that n of them do not average as n
  /// independent ones do; how far is judged by how the light changes on either side of the edges.
  Eigen::Matrix3d axisCovariance = Eigen::Matrix3d::Zero();
};

/// Fits the outline roughly (a tenth of a pixel): the cone through the rays of the edges near a candidate, then a step in px
/// along the
/// outline's normals. Most candidates end here.
/// @param candidate good to a few px
/// @return nothing where there is no outline of a ball
std::optional<OutlineFit> fitOutlineRoughly(const LinearLightImage& light, const CameraModel& camera, const SphereCone& candidate);

/// Fits it as precisely as the image allows, with a normal every pixel.
std::optional<OutlineFit> fitOutlineFinely(const LinearLightImage& light, const CameraModel& camera, const OutlineFit& rough);

}  // namespace handeye
