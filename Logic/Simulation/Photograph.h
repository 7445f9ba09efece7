// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace handeye::simulation
{

/// Blue, green, red in linear light, 0 to 1.
using Light = cv::Vec3f;

struct Photograph
{
  double blurPx = 0.7;  ///< standard deviation of the optics' blur, in linear light
  double noise = 0;     ///< standard deviation in steps of 8 bits, after the encoding
  int type = CV_8UC3;   ///< CV_8UC3 or CV_16UC3
  unsigned seed = 1;
};

/// Linear light to the encoded value (sRGB), 0 to 1.
inline float encode(float linear)
{
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
}

/// The same to a 65536th, quickly, and cut off at 0 and 1 as a sensor does.
inline float encodeByTable(float linear)
{
  static const std::vector<float> table = []
  {
    std::vector<float> values;
    for (int i = 0; i <= 65535; ++i)
    {
      values.push_back(encode(float(i) / 65535));
    }
    return values;
  }();
  return table[std::size_t(std::clamp(std::lround(linear * 65535), 0L, 65535L))];
}

/// Linear light (after the optics) to the camera's picture: encoded, with noise, rounded and cut off at white.
inline cv::Mat develop(const cv::Mat& light, const Photograph& how)
{
  cv::Mat noise(light.size(), CV_32FC3, cv::Scalar::all(0));
  cv::RNG random(how.seed);
  if (how.noise > 0)
  {
    random.fill(noise, cv::RNG::NORMAL, cv::Scalar::all(0), cv::Scalar::all(how.noise / 255));
  }
  const bool isWide = CV_MAT_DEPTH(how.type) == CV_16U;
  cv::Mat encoded(light.size(), CV_32FC3);
  for (int row = 0; row < light.rows; ++row)
  {
    const float* from = light.ptr<float>(row);
    float* to = encoded.ptr<float>(row);
    for (int i = 0; i < 3 * light.cols; ++i)
    {
      to[i] = isWide ? encode(from[i]) : encodeByTable(from[i]);
    }
  }
  cv::Mat image;
  cv::Mat(encoded + noise).convertTo(image, how.type, isWide ? 65535 : 255);  // rounds and saturates
  return image;
}

}  // namespace handeye::simulation
