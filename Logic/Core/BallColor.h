// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

namespace handeye
{

/// The colour of the ball in HSV, and how images store colours. The defaults are a saturated red under any lighting.
struct BallColor
{
  enum class ChannelOrder
  {
    Bgr,  ///< OpenCV's: blue, green, red [, alpha]
    Rgb   ///< red, green, blue [, alpha]
  };

  ChannelOrder channelOrder = ChannelOrder::Bgr;
  double hueDeg = 0;                ///< 0 red, 120 green, 240 blue; wraps around
  double hueToleranceDeg = 16;      ///< to either side, below 60
  double minimumSaturation = 0.35;  ///< 0 to 1, of a single pixel: what shadow and reflected light leave
  double minimumValue = 0.16;       ///< 0 to 1, of a single pixel: darker ones have no trustworthy hue
  double minimumChroma = 0;  ///< 0 to 1, saturation times value of a single pixel: what tells a lit ball from dark red things
  double minimumMedianSaturation = 0.53;  ///< 0 to 1, of the ball as a whole: pink and brown things are not the ball

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// @throws std::invalid_argument with a sentence for an empty or grey image or one that has neither 8 nor 16 bits a channel
void requireColorImage(const cv::Mat& image);

/// The image with 8 bits a channel: itself where it has them, otherwise `buffer`.
const cv::Mat& toEightBits(const cv::Mat& image, cv::Mat& buffer);

/// The image as 8-bit HSV with the hue from 0 to 255 (OpenCV's HSV_FULL).
/// @param image BGR or BGRA, RGB or RGBA, 8 or 16 bit
/// @throws std::invalid_argument as requireColorImage()
cv::Mat toHsv(const cv::Mat& image, BallColor::ChannelOrder order = BallColor::ChannelOrder::Bgr);

/// 255 where a pixel has the ball's colour, 0 elsewhere.
cv::Mat ballColorMask(const cv::Mat& hsv, const BallColor& color);

}  // namespace handeye
