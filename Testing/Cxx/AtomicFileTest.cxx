// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "AtomicFile.h"

#include "IoTestSupport.h"

#include <csignal>

#include <sys/resource.h>
#include <unistd.h>

using namespace handeye::io;
using namespace handeye::io::test;

namespace
{

/// Files of this process cannot grow beyond a size, as on a full disk.
class FileSizeLimit
{
public:
  explicit FileSizeLimit(rlim_t bytes)
  {
    previousHandler_ = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &previous_);
    rlimit limit = previous_;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit()
  {
    setrlimit(RLIMIT_FSIZE, &previous_);
    std::signal(SIGXFSZ, previousHandler_);
  }

private:
  rlimit previous_ = {};
  void (*previousHandler_)(int) = nullptr;
};

}  // namespace

TEST(AtomicFile, NewFile_HasTheBytesAndNothingElseIsThere)
{
  const TemporaryFolder folder;
  const std::string bytes("a\0b\n", 4);
  writeFileAtomically(folder.path() / "new.bin", bytes);
  EXPECT_EQ(readBytes(folder.path() / "new.bin"), bytes);
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(AtomicFile, ExistingFile_IsReplacedAndKeepsItsPermissions)
{
  const TemporaryFolder folder;
  const auto path = folder.write("old.txt", "a much longer text than the new one");
  std::filesystem::permissions(path, std::filesystem::perms(0640));
  writeFileAtomically(path, "new");
  EXPECT_EQ(readBytes(path), "new");
  EXPECT_EQ(std::filesystem::status(path).permissions(), std::filesystem::perms(0640));
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(AtomicFile, WithoutCommit_LeavesTheOldFileAndNoTemporary)
{
  const TemporaryFolder folder;
  const auto path = folder.write("old.txt", "old");
  {
    AtomicFile file(path);
    file.write("half of it");
    EXPECT_EQ(readBytes(path), "old");
  }
  EXPECT_EQ(readBytes(path), "old");
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(AtomicFile, DiskFull_ReportsItAndLeavesTheOldFile)
{
  const TemporaryFolder folder;
  const auto path = folder.write("old.txt", "old");
  {
    const FileSizeLimit limit(1000);
    expectFileError(
      [&] { writeFileAtomically(path, std::string(100000, 'x')); }, { path.string(), "cannot be written to the end" });
  }
  EXPECT_EQ(readBytes(path), "old");
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(AtomicFile, DeviceWithoutSpace_IsReported)
{
  expectFileError([] { writeFileAtomically("/dev/full", "x"); }, { "/dev/full", "No space left" });
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(AtomicFile, Device_IsWrittenToAndStaysADevice)
{
  writeFileAtomically("/dev/null", "x");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(AtomicFile, NoFolder_NamesTheFolder)
{
  const TemporaryFolder folder;
  expectFileError([&] { writeFileAtomically(folder.path() / "no" / "file.txt", "x"); }, { "there is no folder", "/no'" });
}

TEST(AtomicFile, UnwritableFolder_IsReported)
{
  expectFileError([] { writeFileAtomically("/proc/handeye.txt", "x"); }, { "/proc/handeye.txt", "cannot be written" });
}

TEST(AtomicFile, FolderOrNoNameAsTarget_IsRefused)
{
  const TemporaryFolder folder;
  expectFileError([&] { writeFileAtomically(folder.path(), "x"); }, { "this is a folder" });
  expectFileError([&] { writeFileAtomically("", "x"); }, { "a file name was expected" });
  expectFileError([&] { writeFileAtomically(folder.path().string() + "/", "x"); }, { "a file name was expected" });
}

TEST(AtomicFile, SymbolicLink_StaysALinkToTheNewContents)
{
  const TemporaryFolder folder;
  const auto target = folder.write("target.txt", "old");
  std::filesystem::create_symlink(target, folder.path() / "link.txt");
  writeFileAtomically(folder.path() / "link.txt", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link.txt"));
  EXPECT_EQ(readBytes(target), "new");
}
