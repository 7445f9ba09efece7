// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "SequenceMetafile.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace handeye::io
{

/// The header of a sequence metafile, read and checked.
struct SequenceHeader
{
  std::filesystem::path path;
  std::filesystem::path pixelPath;   ///< the same, unless ElementDataFile names another file
  std::uint64_t pixelOffset = 0;     ///< where the pixels begin in that file, bytes
  std::uint64_t pixelFileBytes = 0;  ///< what follows there; with CompressedDataSize, this many

  int width = 0;  ///< px; 0 for transforms only
  int height = 0;
  int channels = 1;
  int bytesPerSample = 1;
  bool isBigEndian = false;
  bool isCompressed = false;
  std::string orientation = "XX";
  int frameCount = 0;

  std::map<int, SequenceFrame> frames;      ///< those that the header mentions; a hostile count must not allocate the rest
  std::vector<std::string> transformNames;  ///< sorted
  std::map<std::string, std::string> fields;
  std::vector<std::string> warnings;

  bool hasImages() const { return width > 0; }
  std::uint64_t frameBytes() const { return std::uint64_t(width) * height * channels * bytesPerSample; }
};

/// @throws FileError
SequenceHeader readSequenceHeader(const std::filesystem::path& path);

/// The per-frame fields of a header as they come in.
class SequenceFrameFields
{
public:
  explicit SequenceFrameFields(const std::filesystem::path& path)
    : path_(path)
  {
  }

  /// Takes "Seq_Frame0000_Name = value". @throws FileError
  void read(long long line, std::string_view key, std::string_view value);

  /// Hands the frames over to the header, whose frameCount is known by now. @throws FileError for frames beyond it
  void finish(SequenceHeader& header);

private:
  void readTransform(long long line, SequenceFrame& frame, std::string_view name, std::string_view value) const;
  void readOther(long long line, SequenceFrame& frame, std::string_view name, std::string_view value) const;

  std::filesystem::path path_;
  std::map<int, SequenceFrame> frames_;
  long long lineOfLastFrame_ = 0;  ///< where the highest frame index was seen first
};

}  // namespace handeye::io
