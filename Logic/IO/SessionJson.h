// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Session.h"

#include <cstdint>
#include <filesystem>

namespace handeye::io
{

/// What samples/NNNN.json holds.
struct StoredSample
{
  SessionSample sample;
  std::size_t imageBytes = 0;  ///< of frames/NNNN.png
  std::uint32_t imageCrc = 0;  ///< CRC-32 of these bytes
};

nlohmann::json toJson(const StoredSample& stored);

/// @throws FileError naming the key
StoredSample parseSample(const std::filesystem::path& path, int id);

/// "0007"
std::string frameDigits(int id);

/// The number in "0007.json"; -1 for another name.
int idOf(const std::filesystem::path& path, const std::string& extension);

}  // namespace handeye::io
