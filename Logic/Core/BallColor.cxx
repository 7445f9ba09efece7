// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallColor.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace handeye
{

namespace
{

constexpr double HighlightValue = 0.75;

int toByte(double share)
{
  return int(std::lround(255 * share));
}

}  // namespace

void BallColor::check() const
{
  const auto isShare = [](double value) { return value >= 0 && value <= 1; };
  if (!std::isfinite(hueDeg) || !(hueToleranceDeg > 0 && hueToleranceDeg < 180) || !isShare(minimumSaturation) ||
    !isShare(minimumValue) || !isShare(minimumChroma) || !isShare(minimumMedianSaturation))
  {
    throw std::invalid_argument("ball colour: a hue tolerance between 0 and 180 deg and shares between 0 and 1 are expected");
  }
}

cv::Mat toHsv(const cv::Mat& image)
{
  if (image.empty())
  {
    throw std::invalid_argument("the image is empty");
  }
  if (image.channels() != 3 && image.channels() != 4)
  {
    throw std::invalid_argument("the image has " + std::to_string(image.channels()) +
      " channel: the ball is found by its colour, a BGR or BGRA image is expected");
  }
  if (image.depth() != CV_8U && image.depth() != CV_16U)
  {
    throw std::invalid_argument("the image has neither 8 nor 16 bits a channel");
  }
  cv::Mat eight = image;
  if (image.depth() == CV_16U)
  {
    image.convertTo(eight, CV_8U, 1.0 / 257);
  }
  if (eight.channels() == 4)
  {
    cv::cvtColor(eight, eight, cv::COLOR_BGRA2BGR);
  }
  cv::Mat hsv;
  cv::cvtColor(eight, hsv, cv::COLOR_BGR2HSV_FULL);
  return hsv;
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

std::vector<BallColor> colorLevels(const BallColor& color)
{
  struct Demand
  {
    double saturation;
    double chroma;
  };
  static const Demand demands[] = { { 0.52, 0 }, { 0.66, 0 }, { 0.45, 0.35 }, { 0.6, 0.55 } };
  std::vector<BallColor> levels = { color };
  for (const Demand& demand : demands)
  {
    BallColor level = color;
    level.minimumSaturation = std::max(color.minimumSaturation, demand.saturation);
    level.minimumChroma = std::max(color.minimumChroma, demand.chroma);
    levels.push_back(level);
  }
  return levels;
}

cv::Mat highlightMask(const cv::Mat& hsv)
{
  cv::Mat mask;
  cv::inRange(hsv, cv::Scalar(0, 0, toByte(HighlightValue)), cv::Scalar(255, 255, 255), mask);
  return mask;
}

}  // namespace handeye
