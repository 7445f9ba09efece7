// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallColor.h"

#include <opencv2/core.hpp>

namespace handeye
{

/// For each pixel of an image, or of a part of it, how well it suits the ball's colour: which of a few levels it meets.
///
/// All levels ask for the same hue, with rising demands on saturation and chroma. What surrounds the ball may be red as well (tissue,
/// skin, wood): at one of the levels the ball stands alone. All are worked out in one pass, without a division: chroma is the
/// largest channel less the smallest, saturation its share of the largest, and a hue is a direction in the plane of the colour
/// differences.
class BallColorLevels
{
public:
  static constexpr int Count = 5;

  /// @param image BGR or BGRA (as `color` says), 8 or 16 bit
  /// @param window the part that is looked at, px, inside the image
  /// @throws std::invalid_argument for an empty or grey image or another depth
  BallColorLevels(const cv::Mat& image, const BallColor& color, const cv::Rect& window);

  const cv::Rect& window() const { return window_; }
  /// Not 0 where a pixel meets a level (0 to Count - 1).
  /// @param part of the window, px of the image
  cv::Mat mask(int level, const cv::Rect& part) const;
  /// How many levels each pixel of the window meets.
  cv::Mat likelihood() const;
  /// Whether a pixel of the image meets a level; false outside of the window.
  bool meets(int level, const cv::Point& pixel) const { return (bitsAt(pixel) >> level & 1) != 0; }
  /// Whether a pixel can belong to a highlight on the ball: bright, and too pale for the ball's colour.
  bool isHighlight(const cv::Point& pixel) const { return (bitsAt(pixel) & HighlightBit) != 0; }

private:
  static constexpr int HighlightBit = 128;

  int bitsAt(const cv::Point& pixel) const { return window_.contains(pixel) ? bits_.at<uchar>(pixel - window_.tl()) : 0; }

  cv::Rect window_;
  cv::Mat bits_;  ///< of the window: a bit a level, and that of highlights
};

}  // namespace handeye
