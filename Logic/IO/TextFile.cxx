// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TextFile.h"

#include "FileError.h"

#include <cerrno>
#include <system_error>

namespace handeye::io
{

namespace
{

constexpr std::size_t BufferBytes = 1 << 16;
constexpr std::size_t LongestLineBytes = 1 << 20;

std::string reasonOf(int error)
{
  return std::generic_category().message(error);
}

}  // namespace

FileHandle openForReading(const std::filesystem::path& path)
{
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found)
  {
    throw FileError(path, "there is no such file");
  }
  if (std::filesystem::is_directory(status))
  {
    throw FileError(path, "this is a folder; a file was expected");
  }
  FileHandle file(std::fopen(path.c_str(), "rb"));
  if (!file)
  {
    throw FileError(path, "cannot be opened for reading (" + reasonOf(errno) + ")");
  }
  return file;
}

std::string readWholeFile(const std::filesystem::path& path, std::size_t maximumBytes)
{
  const FileHandle file = openForReading(path);
  std::string bytes;
  while (true)
  {
    const std::size_t before = bytes.size();
    bytes.resize(before + BufferBytes);
    const std::size_t count = std::fread(bytes.data() + before, 1, BufferBytes, file.get());
    bytes.resize(before + count);
    if (std::ferror(file.get()))
    {
      throw FileError(path, "cannot be read (" + reasonOf(errno) + ")");
    }
    if (bytes.size() > maximumBytes)
    {
      throw FileError(path, "larger than " + std::to_string(maximumBytes >> 20) + " MB; a file of this kind is far smaller");
    }
    if (count == 0)
    {
      return bytes;
    }
  }
}

LineReader::LineReader(const std::filesystem::path& path)
  : path_(path)
  , file_(openForReading(path))
{
}

bool LineReader::readLine(std::string& line)
{
  line.clear();
  bool isAnythingRead = false;
  while (position_ < buffer_.size() || fill())
  {
    isAnythingRead = true;
    const std::size_t end = buffer_.find('\n', position_);
    const std::size_t count = (end == std::string::npos ? buffer_.size() : end) - position_;
    line.append(buffer_, position_, count);
    if (line.size() > LongestLineBytes)
    {
      throw FileError(path_, lineNumber_ + 1, "this line has more than a million characters; lines of text were expected");
    }
    const std::size_t consumed = count + (end == std::string::npos ? 0 : 1);
    position_ += consumed;
    offset_ += static_cast<long long>(consumed);
    if (end != std::string::npos)
    {
      break;
    }
  }
  lineNumber_ += isAnythingRead ? 1 : 0;
  if (!line.empty() && line.back() == '\r')
  {
    line.pop_back();
  }
  return isAnythingRead;
}

bool LineReader::fill()
{
  buffer_.resize(BufferBytes);
  buffer_.resize(std::fread(buffer_.data(), 1, BufferBytes, file_.get()));
  position_ = 0;
  if (std::ferror(file_.get()))
  {
    throw FileError(path_, "cannot be read (" + reasonOf(errno) + ")");
  }
  return !buffer_.empty();
}

}  // namespace handeye::io
