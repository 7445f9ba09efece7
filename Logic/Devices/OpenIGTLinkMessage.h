// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "DeviceSample.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace handeye::devices
{

/// OpenIGTLink's messages (protocol 1 to 3) as bytes; the structures and byte orders are libopenigtlink's. What comes from a
/// network is
/// checked before it is looked at: every size and count against the bytes that are there, names that need not end in a zero, the
/// checksum, numbers that are not finite. Nothing here trusts the sender.
/// Reference: http://openigtlink.org/protocols/v3_header.html and the pages beside it.

constexpr std::size_t HeaderBytes = 58;

struct MessageHeader
{
  int version = 1;   ///< 1: protocols 1 and 2; 2: protocol 3, with metadata
  std::string type;  ///< "TRANSFORM", ...
  std::string device;
  double timeSec = 0;
  std::uint64_t bodyBytes = 0;
  std::uint64_t crc = 0;
};

/// @param problem receives a sentence where these are no header of OpenIGTLink
std::optional<MessageHeader> parseHeader(const std::array<std::uint8_t, HeaderBytes>& bytes, std::string& problem);

/// Where image memory comes from: a new one each time, or one that nobody uses any more.
class FramePool
{
public:
  /// Memory of this kind; kept, and handed out again once the caller's copies are gone.
  cv::Mat take(int rows, int columns, int type);

private:
  std::vector<cv::Mat> frames_;
};

struct ParsedMessage
{
  std::vector<DeviceSample> samples;  ///< TDATA and QTDATA hold several poses
  std::string problem;                ///< a sentence if the message was refused; there are no samples then
  bool isKnownType = true;
};

/// The content of a message: TRANSFORM, TDATA, QTDATA, POSITION, IMAGE, STATUS, STRING. Numbers go through float32, as the
/// protocol has
/// them. A pose that is not a rigid motion, or whose metadata say `TransformStatus` other than OK, is kept as not valid.
/// @param body header.bodyBytes bytes; changed (byte order)
[[nodiscard]] ParsedMessage parseBody(const MessageHeader& header, std::uint8_t* body, FramePool& pool);

/// What parseBody() wants to see of the checksum. @return a sentence if it is wrong, otherwise nothing
std::string checkCrc(const MessageHeader& header, const std::uint8_t* body);

using Bytes = std::vector<std::uint8_t>;
using Metadata = std::map<std::string, std::string>;

/// Messages to send. Header version 2 with metadata, which protocol 3 knows; version 1 without (metadata are then left out).
/// @throws std::invalid_argument for a device name longer than 20 bytes

Bytes packTransform(const std::string& device, double timeSec, const Eigen::Matrix4d& transform, const Metadata& metadata = {},
  int headerVersion = 2);

/// @param image CV_8U or CV_16U, 1, 3 or 4 channels, BGR; placed with unit spacing in LPS such that `imageToReference` (RAS) holds
Bytes packImage(const std::string& device, double timeSec, const cv::Mat& image,
  const Eigen::Matrix4d& imageToReference = Eigen::Matrix4d::Identity(), const Metadata& metadata = {}, int headerVersion = 2);

Bytes packString(const std::string& device, double timeSec, const std::string& text, int headerVersion = 2);
Bytes packStatus(const std::string& device, double timeSec, const DeviceStatus& status, int headerVersion = 2);

/// Several poses as one TDATA message. @param names at most 20 bytes each
Bytes packTrackingData(const std::string& device, double timeSec, const std::vector<std::string>& names,
  const std::vector<Eigen::Matrix4d>& transforms, int headerVersion = 2);

/// A message of any type: header, checksum and all. For what has no function above, and for tests.
Bytes packMessage(const std::string& type, const std::string& device, double timeSec, const Bytes& content,
  const Metadata& metadata = {}, int headerVersion = 2);

}  // namespace handeye::devices
