// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ImageConversion.h"

#include "EightBitImage.h"

#include <opencv2/imgproc.hpp>

#include <stdexcept>

namespace handeye
{

QImage toQImage(const cv::Mat& image)
{
  if (image.empty())
  {
    return {};
  }
  const cv::Mat bytes = image.depth() == CV_16U ? toEightBit(image) : image;
  if (bytes.depth() != CV_8U || (bytes.channels() != 1 && bytes.channels() != 3 && bytes.channels() != 4))
  {
    throw std::invalid_argument("a picture to be shown has 8 or 16 bits and is grey, BGR or BGRA");
  }
  const bool grey = bytes.channels() == 1;
  const bool alpha = bytes.channels() == 4;
  const QImage::Format format = grey ? QImage::Format_Grayscale8 : alpha ? QImage::Format_ARGB32 : QImage::Format_BGR888;
  return QImage(bytes.data, bytes.cols, bytes.rows, int(bytes.step), format).copy();
}

}  // namespace handeye
