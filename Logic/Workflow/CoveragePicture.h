// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LensViewCollector.h"

#include <opencv2/core.hpp>

#include <filesystem>
#include <vector>

namespace handeye
{

/// Where a lens calibration has points: the image's cells, darker green with more points, white where there are none; each point of
/// the views, those of outliers red; and its residual as a line, 50 times as long. Beside it how often the board was tilted which
/// way.
/// @param result of calibrateLens() on `views`; without a usable one there are no residuals
cv::Mat drawCoverage(const LensViewCollector& collector, const LensCalibrationResult& result, const std::vector<LensView>& views,
  int width, int height);

/// The same, written as PNG. @throws io::FileError
void writeCoveragePicture(const std::filesystem::path& path, const LensViewCollector& collector,
  const LensCalibrationResult& result, const std::vector<LensView>& views, int width, int height);

}  // namespace handeye
