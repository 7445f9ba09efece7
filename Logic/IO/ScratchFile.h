// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "TextFile.h"

#include <cstddef>
#include <filesystem>
#include <string>

namespace handeye::io
{

class AtomicFile;

/// A name for a temporary file that no other thread or process uses at this time.
std::string temporaryName();

/// Where a chain of symbolic links ends, so that renaming replaces the file and not the link.
std::filesystem::path withLinksFollowed(const std::filesystem::path& path);

/// A file without a name, in the folder of the file for which it is collected: whatever happens, nothing is left behind.
class ScratchFile
{
public:
  /// @throws FileError where the folder cannot be written to
  explicit ScratchFile(const std::filesystem::path& target);

  void write(const void* bytes, std::size_t count);

  /// What has been written so far is whole; on the disk as far as there is room. @throws FileError where there is none
  void mark();

  /// Appends everything up to the last mark to another file, also after a write that failed.
  void copyTo(AtomicFile& file);

private:
  std::filesystem::path path_;  ///< of the target, for messages
  FileHandle file_;
  std::size_t written_ = 0, marked_ = 0;  ///< bytes
};

}  // namespace handeye::io
