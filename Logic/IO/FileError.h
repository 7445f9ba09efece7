// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace handeye::io
{

/// A file that cannot be read, is not what it should be, or cannot be written.
///
/// The message is one sentence for the person at the keyboard: which file, which line or field, what was found there and what
/// was expected. It ends without a full stop, so that a program can put it behind its own name.
class FileError : public std::runtime_error
{
public:
  /// "<path>: <sentence>"
  FileError(const std::filesystem::path& path, const std::string& sentence)
    : std::runtime_error(path.string() + ": " + sentence)
  {
  }

  /// "<path>, line <line>: <sentence>"; lines count from 1.
  FileError(const std::filesystem::path& path, long long line, const std::string& sentence)
    : std::runtime_error(path.string() + ", line " + std::to_string(line) + ": " + sentence)
  {
  }
};

}  // namespace handeye::io
