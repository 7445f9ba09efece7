// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Crc64.h"
#include "FixedText.h"
#include "OpenIGTLinkMessage.h"

#include <igtl_header.h>

#include <algorithm>
#include <cstring>

namespace handeye::devices
{

namespace
{

static_assert(sizeof(igtl_header) == HeaderBytes && IGTL_HEADER_SIZE == HeaderBytes);

bool isPrintable(const std::string& text)
{
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= 32 && c < 127; });
}

}  // namespace

std::optional<MessageHeader> parseHeader(const std::array<std::uint8_t, HeaderBytes>& bytes, std::string& problem)
{
  igtl_header raw;
  std::memcpy(&raw, bytes.data(), sizeof(raw));
  igtl_header_convert_byte_order(&raw);
  MessageHeader header;
  header.version = raw.version;
  header.type = fixedText(raw.name, sizeof(raw.name));
  header.device = fixedText(raw.device_name, sizeof(raw.device_name));
  if (raw.version < 1 || raw.version > 3 || header.type.empty() || !isPrintable(header.type))
  {
    problem = "what came is not OpenIGTLink (the header's version is " + std::to_string(raw.version) + ")";
    return std::nullopt;
  }
  const std::uint64_t timestamp = raw.timestamp;
  header.timeSec = double(timestamp >> 32) + double(timestamp & 0xFFFFFFFFU) / 4294967296.0;
  header.bodyBytes = raw.body_size;
  header.crc = raw.crc;
  return header;
}

std::string checkCrc(const MessageHeader& header, const std::uint8_t* body)
{
  return crc64Ecma(body, std::size_t(header.bodyBytes)) == header.crc
    ? ""
    : header.type + " '" + header.device + "' was damaged on its way: the checksum is wrong";
}

cv::Mat FramePool::take(int rows, int columns, int type)
{
  for (cv::Mat& frame : frames_)
  {
    if (frame.u != nullptr && __atomic_load_n(&frame.u->refcount, __ATOMIC_ACQUIRE) == 1 && frame.rows == rows &&
      frame.cols == columns && frame.type() == type)
    {
      return frame;
    }
  }
  constexpr std::size_t LargestPool = 64;
  cv::Mat frame(rows, columns, type);
  if (frames_.size() >= LargestPool || (!frames_.empty() && (frames_[0].rows != rows || frames_[0].cols != columns)))
  {
    frames_.clear();  // those in use live on with who uses them
  }
  frames_.push_back(frame);
  return frame;
}

}  // namespace handeye::devices
