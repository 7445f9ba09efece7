// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SequencePixels.h"

#include "FileError.h"
#include "TextFile.h"

#include <zlib.h>

#include <algorithm>
#include <cstdio>
#include <new>

namespace handeye::io
{

namespace
{

constexpr std::size_t InputBytes = 1 << 18;
constexpr std::uint64_t LargestPiece = 1 << 30;  ///< zlib counts in 32 bits

/// What both kinds need to know of the header.
class FileFrames : public SequencePixels
{
public:
  explicit FileFrames(const SequenceHeader& header)
    : path_(header.pixelPath)
    , file_(openForReading(header.pixelPath))
    , offset_(header.pixelOffset)
    , frameBytes_(header.frameBytes())
    , frameCount_(header.frameCount)
  {
  }

protected:
  void seek(std::uint64_t position)
  {
    if (fseeko(file_.get(), static_cast<off_t>(position), SEEK_SET) != 0)
    {
      throw FileError(path_, "cannot go to byte " + std::to_string(position));
    }
  }

  std::filesystem::path path_;
  FileHandle file_;
  std::uint64_t offset_;
  std::uint64_t frameBytes_;
  int frameCount_;
};

/// Pixels as they are.
class PlainPixels : public FileFrames
{
public:
  using FileFrames::FileFrames;

  void read(int frame, std::uint8_t* bytes) override
  {
    seek(offset_ + frameBytes_ * frame);
    if (std::fread(bytes, 1, frameBytes_, file_.get()) != frameBytes_)
    {
      throw FileError(path_, "the pixels of frame " + std::to_string(frame) + " are cut short");
    }
  }
};

/// One zlib stream over all frames: forward it goes on from where it is, backward it begins again.
class CompressedPixels : public FileFrames
{
public:
  explicit CompressedPixels(const SequenceHeader& header)
    : FileFrames(header)
    , compressedBytes_(header.pixelFileBytes)
    , input_(InputBytes)
  {
    if (inflateInit(&stream_) != Z_OK)
    {
      throw std::bad_alloc();
    }
    restart();
  }

  ~CompressedPixels() override { inflateEnd(&stream_); }

  void read(int frame, std::uint8_t* bytes) override
  {
    if (frame < nextFrame_)
    {
      restart();
    }
    const int wanted = frame;
    const int first = nextFrame_;
    nextFrame_ = frameCount_;  // so that a failure leads to a new start
    std::vector<std::uint8_t> skipped(first < wanted ? frameBytes_ : 0);
    for (int i = first; i < wanted; ++i)
    {
      inflateFrame(i, skipped.data());
    }
    inflateFrame(wanted, bytes);
    if (wanted + 1 == frameCount_)
    {
      checkEnd();
    }
    nextFrame_ = wanted + 1;
  }

private:
  void restart()
  {
    seek(offset_);
    inflateReset(&stream_);
    stream_.avail_in = 0;
    remainingBytes_ = compressedBytes_;
    nextFrame_ = 0;
    isAtEnd_ = false;
  }

  void inflateFrame(int frame, std::uint8_t* bytes)
  {
    std::uint64_t missing = frameBytes_;
    while (missing > 0)
    {
      const std::uint64_t piece = std::min(missing, LargestPiece);
      stream_.next_out = bytes + (frameBytes_ - missing);
      stream_.avail_out = static_cast<uInt>(piece);
      if (!inflateOnce(frame))
      {
        throw FileError(
          path_, "the compressed pixels end within frame " + std::to_string(frame) + " of " + std::to_string(frameCount_));
      }
      missing -= piece - stream_.avail_out;
    }
  }

  /// One call of inflate(), fed from the file. @return false where nothing more can come
  bool inflateOnce(int frame)
  {
    if (stream_.avail_in == 0)
    {
      const std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(input_.size(), remainingBytes_));
      stream_.next_in = input_.data();
      stream_.avail_in = static_cast<uInt>(std::fread(input_.data(), 1, count, file_.get()));
      remainingBytes_ -= stream_.avail_in;
    }
    if (isAtEnd_ || stream_.avail_in == 0)
    {
      return false;
    }
    const int code = inflate(&stream_, Z_NO_FLUSH);
    isAtEnd_ = code == Z_STREAM_END;
    if (code != Z_OK && code != Z_STREAM_END && code != Z_BUF_ERROR)
    {
      const std::string reason = stream_.msg ? stream_.msg : "zlib error " + std::to_string(code);
      throw FileError(path_, "the compressed pixels are damaged at frame " + std::to_string(frame) + " (" + reason + ")");
    }
    return true;
  }

  /// After the last frame comes the stream's end with its checksum, and nothing else.
  void checkEnd()
  {
    while (!isAtEnd_)
    {
      std::uint8_t surplus = 0;
      stream_.next_out = &surplus;
      stream_.avail_out = 1;
      const bool isMore = inflateOnce(frameCount_ - 1);
      if (stream_.avail_out == 0)
      {
        throw FileError(
          path_, "the compressed pixels go on after the " + std::to_string(frameCount_) + " frames that DimSize announces");
      }
      if (!isMore)
      {
        throw FileError(
          path_, "the compressed pixels end before their checksum; the file is cut short or CompressedDataSize too small");
      }
    }
  }

  std::uint64_t compressedBytes_;
  std::uint64_t remainingBytes_ = 0;
  std::vector<std::uint8_t> input_;
  z_stream stream_ = {};
  int nextFrame_ = 0;
  bool isAtEnd_ = false;
};

}  // namespace

std::unique_ptr<SequencePixels> SequencePixels::open(const SequenceHeader& header)
{
  if (header.isCompressed)
  {
    return std::make_unique<CompressedPixels>(header);
  }
  return std::make_unique<PlainPixels>(header);
}

}  // namespace handeye::io
