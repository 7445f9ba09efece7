// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace handeye::io
{

/// Writes a file so that it is either complete or as it was before: the bytes go to a temporary file in the same folder, which is
/// flushed to the disk and renamed. A symbolic link is followed; an existing file keeps its permissions. Something that is neither
/// a file nor a folder (/dev/stdout, a pipe) is written to directly.
/// @throws FileError (no folder, no permission, disk full, ...); the temporary file is then removed and the old one intact
void writeFileAtomically(const std::filesystem::path& path, std::string_view bytes);

/// The same for contents that come bit by bit: write() what there is, then commit(). Without commit() nothing remains.
class AtomicFile
{
public:
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* bytes, std::size_t count);
  void write(std::string_view bytes) { write(bytes.data(), bytes.size()); }

  /// Flushes to the disk and renames over the target.
  void commit();

private:
  [[noreturn]] void fail(const std::string& what, int error);
  void openTemporary();
  void discard() noexcept;

  std::filesystem::path path_;       ///< as given, for messages
  std::filesystem::path target_;     ///< with links followed
  std::filesystem::path temporary_;  ///< empty if the target is written to directly, or after commit()
  int descriptor_ = -1;
};

}  // namespace handeye::io
