// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ScratchFile.h"

#include "AtomicFile.h"
#include "FileError.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <new>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace handeye::io
{

std::string temporaryName()
{
  static std::atomic<unsigned> counter{ 0 };
  return ".handeye-" + std::to_string(getpid()) + "-" + std::to_string(counter++) + ".tmp";
}

std::filesystem::path withLinksFollowed(const std::filesystem::path& path)
{
  std::error_code error;
  const std::filesystem::path resolved = std::filesystem::weakly_canonical(path, error);
  return error ? path : resolved;
}

ScratchFile::ScratchFile(const std::filesystem::path& target)
  : path_(target)
{
  std::error_code error;
  const std::filesystem::path resolved = withLinksFollowed(target);
  const std::filesystem::file_status status = std::filesystem::status(resolved, error);
  const bool isDirect = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
  const std::filesystem::path beside = resolved.has_parent_path() ? resolved.parent_path() : std::filesystem::path(".");
  const std::filesystem::path name = (isDirect ? std::filesystem::temp_directory_path() : beside) / temporaryName();
  const int descriptor = open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0)
  {
    throw FileError(target,
      "a temporary file cannot be made in '" + name.parent_path().string() + "' (" + std::generic_category().message(errno) + ")");
  }
  unlink(name.c_str());
  file_.reset(fdopen(descriptor, "w+b"));
  if (!file_)
  {
    close(descriptor);
    throw std::bad_alloc();
  }
}

void ScratchFile::write(const void* bytes, std::size_t count)
{
  if (std::fwrite(bytes, 1, count, file_.get()) != count)
  {
    throw FileError(path_, "the temporary file beside it cannot be written (" + std::generic_category().message(errno) + ")");
  }
  written_ += count;
}

void ScratchFile::mark()
{
  if (std::fflush(file_.get()) != 0)
  {
    throw FileError(path_, "the temporary file beside it cannot be written (" + std::generic_category().message(errno) + ")");
  }
  marked_ = written_;
}

void ScratchFile::copyTo(AtomicFile& file)
{
  std::string buffer(1 << 18, '\0');
  for (std::size_t at = 0; at < marked_;)
  {
    const ssize_t count = pread(fileno(file_.get()), buffer.data(), std::min(buffer.size(), marked_ - at), off_t(at));
    if (count <= 0)
    {
      throw FileError(path_, "the temporary file beside it cannot be read back (" + std::generic_category().message(errno) + ")");
    }
    file.write(buffer.data(), std::size_t(count));
    at += std::size_t(count);
  }
}

}  // namespace handeye::io
