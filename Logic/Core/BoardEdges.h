// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardDetection.h"

#include <opencv2/core.hpp>

namespace handeye
{

/// How sharp the lines of a board are: the median width (10 to 90 %) of black-white steps in the middle between neighbouring
/// points,
/// px; 0 where none could be measured. Internal.
double measureEdgeWidth(const cv::Mat& grey8, const BoardDescription& board, const BoardDetection& detection);

/// The value between pixels, bilinear; the nearest pixel's outside. Internal.
double valueAt(const cv::Mat& grey8, const Eigen::Vector2d& point_Image);

}  // namespace handeye
