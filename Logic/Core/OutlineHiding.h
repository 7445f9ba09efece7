// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "OutlinePixels.h"
#include "OutlineSide.h"
#include "SphereCone.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace handeye
{

/// Where an outline goes under something in front of the ball: near there the edge of that is straight, and has one light behind it.
/// Internal to the detection.
struct HidingEdge
{
  std::size_t corner = 0;                                   ///< point of the outline near which it goes under
  int towardsHidden = 1;                                    ///< the hidden points follow (1) or come before (-1)
  std::size_t hiddenCount = 0;                              ///< points from there to the middle of what is hidden
  Eigen::Vector2d pivot_Image = Eigen::Vector2d::Zero();    ///< px, near the edge
  Eigen::Vector2d normal_Image = Eigen::Vector2d::UnitX();  ///< towards what is hidden
  double offsetPx = 0;                                      ///< of the edge from the pivot along the normal
  Eigen::Vector3f light = Eigen::Vector3f::Zero();          ///< of what hides
  Eigen::Vector3f variance = Eigen::Vector3f::Ones();       ///< of that, were the noise of the encoded value 1

  /// How far beyond the edge a place is, px.
  double beyondPx(const Eigen::Vector2d& place_Image) const { return normal_Image.dot(place_Image - pivot_Image) - offsetPx; }
  /// The edge's own two parameters are its offset (px) and its turn about the pivot (rad): how fast beyondPx() grows with the latter.
  double turnRate(const Eigen::Vector2d& place_Image) const
  {
    const Eigen::Vector2d arm = place_Image - pivot_Image;
    return normal_Image.x() * arm.y() - normal_Image.y() * arm.x();
  }
  void move(double offsetPx, double turn);
};

/// What is known when hiding edges are looked for.
struct HidingSearch
{
  const SphereCone::Outline& outline;
  const std::vector<OutlinePixel>& pixels;
  const OutlineSide& inside;  ///< the light where the outline is seen
  const OutlineSide& outside;
  const std::vector<char>& isEdge;  ///< point by point: the ball ends there as it should
  double nearPx;                    ///< pixels further than this from the outline are of one side alone
  float noiseVariance;              ///< of the encoded value
};

/// The edges of what hides parts of an outline, good to about a px; at most four. Where something is not as simple as that there is
/// none.
std::vector<HidingEdge> findHidingEdges(const HidingSearch& search);

/// The share of a blurred pixel that lies both inside of an outline and on the seen side of an edge, by the bivariate normal
/// distribution.
struct WedgeShare
{
  double share = 0;
  double byInside = 0;  ///< derivative by the first distance
  double bySeen = 0;    ///< by the second
};

/// @param inside, seen how far inside and on the seen side of the two, in blurs
/// @param cosine of the angle between their normals, which point out of the ball and to what is hidden
WedgeShare shareOfWedge(double inside, double seen, double cosine);

}  // namespace handeye
