// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include <vector>

namespace handeye
{

/// The colour of the ball in HSV. The defaults are a saturated red under any lighting.
struct BallColor
{
  double hueDeg = 0;                ///< 0 red, 120 green, 240 blue; wraps around
  double hueToleranceDeg = 16;      ///< to either side
  double minimumSaturation = 0.35;  ///< 0 to 1, of a single pixel: what shadow and reflected light leave
  double minimumValue = 0.16;       ///< 0 to 1, of a single pixel: darker ones have no trustworthy hue
  double minimumChroma = 0;  ///< 0 to 1, saturation times value of a single pixel: what tells a lit ball from dark red things
  double minimumMedianSaturation = 0.53;  ///< 0 to 1, of the ball as a whole: pink and brown things are not the ball

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// The image as 8-bit HSV with the hue from 0 to 255 (OpenCV's HSV_FULL).
/// @param image BGR or BGRA, 8 or 16 bit
/// @throws std::invalid_argument for an empty or grey image or another depth
cv::Mat toHsv(const cv::Mat& image);

/// 255 where a pixel can belong to the ball by its own colour, 0 elsewhere.
cv::Mat ballColorMask(const cv::Mat& hsv, const BallColor& color);

/// The same hue with rising demands on saturation and chroma. What surrounds the ball may be red as well (tissue, skin, wood): at
/// one of these levels the ball stands alone.
std::vector<BallColor> colorLevels(const BallColor& color);

/// 255 where a pixel can belong to a highlight on the ball: bright and pale.
cv::Mat highlightMask(const cv::Mat& hsv);

}  // namespace handeye
