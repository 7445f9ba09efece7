// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallEvidence.h"
#include "OutlineFit.h"
#include "SphereCone.h"

#include <opencv2/core.hpp>

#include <algorithm>
#include <vector>

namespace handeye
{

/// A ball that was found. Internal to the detection.
struct FoundBall
{
  OutlineFit fit;
  BallEvidence evidence;

  double score() const { return evidence.score; }

  /// Two outlines of the same thing: their centres are closer than the larger radius.
  bool isSameAs(const FoundBall& other) const;

  /// The candidate leads to this ball again: place and size differ by a tenth of the size.
  bool isSameAs(const SphereCone& candidate) const;

  /// No side of the region (px) lies more than a few px beyond the outline.
  bool contains(const cv::Rect& region) const;
};

/// All that is found in one image, each ball once.
class BallFindings
{
public:
  std::vector<FoundBall> balls;
  std::vector<FoundBall> smeared;  ///< what would be a ball, had it not moved
  double partlySeen = 0;           ///< visible share of something that is a ball but for that

  template<typename Other> bool has(const Other& other) const
  {
    return std::any_of(balls.begin(), balls.end(), [&](const FoundBall& ball) { return ball.isSameAs(other); });
  }

  bool hasAround(const cv::Rect& region) const;

  /// Of two outlines of one ball the better stays; what is only part of a ball is noted in `partlySeen`.
  void add(const FoundBall& found);

  /// Puts the best first, and takes out what is only a piece of something smeared.
  void sort();
};

}  // namespace handeye
