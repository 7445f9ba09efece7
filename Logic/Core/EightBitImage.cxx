// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EightBitImage.h"

namespace handeye
{

cv::Mat toEightBit(const cv::Mat& image)
{
  if (image.depth() == CV_8U)
  {
    return image;
  }
  cv::Mat eight;
  image.convertTo(eight, CV_8U, image.depth() == CV_16U ? 1.0 / 257 : 1.0);
  return eight;
}

}  // namespace handeye
