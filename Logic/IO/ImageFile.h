// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include <filesystem>

namespace handeye::io
{

/// Reads jpeg, png, bmp or tiff as it is stored: 8 or 16 bits; grey or BGR. An alpha channel is dropped, and a note on how to turn
/// the picture (EXIF) is not followed, since a lens is calibrated for the pixels of the sensor.
/// @throws FileError where the file is missing, cut short or not an image
[[nodiscard]] cv::Mat readImage(const std::filesystem::path& path);

/// Writes a PNG file (8 or 16 bits; grey, BGR or BGRA) as writeFileAtomically() does.
/// @throws FileError where it cannot be written, std::invalid_argument for an empty image or another depth
void writePng(const std::filesystem::path& path, const cv::Mat& image);

}  // namespace handeye::io
