// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearLightImage.h"
#include "SphereCone.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace handeye
{

/// A pixel near an outline.
struct OutlinePixel
{
  std::size_t index = 0;                                  ///< of the outline's point that is nearest
  Eigen::Vector2f place_Image = Eigen::Vector2f::Zero();  ///< px, whole numbers
  float offsetPx = 0;                                     ///< from the outline, outwards positive
  Eigen::Vector3f light = Eigen::Vector3f::Zero();
};

/// The pixels of an image on either side of an outline, each once, row by row. Internal to the detection.
/// @param outline its points follow one another all around, at most a few px apart
/// @param radiusPx of its curvature
/// @param insidePx, outsidePx how far from it; insidePx must be less than its radius
std::vector<OutlinePixel> pixelsAlongOutline(
  const LinearLightImage& light, const SphereCone::Outline& outline, double radiusPx, double insidePx, double outsidePx);

}  // namespace handeye
