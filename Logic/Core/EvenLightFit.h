// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearLightImage.h"
#include "SphereCone.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace handeye
{

/// What is known of an outline before it is fitted in even light.
struct EvenLightStart
{
  Eigen::Vector3d step = Eigen::Vector3d::Zero();  ///< SphereCone::moved()'s, from the outline to the best fit so far
  std::vector<std::size_t> support;                ///< points of the outline near which an edge was found that fits
  double radiusPx = 0;                             ///< apparent radius of the ball
  double blurPx = 0;                               ///< standard deviation of the edges' blur
};

struct EvenLightResult
{
  Eigen::Vector3d step = Eigen::Vector3d::Zero();  ///< from the outline to the best fit, in place of the start's
  double visibleShare = 0;                         ///< of the outline: where the pixels say that the ball ends there
};

/// Fits an outline to the pixels around it, where the light is even: the ball has one brightness along the outline's inside, and so has
/// what lies outside, apart from places where it changes to another.
///
/// A pixel at the distance d from the outline has the light outside + (inside - outside) Phi(-d / blur) in each channel; the outline's
/// three parameters and the blur are those for which the squares of the differences, each by its noise, are least. Near either end of a
/// part that is hidden there are three lights, and the edge of what hides is one more line, with two parameters of its own (HidingEdge);
/// the shares follow from the bivariate normal distribution. That uses every pixel once and each channel by what it is worth, so that
/// the result is nearly as precise as the noise allows. It takes all that is not noise for the outline's doing; so normals across which
/// the light is another than that are left out, and in light that is not even there is no result.
///
/// @param outline close to half a px
/// @return nothing where the light is not even
std::optional<EvenLightResult> fitInEvenLight(
  const LinearLightImage& light, const SphereCone::Outline& outline, const EvenLightStart& start);

}  // namespace handeye
