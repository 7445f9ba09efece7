// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearLightImage.h"
#include "SphereCone.h"

#include <cstddef>
#include <vector>

namespace handeye
{

/// An edge that was found on a normal of an expected outline.
struct OutlineEdge
{
  std::size_t index = 0;  ///< of the outline's point
  double offsetPx = 0;    ///< along the normal from there, outwards positive
  double contrast = 0;    ///< of the linear light across the edge
  double shadingPx = 0;   ///< how far the light's change on either side may have moved it
};

struct OutlineEdges
{
  std::vector<OutlineEdge> edges;
  double blurPx = 0;  ///< median standard deviation of the edges' blur
};

struct OutlineSearch
{
  double reachPx = 6;   ///< how far from the expected outline an edge is looked for
  double radiusPx = 0;  ///< apparent radius of the ball
  double blurPx = 0;    ///< blur of the edges if known from an earlier call, else 0
};

/// Looks for the ball's edge along the normals of an expected outline.
///
/// The light along a normal is projected onto the difference between the light inside and outside, so that any pair of colours
/// makes a
/// profile from 1 to 0. As long as the blur is not known the edge is where the area under the profile says; once it is known, the
/// blurred step that fits the profile best, which is as precise as the noise of the pixels allows.
OutlineEdges findOutlineEdges(const LinearLightImage& image, const SphereCone::Outline& expected, const OutlineSearch& search);

/// Widths of edges (px, from a quarter to three quarters of the step).
struct EdgeWidths
{
  double narrowPx = 0;  ///< a quarter of the edges are narrower
  /// How much wider they are on two opposite sides than on average: a ball that moved while the picture was taken is blurred
  /// so. 0 where
  /// too little is seen, or where one side alone is wider, which shading does.
  double twoSidedPx = 0;
};

/// @param outline that of a ball, good to a few px
EdgeWidths measureEdgeWidths(const LinearLightImage& image, const SphereCone::Outline& outline, double radiusPx);

}  // namespace handeye
