// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QImage>

namespace cv
{
class Mat;
}

namespace handeye
{

/// A picture of OpenCV (8 or 16 bits; grey, BGR or BGRA) as one of Qt's; copied. An empty one gives a null image.
/// @throws std::invalid_argument for another type of picture
QImage toQImage(const cv::Mat& image);

}  // namespace handeye
