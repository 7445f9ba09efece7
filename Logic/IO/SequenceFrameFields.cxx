// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SequenceHeader.h"

#include "FileError.h"
#include "NumberText.h"

#include <cmath>
#include <limits>

namespace handeye::io
{

namespace
{

constexpr std::string_view FramePrefix = "Seq_Frame";
constexpr std::string_view TransformSuffix = "Transform";
constexpr std::string_view StatusSuffix = "TransformStatus";
constexpr std::size_t MostRangesListed = 8;

bool endsWith(std::string_view text, std::string_view suffix)
{
  return text.size() > suffix.size() && text.substr(text.size() - suffix.size()) == suffix;
}

std::string_view withoutEnd(std::string_view text, std::size_t count)
{
  return text.substr(0, text.size() - count);
}

std::string range(int first, int last)
{
  return first == last ? std::to_string(first) : std::to_string(first) + "-" + std::to_string(last);
}

/// "3, 7-9" of the indices below `count` that are not among the frames; empty if there are none
std::string missingFrames(const std::map<int, SequenceFrame>& frames, int count)
{
  std::vector<std::string> ranges;
  int next = 0;
  for (const auto& entry : frames)
  {
    if (entry.first > next)
    {
      ranges.push_back(range(next, entry.first - 1));
    }
    next = entry.first + 1;
  }
  if (next < count)
  {
    ranges.push_back(range(next, count - 1));
  }

  std::string text;
  for (std::size_t i = 0; i < std::min(ranges.size(), MostRangesListed); ++i)
  {
    text += (i ? ", " : "") + ranges[i];
  }
  return ranges.size() > MostRangesListed ? text + ", ..." : text;
}

}  // namespace

void SequenceFrameFields::read(long long line, std::string_view key, std::string_view value)
{
  const std::string_view rest = key.substr(FramePrefix.size());
  const std::size_t underscore = rest.find('_');
  const std::optional<long long> index = parseInteger(rest.substr(0, underscore));
  const bool isNamed = underscore != std::string_view::npos && underscore + 1 < rest.size();
  if (!isNamed || !index || *index < 0 || *index >= std::numeric_limits<int>::max())
  {
    throw FileError(
      path_, line, inQuotes(key) + " is not a frame's field; expected a name like 'Seq_Frame0000_StylusToTrackerTransform'");
  }

  const int frameIndex = static_cast<int>(*index);
  if (frames_.empty() || frameIndex > frames_.rbegin()->first)
  {
    lineOfLastFrame_ = line;
  }
  SequenceFrame& frame = frames_[frameIndex];
  const std::string_view name = rest.substr(underscore + 1);
  if (endsWith(name, StatusSuffix))
  {
    std::string& status = frame.transforms[std::string(withoutEnd(name, StatusSuffix.size()))].status;
    if (!status.empty())
    {
      throw FileError(path_, line, "the field " + inQuotes(key) + " is there twice");
    }
    status = value.empty() ? "(empty)" : std::string(value);
  }
  else if (endsWith(name, TransformSuffix))
  {
    readTransform(line, frame, name, value);
  }
  else
  {
    readOther(line, frame, name, value);
  }
}

void SequenceFrameFields::readTransform(long long line, SequenceFrame& frame, std::string_view name, std::string_view value) const
{
  SequenceTransform& transform = frame.transforms[std::string(withoutEnd(name, TransformSuffix.size()))];
  if (transform.matrix)
  {
    throw FileError(path_, line, "the transform " + inQuotes(name) + " is there twice in this frame");
  }
  const std::vector<std::string_view> words = splitWords(value);
  if (words.size() != 16)
  {
    throw FileError(path_, line, inQuotes(name) + " has " + std::to_string(words.size()) + " numbers; expected 16, row by row");
  }
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 16; ++i)
  {
    const std::optional<double> number = parseDouble(words[i]);
    if (!number)
    {
      throw FileError(path_, line, inQuotes(words[i]) + " in " + inQuotes(name) + " is not a number");
    }
    matrix(i / 4, i % 4) = *number;
  }
  transform.matrix = matrix;
}

void SequenceFrameFields::readOther(long long line, SequenceFrame& frame, std::string_view name, std::string_view value) const
{
  const auto refuseTwice = [&](bool isThere)
  {
    if (isThere)
    {
      throw FileError(path_, line, "the field " + inQuotes(name) + " is there twice in this frame");
    }
  };
  if (name == "Timestamp" || name == "UnfilteredTimestamp")
  {
    std::optional<double>& time = name == "Timestamp" ? frame.timestampSec : frame.unfilteredTimestampSec;
    refuseTwice(time.has_value());
    time = parseDouble(value);
    if (!time || !std::isfinite(*time))
    {
      throw FileError(path_, line, inQuotes(name) + " is " + inQuotes(value) + "; expected a number of seconds");
    }
  }
  else if (name == "FrameNumber")
  {
    refuseTwice(frame.frameNumber.has_value());
    frame.frameNumber = parseInteger(value);
    if (!frame.frameNumber)
    {
      throw FileError(path_, line, inQuotes(name) + " is " + inQuotes(value) + "; expected a whole number");
    }
  }
  else if (name == "ImageStatus")
  {
    refuseTwice(frame.isImageValid.has_value());
    frame.isImageValid = equalsIgnoreCase(value, "OK");
  }
  else
  {
    refuseTwice(!frame.fields.emplace(name, value).second);
  }
}

void SequenceFrameFields::finish(SequenceHeader& header)
{
  if (!frames_.empty() && frames_.rbegin()->first >= header.frameCount)
  {
    throw FileError(path_, lineOfLastFrame_,
      "a field of frame " + std::to_string(frames_.rbegin()->first) + ", but DimSize announces only " +
        std::to_string(header.frameCount) + " frames, numbered from 0");
  }
  const std::string missing = missingFrames(frames_, header.frameCount);
  if (!missing.empty())
  {
    header.warnings.push_back("nothing is said about frame " + missing + " (" +
      std::to_string(header.frameCount - static_cast<int>(frames_.size())) + " of " + std::to_string(header.frameCount) +
      "); they have no transforms");
  }

  std::set<std::string> names;
  for (const auto& entry : frames_)
  {
    for (const auto& transform : entry.second.transforms)
    {
      if (transform.second.matrix)
      {
        names.insert(transform.first);
      }
    }
  }
  header.transformNames.assign(names.begin(), names.end());
  header.frames = std::move(frames_);
}

}  // namespace handeye::io
