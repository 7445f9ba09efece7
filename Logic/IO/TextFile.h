// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

namespace handeye::io
{

struct FileCloser
{
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, FileCloser>;

/// @throws FileError where it is missing, a folder or not readable
FileHandle openForReading(const std::filesystem::path& path);

/// The bytes of a file that is expected to be small.
/// @throws FileError as openForReading(), and for a file that is larger than the limit
std::string readWholeFile(const std::filesystem::path& path, std::size_t maximumBytes);

/// Reads a file line by line, the line ends removed (also CR LF), knowing where in the file it is.
class LineReader
{
public:
  explicit LineReader(const std::filesystem::path& path);

  /// @return false at the end of the file
  /// @throws FileError for a line longer than a megabyte: no text, then
  bool readLine(std::string& line);

  /// The number of the line read last, from 1.
  long long lineNumber() const { return lineNumber_; }
  /// Where the next line begins, bytes from the beginning of the file.
  long long offset() const { return offset_; }

private:
  bool fill();

  std::filesystem::path path_;
  FileHandle file_;
  std::string buffer_;
  std::size_t position_ = 0;
  long long lineNumber_ = 0;
  long long offset_ = 0;
};

}  // namespace handeye::io
