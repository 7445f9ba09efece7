// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "RayGrid.h"
#include "SphereCone.h"

#include <opencv2/core.hpp>

#include <functional>
#include <vector>

namespace handeye
{

struct BallCandidates
{
  /// At most a dozen of the largest regions, the best supported first, then at most six of smaller ones that are round by themselves; the
  /// same ball may be there more than once.
  std::vector<SphereCone> cones;
  cv::Rect around;  ///< px of the image: outside of it there is no region that is large enough
};

/// Places in a colour mask where a ball may be: for each connected region the cones that best follow its border, whatever is
/// attached to it. Coarse (about a pixel); internal to the detection.
///
/// @param mask not 0 where the colour is the ball's; of a window of the image, whose upper left pixel is `origin`
/// @param grid the rays of the whole image, whose border is nobody's outline
/// @param focalPx px per radian near the axis
/// @param minimumRadiusPx smaller regions are passed over
/// @param isKnown told a region's bounding box (px of the image); regions for which it says true are passed over
/// Thread-safe and deterministic.
BallCandidates findBallCandidates(const cv::Mat& mask, const cv::Point& origin, const RayGrid& grid, double focalPx,
  double minimumRadiusPx, const std::function<bool(const cv::Rect&)>& isKnown);

}  // namespace handeye
