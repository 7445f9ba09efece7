// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RecordingFolder.h"

#include "FileError.h"
#include "NumberText.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace handeye::io
{

namespace
{

constexpr long long MostImages = 10'000'000;
constexpr std::size_t MostGapsListed = 8;

bool isImageName(const std::filesystem::path& path)
{
  constexpr std::array<std::string_view, 6> endings = { ".jpg", ".jpeg", ".png", ".bmp", ".tif", ".tiff" };
  const std::string ending = path.extension().string();
  return std::any_of(endings.begin(), endings.end(), [&](std::string_view known) { return equalsIgnoreCase(ending, known); });
}

/// The number that is the whole name before the ending: 12 for "0012.jpg"
std::optional<int> frameNumberOf(const std::filesystem::path& path)
{
  const std::string stem = path.stem().string();
  const bool isDigits = !stem.empty() && stem.find_first_not_of("0123456789") == std::string::npos;
  const std::optional<long long> number = isDigits ? parseInteger(stem) : std::nullopt;
  return number && *number < MostImages ? std::optional<int>(static_cast<int>(*number)) : std::nullopt;
}

std::string fourDigits(int number)
{
  const std::string digits = std::to_string(number);
  return std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits;
}

/// A sentence on the numbers that are missing below the highest; empty if none is.
std::string gapsIn(const std::map<int, std::filesystem::path>& images)
{
  std::string listed;
  std::size_t gapCount = 0;
  int next = 0;
  for (const auto& entry : images)
  {
    if (entry.first > next)
    {
      const std::string range = fourDigits(next) + (entry.first - 1 > next ? "-" + fourDigits(entry.first - 1) : "");
      listed += gapCount < MostGapsListed ? (gapCount ? ", " : "") + range : "";
      ++gapCount;
    }
    next = entry.first + 1;
  }
  if (gapCount == 0)
  {
    return {};
  }
  return "frames/ has no image " + listed + (gapCount > MostGapsListed ? ", ..." : "") + " (numbered from 0000)";
}

}  // namespace

FrameImages listFrameImages(const std::filesystem::path& framesFolder)
{
  std::error_code error;
  const std::string example = (framesFolder / "0000.jpg").string();
  std::filesystem::directory_iterator entries(framesFolder, error);
  if (error)
  {
    throw FileError(framesFolder, "this folder of images is missing or cannot be read; expected '" + example + "' (or .png)");
  }

  FrameImages result;
  std::map<int, std::filesystem::path> images;
  std::size_t otherCount = 0;
  std::vector<std::filesystem::path> paths;
  for (; entries != std::filesystem::directory_iterator(); entries.increment(error))
  {
    paths.push_back(entries->path());
  }
  std::sort(paths.begin(), paths.end());
  for (const std::filesystem::path& path : paths)
  {
    if (!isImageName(path) || path.filename().string()[0] == '.')
    {
      continue;
    }
    const std::optional<int> number = frameNumberOf(path);
    if (!number)
    {
      ++otherCount;
    }
    else if (!images.emplace(*number, path).second)
    {
      result.warnings.push_back("frame " + std::to_string(*number) + " has two images; '" + images[*number].filename().string() +
        "' is used and '" + path.filename().string() + "' is not");
    }
  }
  if (images.empty())
  {
    throw FileError(framesFolder, "there are no numbered images; expected '" + example + "' (or .png) and so on");
  }
  if (otherCount > 0)
  {
    result.warnings.push_back(std::to_string(otherCount) + " images in frames/ have a name that is not a number and are not used");
  }
  const std::string gaps = gapsIn(images);
  if (!gaps.empty())
  {
    result.warnings.push_back(gaps);
  }
  result.files = std::move(images);
  return result;
}

}  // namespace handeye::io
