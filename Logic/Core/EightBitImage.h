// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

namespace handeye
{

/// The image with 8 bits a channel: itself (its pixels are shared, not copied) where it has them; 16 bits are divided by 257, so
/// that the brightest value stays the brightest one. Other depths are cut off at 0 and 255. Thread-safe.
cv::Mat toEightBit(const cv::Mat& image);

}  // namespace handeye
