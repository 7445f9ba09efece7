// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "FileError.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace handeye::io::test
{

/// A folder for the files of one test, empty at its beginning and gone at its end.
class TemporaryFolder
{
public:
  TemporaryFolder()
    : path_(std::filesystem::path(testing::TempDir()) / ("handeye_" + nameOfTest()))
  {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Writes a file of this name and returns its path; folders in between are made.
  std::filesystem::path write(const std::string& name, const std::string& bytes) const
  {
    const std::filesystem::path path = path_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }

  std::size_t entryCount() const
  {
    return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator()));
  }

private:
  static std::string nameOfTest()
  {
    const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(info->test_suite_name()) + "_" + info->name();
    for (char& c : name)
    {
      c = c == '/' ? '_' : c;
    }
    return name;
  }

  std::filesystem::path path_;
};

inline std::string readBytes(const std::filesystem::path& path)
{
  std::ifstream file(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

/// The call throws a FileError whose sentence has all these words in it.
template<typename Call> void expectFileError(Call call, const std::vector<std::string>& words)
{
  try
  {
    call();
    ADD_FAILURE() << "no FileError; expected one with '" << (words.empty() ? "" : words[0]) << "'";
  }
  catch (const FileError& error)
  {
    for (const std::string& word : words)
    {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << "'" << word << "' is not in: " << error.what();
    }
  }
}

inline bool hasWarning(const std::vector<std::string>& warnings, const std::string& word)
{
  for (const std::string& warning : warnings)
  {
    if (warning.find(word) != std::string::npos)
    {
      return true;
    }
  }
  return false;
}

}  // namespace handeye::io::test
