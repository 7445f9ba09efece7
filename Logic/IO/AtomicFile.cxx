// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "AtomicFile.h"

#include "FileError.h"
#include "ScratchFile.h"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace handeye::io
{

namespace
{

/// Best effort: the renamed entry itself reaches the disk too.
void flushFolder(const std::filesystem::path& folder)
{
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor >= 0)
  {
    fsync(descriptor);
    close(descriptor);
  }
}

}  // namespace

void writeFileAtomically(const std::filesystem::path& path, std::string_view bytes)
{
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

AtomicFile::AtomicFile(const std::filesystem::path& path)
  : path_(path)
  , target_(withLinksFollowed(path))
{
  if (path.empty() || !path.has_filename())
  {
    throw FileError(path, "cannot be written: a file name was expected");
  }
  struct stat existing = {};
  const bool exists = stat(target_.c_str(), &existing) == 0;
  if (exists && S_ISDIR(existing.st_mode))
  {
    throw FileError(path, "cannot be written: this is a folder; a file name was expected");
  }
  if (exists && !S_ISREG(existing.st_mode))
  {
    descriptor_ = open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0)
    {
      fail("cannot be opened for writing", errno);
    }
    return;
  }
  openTemporary();
  if (exists && fchmod(descriptor_, existing.st_mode & 07777) != 0)
  {
    fail("cannot be given the permissions of the file that is there", errno);
  }
}

AtomicFile::~AtomicFile()
{
  discard();
}

void AtomicFile::openTemporary()
{
  const std::filesystem::path folder = target_.has_parent_path() ? target_.parent_path() : std::filesystem::path(".");
  do
  {
    temporary_ = folder / temporaryName();
    descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ < 0)
  {
    const int error = errno;
    temporary_.clear();
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored))
    {
      throw FileError(path_, "cannot be written: there is no folder '" + folder.string() + "'");
    }
    fail("cannot be written", error);
  }
}

void AtomicFile::write(const void* bytes, std::size_t count)
{
  const char* next = static_cast<const char*>(bytes);
  while (count > 0)
  {
    const ssize_t written = ::write(descriptor_, next, count);
    if (written < 0 && errno != EINTR)
    {
      fail("cannot be written to the end", errno);
    }
    next += written < 0 ? 0 : written;
    count -= written < 0 ? 0 : static_cast<std::size_t>(written);
  }
}

void AtomicFile::commit()
{
  const bool isDirect = temporary_.empty();
  if (!isDirect && fsync(descriptor_) != 0)
  {
    fail("cannot be flushed to the disk", errno);
  }
  const int closed = close(descriptor_);
  descriptor_ = -1;
  if (closed != 0)
  {
    fail("cannot be written to the end", errno);
  }
  if (!isDirect)
  {
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0)
    {
      fail("cannot take its name", errno);
    }
    temporary_.clear();
    flushFolder(target_.parent_path().empty() ? "." : target_.parent_path());
  }
}

void AtomicFile::fail(const std::string& what, int error)
{
  discard();
  throw FileError(path_, what + " (" + std::generic_category().message(error) + ")");
}

void AtomicFile::discard() noexcept
{
  if (descriptor_ >= 0)
  {
    close(descriptor_);
    descriptor_ = -1;
  }
  if (!temporary_.empty())
  {
    unlink(temporary_.c_str());
    temporary_.clear();
  }
}

}  // namespace handeye::io
