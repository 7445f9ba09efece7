// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SequenceMetafileWriter.h"

#include "FileError.h"
#include "NumberText.h"
#include "ScratchFile.h"

#include <opencv2/imgproc.hpp>

#include <zlib.h>

#include <array>
#include <cmath>
#include <new>
#include <optional>
#include <set>
#include <stdexcept>

namespace handeye::io
{

namespace
{

constexpr std::size_t OutputBytes = 1 << 18;

/// The fields that fileHeader() writes itself.
constexpr std::array<std::string_view, 18> OwnFields = { "ObjectType", "NDims", "AnatomicalOrientation", "BinaryData",
  "BinaryDataByteOrderMSB", "CenterOfRotation", "CompressedData", "CompressedDataSize", "DimSize", "Kinds",
  "ElementNumberOfChannels", "ElementSpacing", "ElementType", "Offset", "TransformMatrix", "UltrasoundImageOrientation",
  "UltrasoundImageType", "ElementDataFile" };

void checkField(const std::string& name, const std::string& value)
{
  if (name.empty() || name.find_first_of(" \t\r\n=") != std::string::npos || value.find_first_of("\r\n") != std::string::npos)
  {
    throw std::invalid_argument("sequence metafile: " + inQuotes(name) + " = " + inQuotes(value) + " cannot be a field");
  }
}

std::string frameIndex(int index)
{
  const std::string digits = std::to_string(index);
  return std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits;
}

std::string matrixText(const Eigen::Matrix4d& matrix)
{
  std::string text;
  for (int i = 0; i < 16; ++i)
  {
    text += (i ? " " : "") + formatDouble(matrix(i / 4, i % 4));
  }
  return text;
}

}  // namespace

/// The frames so far, as the file will have them: on the disk, so that memory does not grow with the recording.
struct SequenceMetafileWriter::Pixels
{
  Pixels(const std::filesystem::path& path, bool isCompressed)
    : fields(path)
    , scratch(path)
  {
    if (isCompressed && deflateInit(&stream.emplace(), Z_BEST_SPEED) != Z_OK)
    {
      stream.reset();
      throw std::bad_alloc();
    }
  }

  ~Pixels()
  {
    if (stream)
    {
      deflateEnd(&*stream);
    }
  }

  void put(const void* data, std::size_t count)
  {
    scratch.write(data, count);
    bytesWritten += count;
  }

  void write(const std::uint8_t* data, std::size_t count)
  {
    if (!stream)
    {
      put(data, count);
      return;
    }
    stream->next_in = const_cast<std::uint8_t*>(data);
    stream->avail_in = static_cast<uInt>(count);
    deflateAll(Z_NO_FLUSH);
  }

  void deflateAll(int flush)
  {
    std::vector<std::uint8_t> output(OutputBytes);
    do
    {
      stream->next_out = output.data();
      stream->avail_out = static_cast<uInt>(output.size());
      deflate(&*stream, flush);
      put(output.data(), output.size() - stream->avail_out);
    } while (stream->avail_out == 0);
  }

  /// Every row of an image in the file's order of colours.
  void writeImage(const cv::Mat& image)
  {
    cv::Mat ordered;  // not the caller's: cvtColor() would write into it
    if (image.channels() > 1)
    {
      cv::cvtColor(image, ordered, image.channels() == 3 ? cv::COLOR_BGR2RGB : cv::COLOR_BGRA2RGBA);
    }
    else
    {
      ordered = image;
    }
    for (int row = 0; row < ordered.rows; ++row)
    {
      write(ordered.ptr(row), ordered.cols * ordered.elemSize());
    }
  }

  void writeBlank() { writeImage(cv::Mat::zeros(size, type)); }

  ScratchFile fields;  ///< the header lines of the frames so far
  ScratchFile scratch;
  std::optional<z_stream> stream;
  std::uint64_t bytesWritten = 0;
  cv::Size size;         ///< of the first image; empty until there is one
  int type = 0;          ///< likewise
  int blanksBefore = 0;  ///< frames without image before the first image
};

SequenceMetafileWriter::SequenceMetafileWriter(const std::filesystem::path& path, const SequenceMetafileWriterOptions& options)
  : path_(path)
  , options_(options)
{
  for (const auto& [name, value] : options.fields)
  {
    setField(name, value);
  }
  AtomicFile probe(path);  // an unwritable place shows now and not after the recording
  pixels_ = std::make_unique<Pixels>(path, options_.compressed && !options_.transformsOnly);
}

SequenceMetafileWriter::~SequenceMetafileWriter() = default;

void SequenceMetafileWriter::setField(const std::string& name, const std::string& value)
{
  checkField(name, value);
  const bool isOwn = std::find(OwnFields.begin(), OwnFields.end(), name) != OwnFields.end();
  if (isOwn || name.compare(0, 9, "Seq_Frame") == 0)
  {
    throw std::invalid_argument("sequence metafile: the field " + inQuotes(name) + " is written by the writer itself");
  }
  options_.fields[name] = value;
}

void SequenceMetafileWriter::append(const SequenceFrame& frame, const cv::Mat& image)
{
  const bool isKnownType = image.depth() == CV_8U || image.depth() == CV_16U;
  const bool isFirstImage = pixels_->size.empty();
  if (isClosed_)
  {
    throw std::invalid_argument("sequence metafile: a frame was added after close()");
  }
  if (hasFailed_)
  {
    throw FileError(path_, "no more frames are taken after one that could not be written");
  }
  if (!image.empty() && options_.transformsOnly)
  {
    throw std::invalid_argument("sequence metafile: an image was given for a file with transforms only");
  }
  if (!image.empty() &&
    (!isKnownType || image.dims != 2 || (image.channels() != 1 && image.channels() != 3 && image.channels() != 4)))
  {
    throw std::invalid_argument("sequence metafile: an image of 8 or 16 bits with 1, 3 or 4 channels was expected");
  }
  if (!image.empty() && !isFirstImage && (image.size() != pixels_->size || image.type() != pixels_->type))
  {
    throw std::invalid_argument("sequence metafile: all images must have the size and type of the first one");
  }

  const auto sizeBefore = pixels_->size;
  const int typeBefore = pixels_->type, blanksBefore = pixels_->blanksBefore;
  try
  {
    write(frame, image);
  }
  catch (const FileError&)
  {
    hasFailed_ = true;
    pixels_->size = sizeBefore;
    pixels_->type = typeBefore;
    pixels_->blanksBefore = blanksBefore;
    throw;
  }
  ++frameCount_;
}

void SequenceMetafileWriter::write(const SequenceFrame& frame, const cv::Mat& image)
{
  const bool isFirstImage = pixels_->size.empty();
  appendHeader(frame, !image.empty());
  if (!image.empty() && isFirstImage)
  {
    pixels_->size = image.size();
    pixels_->type = image.type();
    for (; pixels_->blanksBefore > 0; --pixels_->blanksBefore)
    {
      pixels_->writeBlank();
    }
  }
  if (!image.empty())
  {
    pixels_->writeImage(image);
  }
  else if (isFirstImage)
  {
    ++pixels_->blanksBefore;
  }
  else
  {
    pixels_->writeBlank();
  }
  pixels_->scratch.mark();
  pixels_->fields.mark();
}

void SequenceMetafileWriter::appendHeader(const SequenceFrame& frame, bool hasImage)
{
  const std::string prefix = "Seq_Frame" + frameIndex(frameCount_) + "_";
  std::string lines;
  std::set<std::string> names;
  const auto add = [&](const std::string& name, const std::string& value)
  {
    checkField(name, value);
    if (!names.insert(name).second)
    {
      throw std::invalid_argument("sequence metafile: a frame has the field " + inQuotes(name) + " twice");
    }
    lines += prefix + name + " = " + value + "\n";
  };
  for (const auto& entry : frame.transforms)
  {
    const std::string name = withoutTransformSuffix(entry.first) + "Transform";
    if (entry.second.matrix)
    {
      add(name, matrixText(*entry.second.matrix));
    }
    add(name + "Status", entry.second.status.empty() ? "OK" : entry.second.status);
  }
  const auto addTime = [&](const std::string& name, const std::optional<double>& time)
  {
    if (time && !std::isfinite(*time))
    {
      throw std::invalid_argument("sequence metafile: the " + name + " of a frame is not finite");
    }
    if (time)
    {
      add(name, formatDouble(*time));
    }
  };
  addTime("Timestamp", frame.timestampSec);
  addTime("UnfilteredTimestamp", frame.unfilteredTimestampSec);
  if (frame.frameNumber)
  {
    add("FrameNumber", std::to_string(*frame.frameNumber));
  }
  for (const auto& entry : frame.fields)
  {
    add(entry.first, entry.second);
  }
  add("ImageStatus", hasImage && frame.isImageValid.value_or(true) ? "OK" : "INVALID");
  pixels_->fields.write(lines.data(), lines.size());
}

std::string SequenceMetafileWriter::fileHeader() const
{
  const bool hasImages = !pixels_->size.empty();
  const int channels = hasImages ? CV_MAT_CN(pixels_->type) : 1;
  const bool isWide = hasImages && CV_MAT_DEPTH(pixels_->type) == CV_16U;
  const std::string sides = std::to_string(pixels_->size.width) + " " + std::to_string(pixels_->size.height);
  std::string header = "ObjectType = Image\nNDims = 3\nAnatomicalOrientation = RAI\nBinaryData = True\n"
                       "BinaryDataByteOrderMSB = False\nCenterOfRotation = 0 0 0\n";
  header += pixels_->stream && hasImages
    ? "CompressedData = True\nCompressedDataSize = " + std::to_string(pixels_->bytesWritten) + "\n"
    : "CompressedData = False\n";
  header += "DimSize = " + sides + " " + std::to_string(frameCount_) + "\nKinds = domain domain list\n";
  header += "ElementNumberOfChannels = " + std::to_string(channels) + "\nElementSpacing = 1 1 1\n";
  header += std::string("ElementType = ") + (!hasImages ? "MET_OTHER" : isWide ? "MET_USHORT" : "MET_UCHAR") + "\n";
  header += "Offset = 0 0 0\nTransformMatrix = 1 0 0 0 1 0 0 0 1\n";
  header += std::string("UltrasoundImageOrientation = ") + (hasImages ? "MF" : "XX") + "\n";
  header += std::string("UltrasoundImageType = ") + (!hasImages ? "XX" : channels > 1 ? "RGB_COLOR" : "BRIGHTNESS") + "\n";
  for (const auto& entry : options_.fields)
  {
    header += entry.first + " = " + entry.second + "\n";
  }
  return header;
}

void SequenceMetafileWriter::close()
{
  if (isClosed_)
  {
    return;
  }
  isClosed_ = true;
  const bool hasImages = !pixels_->size.empty();
  if (pixels_->stream && hasImages)
  {
    if (hasFailed_)
    {
      throw FileError(path_, "a frame could not be written, and compressed pixels cannot be cut there");
    }
    pixels_->stream->avail_in = 0;
    pixels_->deflateAll(Z_FINISH);
    pixels_->scratch.mark();
  }
  AtomicFile file(path_);
  file.write(fileHeader());
  pixels_->fields.copyTo(file);
  file.write("ElementDataFile = LOCAL\n");
  if (hasImages)
  {
    pixels_->scratch.copyTo(file);
  }
  file.commit();
}

}  // namespace handeye::io
