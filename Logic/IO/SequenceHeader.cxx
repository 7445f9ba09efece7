// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SequenceHeader.h"

#include "FileError.h"
#include "NumberText.h"
#include "TextFile.h"

#include <limits>
#include <optional>

namespace handeye::io
{

namespace
{

constexpr long long MostFrames = 10'000'000;  ///< two days at 60 Hz
constexpr long long LargestSide = 1 << 16;
constexpr std::uint64_t LargestFrameBytes = std::uint64_t(1) << 28;
constexpr std::uint64_t BestDeflateRatio = 1032;  ///< zlib's own figure; a stream cannot hold more than this times its size

/// Reads the lines and makes sense of them.
class HeaderReader
{
public:
  explicit HeaderReader(const std::filesystem::path& path)
    : lines_(path)
    , frames_(path)
  {
    header_.path = path;
  }

  SequenceHeader read();

private:
  void readLines();
  void readLine(const std::string& line, bool isFirst);
  void interpretDimensions();
  void checkKinds(std::size_t dimensionCount);
  void interpretPixelFormat();
  void interpretDataFile();
  void checkPixelBytes();
  bool flag(const std::string& key, bool valueIfMissing) const;
  std::string field(const std::string& key) const;
  [[noreturn]] void fail(const std::string& key, const std::string& expected) const;

  SequenceHeader header_;
  LineReader lines_;
  SequenceFrameFields frames_;
  std::map<std::string, long long> lineOfField_;
};

SequenceHeader HeaderReader::read()
{
  readLines();
  interpretDimensions();
  frames_.finish(header_);
  if (header_.hasImages())
  {
    interpretPixelFormat();
    interpretDataFile();
    checkPixelBytes();
  }
  if (header_.frameCount == 0)
  {
    header_.warnings.push_back("the file has no frames");
  }
  return std::move(header_);
}

void HeaderReader::readLines()
{
  std::string line;
  bool isFirst = true;
  while (lines_.readLine(line))
  {
    const bool isBlank = trimmed(line).empty();
    if (!isBlank)
    {
      readLine(line, isFirst);
      isFirst = false;
    }
    if (header_.fields.count("ElementDataFile"))
    {
      header_.pixelOffset = static_cast<std::uint64_t>(lines_.offset());
      return;
    }
  }
  if (isFirst)
  {
    throw FileError(header_.path, "the file is empty; a sequence metafile begins with 'ObjectType = Image'");
  }
  throw FileError(header_.path,
    "the header ends after line " + std::to_string(lines_.lineNumber()) +
      " without 'ElementDataFile = LOCAL'; the file is cut short or not a sequence metafile");
}

void HeaderReader::readLine(const std::string& line, bool isFirst)
{
  constexpr std::string_view byteOrderMark = "\xEF\xBB\xBF";
  std::string_view text = line;
  if (isFirst && text.substr(0, byteOrderMark.size()) == byteOrderMark)
  {
    text.remove_prefix(byteOrderMark.size());
  }
  const std::size_t equals = text.find('=');
  const std::string_view key = trimmed(text.substr(0, equals));
  if (isFirst && (equals == std::string_view::npos || (key != "ObjectType" && key != "NDims")))
  {
    throw FileError(header_.path, lines_.lineNumber(),
      "begins with " + inQuotes(text) + "; a sequence metafile begins with 'ObjectType = Image'");
  }
  if (equals == std::string_view::npos || key.empty())
  {
    throw FileError(header_.path, lines_.lineNumber(), "found " + inQuotes(text) + "; expected 'Key = Value'");
  }
  const std::string_view value = trimmed(text.substr(equals + 1));
  if (key.substr(0, 9) == "Seq_Frame")
  {
    frames_.read(lines_.lineNumber(), key, value);
    return;
  }
  if (!header_.fields.emplace(key, value).second)
  {
    throw FileError(header_.path, lines_.lineNumber(), "the field " + inQuotes(key) + " is there twice");
  }
  lineOfField_[std::string(key)] = lines_.lineNumber();
}

std::string HeaderReader::field(const std::string& key) const
{
  const auto found = header_.fields.find(key);
  return found == header_.fields.end() ? std::string() : found->second;
}

void HeaderReader::fail(const std::string& key, const std::string& expected) const
{
  const auto line = lineOfField_.find(key);
  if (line == lineOfField_.end())
  {
    throw FileError(header_.path, "the header has no '" + key + "'; expected " + expected);
  }
  throw FileError(header_.path, line->second, "'" + key + "' is " + inQuotes(field(key)) + "; expected " + expected);
}

bool HeaderReader::flag(const std::string& key, bool valueIfMissing) const
{
  const std::string value = field(key);
  if (value.empty())
  {
    return valueIfMissing;
  }
  const bool isTrue = equalsIgnoreCase(value, "True") || value == "1";
  if (!isTrue && !equalsIgnoreCase(value, "False") && value != "0")
  {
    fail(key, "True or False");
  }
  return isTrue;
}

void HeaderReader::interpretDimensions()
{
  const std::string dimensions = field("DimSize");
  const std::vector<std::string_view> words = splitWords(dimensions);
  const std::string expected = "three numbers 'width height frames' or four 'width height 1 frames'";
  if (words.size() != 3 && words.size() != 4)
  {
    fail("DimSize", expected);
  }
  const std::string dimensionCount = field("NDims");
  if (!dimensionCount.empty() && parseInteger(dimensionCount) != static_cast<long long>(words.size()))
  {
    fail("NDims", "the number of entries of DimSize, " + std::to_string(words.size()));
  }
  std::vector<long long> sizes;
  for (std::string_view word : words)
  {
    sizes.push_back(parseInteger(word).value_or(-1));
    if (sizes.back() < 0)
    {
      fail("DimSize", expected + ", none of them negative or larger than the machine can count");
    }
  }
  checkKinds(words.size());

  if ((sizes[0] == 0) != (sizes[1] == 0) || sizes[0] > LargestSide || sizes[1] > LargestSide)
  {
    fail("DimSize", "an image of up to " + std::to_string(LargestSide) + " pixels a side, or '0 0 frames' for transforms only");
  }
  if (words.size() == 4 && sizes[2] > 1)
  {
    fail("DimSize", "flat images; these are volumes with " + std::to_string(sizes[2]) + " slices a frame");
  }
  if (sizes.back() > MostFrames)
  {
    fail("DimSize", "at most " + std::to_string(MostFrames) + " frames");
  }
  header_.width = static_cast<int>(sizes[0]);
  header_.height = static_cast<int>(sizes[1]);
  header_.frameCount = static_cast<int>(sizes.back());
}

/// The last dimension counts the frames; a volume without frames must not be taken for a sequence.
void HeaderReader::checkKinds(std::size_t dimensionCount)
{
  const std::string value = field("Kinds");
  const std::vector<std::string_view> kinds = splitWords(value);
  if (kinds.empty())
  {
    return;
  }
  if (kinds.size() != dimensionCount || (kinds.back() != "list" && kinds.back() != "time"))
  {
    fail("Kinds", "'domain' for each side of the image and 'list' at the end, one for each entry of DimSize");
  }
}

void HeaderReader::interpretPixelFormat()
{
  const std::string type = field("ElementType");
  if (type != "MET_UCHAR" && type != "MET_USHORT")
  {
    fail("ElementType", "MET_UCHAR or MET_USHORT");
  }
  header_.bytesPerSample = type == "MET_USHORT" ? 2 : 1;

  const long long channels =
    field("ElementNumberOfChannels").empty() ? 1 : parseInteger(field("ElementNumberOfChannels")).value_or(0);
  if (channels != 1 && channels != 3 && channels != 4)
  {
    fail("ElementNumberOfChannels", "1 (grey), 3 (RGB) or 4 (RGBA)");
  }
  header_.channels = static_cast<int>(channels);
  if (header_.frameBytes() > LargestFrameBytes)
  {
    fail("DimSize", "images of at most 256 MB each");
  }
  if (!flag("BinaryData", true))
  {
    fail("BinaryData", "True: pixels written as text cannot be read");
  }
  header_.isBigEndian = flag("BinaryDataByteOrderMSB", flag("ElementByteOrderMSB", false));
  header_.isCompressed = flag("CompressedData", false);
  header_.orientation = field("UltrasoundImageOrientation").empty() ? "XX" : field("UltrasoundImageOrientation");
  const std::string headerSize = field("HeaderSize");
  if (!headerSize.empty() && headerSize != "0")
  {
    fail("HeaderSize", "no such field: the pixels follow the header at once");
  }
}

void HeaderReader::interpretDataFile()
{
  const std::string name = field("ElementDataFile");
  if (name == "LOCAL")
  {
    header_.pixelPath = header_.path;
  }
  else
  {
    const bool isPlainName =
      !name.empty() && name != "." && name != ".." && name.find_first_of("/\\%\0", 0, 4) == std::string::npos;
    if (!isPlainName || splitWords(name).size() != 1 || name == "LIST")
    {
      fail("ElementDataFile", "LOCAL, or the name of one file in the same folder");
    }
    header_.pixelPath = header_.path.parent_path() / name;
    header_.pixelOffset = 0;
  }
  std::error_code error;
  if (!std::filesystem::is_regular_file(header_.pixelPath, error))
  {
    throw FileError(
      header_.path, "the pixels should be in '" + header_.pixelPath.string() + "', which is not there or not a plain file");
  }
  const std::uint64_t size = std::filesystem::file_size(header_.pixelPath, error);
  header_.pixelFileBytes = error || size < header_.pixelOffset ? 0 : size - header_.pixelOffset;
}

void HeaderReader::checkPixelBytes()
{
  const std::uint64_t frameBytes = header_.frameBytes();
  const std::uint64_t expected = frameBytes * header_.frameCount;  // below 2^28 * 10^7: it fits
  const std::string announced = std::to_string(header_.frameCount) + " frames of " + std::to_string(header_.width) + "x" +
    std::to_string(header_.height) + "x" + std::to_string(header_.channels);
  if (!header_.isCompressed)
  {
    if (header_.pixelFileBytes < expected)
    {
      throw FileError(header_.pixelPath,
        "cut short: the header announces " + announced + " (" + std::to_string(expected) + " bytes), but only " +
          std::to_string(header_.pixelFileBytes) + " bytes of pixels follow, " +
          std::to_string(header_.pixelFileBytes / frameBytes) + " whole frames");
    }
    return;
  }

  const std::string sizeField = field("CompressedDataSize");
  if (!sizeField.empty())
  {
    const std::optional<long long> size = parseInteger(sizeField);
    if (!size || *size < 0)
    {
      fail("CompressedDataSize", "the number of bytes of the compressed pixels");
    }
    if (static_cast<std::uint64_t>(*size) > header_.pixelFileBytes)
    {
      fail("CompressedDataSize",
        "at most the " + std::to_string(header_.pixelFileBytes) + " bytes that follow; the file is cut short");
    }
    header_.pixelFileBytes = static_cast<std::uint64_t>(*size);
  }
  if (expected / BestDeflateRatio > header_.pixelFileBytes)
  {
    throw FileError(header_.pixelPath,
      "the header announces " + announced + " (" + std::to_string(expected) + " bytes), more than " +
        std::to_string(header_.pixelFileBytes) + " bytes can hold compressed");
  }
}

}  // namespace

SequenceHeader readSequenceHeader(const std::filesystem::path& path)
{
  return HeaderReader(path).read();
}

}  // namespace handeye::io
