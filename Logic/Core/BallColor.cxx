// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallColor.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace handeye
{

namespace
{

/// An image is dim when its brightest twentieth stays below this value.
constexpr double WellLit = 0.6;
/// However dim it is, no more than this share of the smallest value is let go.
constexpr double DarkestShare = 0.35;
constexpr double LightSamples = 4000;

int toByte(double share)
{
  return int(std::lround(255 * share));
}

}  // namespace

void BallColor::check() const
{
  const auto isShare = [](double value) { return value >= 0 && value <= 1; };
  if (!std::isfinite(hueDeg) || !(hueToleranceDeg > 0 && hueToleranceDeg < 60) || !isShare(minimumSaturation) ||
    !isShare(minimumValue) || !isShare(minimumChroma) || !isShare(minimumMedianSaturation))
  {
    throw std::invalid_argument("ball colour: a hue tolerance between 0 and 60 deg and shares between 0 and 1 are expected");
  }
}

void requireColorImage(const cv::Mat& image)
{
  if (image.empty())
  {
    throw std::invalid_argument("the image is empty");
  }
  if (image.channels() != 3 && image.channels() != 4)
  {
    throw std::invalid_argument("the image has " + std::to_string(image.channels()) +
      (image.channels() == 1 ? " channel (grey)" : " channels") +
      ": the ball is found by its colour, an image with 3 channels, or 4 with alpha, is expected");
  }
  if (image.depth() != CV_8U && image.depth() != CV_16U)
  {
    throw std::invalid_argument("the image has neither 8 nor 16 bits a channel");
  }
}

const cv::Mat& toEightBits(const cv::Mat& image, cv::Mat& buffer)
{
  if (image.depth() == CV_8U)
  {
    return image;
  }
  image.convertTo(buffer, CV_8U, 1.0 / 257);  // into the buffer that the caller keeps, unlike toEightBit()
  return buffer;
}

cv::Mat toHsv(const cv::Mat& image, BallColor::ChannelOrder order)
{
  requireColorImage(image);
  cv::Mat buffer, hsv;
  const bool isBgr = order == BallColor::ChannelOrder::Bgr;
  cv::cvtColor(toEightBits(image, buffer), hsv, isBgr ? cv::COLOR_BGR2HSV_FULL : cv::COLOR_RGB2HSV_FULL);
  return hsv;
}

BallColor adaptToLight(const BallColor& color, const cv::Mat& image)
{
  requireColorImage(image);
  // A few thousand pixels say how bright the image is.
  const int step = std::max(1, int(std::sqrt(double(image.total()) / LightSamples)));
  const bool isWide = image.depth() == CV_16U;
  std::vector<int> values;
  for (int row = std::min(step / 2, image.rows - 1); row < image.rows; row += step)
  {
    for (int column = std::min(step / 2, image.cols - 1); column < image.cols; column += step)
    {
      const int offset = column * image.channels();
      const auto largest = [](const auto* pixel) { return int(std::max({ pixel[0], pixel[1], pixel[2] })); };
      values.push_back(isWide ? largest(image.ptr<ushort>(row) + offset) / 257 : largest(image.ptr<uchar>(row) + offset));
    }
  }
  const auto bright = values.begin() + std::ptrdiff_t(0.95 * double(values.size() - 1));
  std::nth_element(values.begin(), bright, values.end());
  BallColor adapted = color;
  adapted.minimumValue *= std::clamp(*bright / 255.0 / WellLit, DarkestShare, 1.0);
  return adapted;
}

cv::Mat ballColorMask(const cv::Mat& hsv, const BallColor& color)
{
  // A table over the hue handles its wrap-around; saturation and value are plain thresholds.
  cv::Mat hueTable(1, 256, CV_8U);
  for (int hue = 0; hue < 256; ++hue)
  {
    const double apart = std::remainder(hue * 360.0 / 256 - color.hueDeg, 360.0);
    hueTable.at<uchar>(hue) = std::abs(apart) <= color.hueToleranceDeg ? 255 : 0;
  }
  cv::Mat hue, isHue, isVivid;
  cv::extractChannel(hsv, hue, 0);
  cv::LUT(hue, hueTable, isHue);
  if (color.minimumChroma > 0)
  {
    cv::Mat saturation, value, chroma;
    cv::extractChannel(hsv, saturation, 1);
    cv::extractChannel(hsv, value, 2);
    cv::multiply(saturation, value, chroma, 1.0 / 255);
    isHue &= chroma >= toByte(color.minimumChroma);
  }
  cv::inRange(hsv, cv::Scalar(0, toByte(color.minimumSaturation), toByte(color.minimumValue)), cv::Scalar(255, 255, 255), isVivid);
  return isHue & isVivid;
}

}  // namespace handeye
