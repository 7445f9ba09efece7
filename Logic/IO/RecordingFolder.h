// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace handeye::io
{

/// The pictures in the folder frames/ of a recording.
struct FrameImages
{
  std::map<int, std::filesystem::path> files;  ///< by frame; at least one
  std::vector<std::string> warnings;
};

/// Lists frames/0000.jpg, frames/0001.jpg, ... (any number of digits; jpg, jpeg, png, bmp, tif, tiff).
/// @throws FileError where there is no such folder or no such picture in it
FrameImages listFrameImages(const std::filesystem::path& framesFolder);

}  // namespace handeye::io
