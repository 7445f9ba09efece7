// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Crc64.h"
#include "OpenIGTLinkMessage.h"

#include <igtl_header.h>
#include <igtl_image.h>
#include <igtl_tdata.h>
#include <igtl_transform.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace handeye::devices
{

namespace
{

constexpr int Ascii = 3;  // IANA's number of the character set

void append16(Bytes& bytes, std::uint32_t value)
{
  bytes.push_back(std::uint8_t(value >> 8));
  bytes.push_back(std::uint8_t(value));
}

void append32(Bytes& bytes, std::uint32_t value)
{
  append16(bytes, value >> 16);
  append16(bytes, value & 0xFFFF);
}

void appendRaw(Bytes& bytes, const void* data, std::size_t count)
{
  const auto* first = static_cast<const std::uint8_t*>(data);
  bytes.insert(bytes.end(), first, first + count);
}

/// A name into a field of fixed size; one of just that size has no zero behind it.
template<std::size_t Size> void copyName(const std::string& name, char (&field)[Size])
{
  if (name.size() > Size)
  {
    throw std::invalid_argument(
      "'" + name + "' is too long for OpenIGTLink: names have at most " + std::to_string(Size) + " bytes");
  }
  std::memset(field, 0, Size);
  std::memcpy(field, name.data(), name.size());
}

std::uint64_t toTimestamp(double timeSec)
{
  const double whole = std::floor(timeSec);
  const double fraction = std::floor((timeSec - whole) * 4294967296.0);  // of 1/2^32 s, exactly
  return (std::uint64_t(whole) << 32) | std::uint64_t(fraction);
}

void toColumns(const Eigen::Matrix4d& matrix, float* columns)
{
  for (int i = 0; i < 12; ++i)
  {
    columns[i] = float(matrix(i % 3, i / 3));
  }
}

struct Layout
{
  std::size_t extended = 0, metaHeader = 0, metaBody = 0;
};

Layout layoutOf(const Metadata& metadata, int headerVersion)
{
  Layout layout;
  if (headerVersion >= 2)
  {
    layout.extended = 12;
    layout.metaHeader = 2 + 8 * metadata.size();
    for (const auto& [key, value] : metadata)
    {
      layout.metaBody += key.size() + value.size();
    }
  }
  return layout;
}

/// Header, extended header; the content follows.
Bytes beginMessage(std::size_t contentBytes, const Metadata& metadata, int headerVersion)
{
  const Layout layout = layoutOf(metadata, headerVersion);
  Bytes bytes;
  bytes.reserve(HeaderBytes + layout.extended + contentBytes + layout.metaHeader + layout.metaBody);
  bytes.resize(HeaderBytes);
  if (headerVersion >= 2)
  {
    append16(bytes, std::uint32_t(layout.extended));
    append16(bytes, std::uint32_t(layout.metaHeader));
    append32(bytes, std::uint32_t(layout.metaBody));
    append32(bytes, 0);  // message id
  }
  return bytes;
}

void finishMessage(
  Bytes& bytes, const std::string& type, const std::string& device, double timeSec, const Metadata& metadata, int headerVersion)
{
  if (headerVersion >= 2)
  {
    append16(bytes, std::uint32_t(metadata.size()));
    for (const auto& [key, value] : metadata)
    {
      append16(bytes, std::uint32_t(key.size()));
      append16(bytes, Ascii);
      append32(bytes, std::uint32_t(value.size()));
    }
    for (const auto& [key, value] : metadata)
    {
      appendRaw(bytes, key.data(), key.size());
      appendRaw(bytes, value.data(), value.size());
    }
  }
  igtl_header header = {};
  header.version = igtl_uint16(headerVersion);
  copyName(type, header.name);
  copyName(device, header.device_name);
  header.timestamp = toTimestamp(timeSec);
  header.body_size = bytes.size() - HeaderBytes;
  header.crc = crc64Ecma(bytes.data() + HeaderBytes, bytes.size() - HeaderBytes);
  igtl_header_convert_byte_order(&header);
  std::memcpy(bytes.data(), &header, sizeof(header));
}

igtl_image_header imageHeader(const cv::Mat& image, const Eigen::Matrix4d& imageToReference)
{
  igtl_image_header header = {};
  header.version = IGTL_IMAGE_HEADER_VERSION;
  header.num_components = igtl_uint8(image.channels());
  header.scalar_type = image.depth() == CV_8U ? IGTL_IMAGE_STYPE_TYPE_UINT8 : IGTL_IMAGE_STYPE_TYPE_UINT16;
  header.endian = IGTL_IMAGE_ENDIAN_LITTLE;
  header.coord = IGTL_IMAGE_COORD_LPS;
  header.size[0] = header.subvol_size[0] = igtl_uint16(image.cols);
  header.size[1] = header.subvol_size[1] = igtl_uint16(image.rows);
  header.size[2] = header.subvol_size[2] = 1;
  Eigen::Matrix4d place = imageToReference;
  place.topRows<2>() *= -1;
  const Eigen::Vector4d middle((image.cols - 1) / 2.0, (image.rows - 1) / 2.0, 0, 1);
  const Eigen::Vector4d center = place * middle;
  place.col(3) = center;
  float columns[12];
  toColumns(place, columns);
  std::memcpy(header.matrix, columns, sizeof(columns));
  return header;
}

}  // namespace

double systemTimeSec()
{
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::size_t DeviceSample::bytes() const
{
  std::size_t count = sizeof(DeviceSample) + name.size();
  for (const auto& [key, value] : metadata)
  {
    count += key.size() + value.size() + 64;
  }
  if (const VideoFrame* video = frame())
  {
    count += video->image.total() * video->image.elemSize();
  }
  if (const DeviceText* words = text())
  {
    count += words->text.size();
  }
  return count;
}

Bytes packMessage(const std::string& type, const std::string& device, double timeSec, const Bytes& content,
  const Metadata& metadata, int headerVersion)
{
  Bytes bytes = beginMessage(content.size(), metadata, headerVersion);
  appendRaw(bytes, content.data(), content.size());
  finishMessage(bytes, type, device, timeSec, metadata, headerVersion);
  return bytes;
}

Bytes packTransform(
  const std::string& device, double timeSec, const Eigen::Matrix4d& transform, const Metadata& metadata, int headerVersion)
{
  float columns[12];
  toColumns(transform, columns);
  igtl_transform_convert_byte_order(columns);
  const auto* first = reinterpret_cast<const std::uint8_t*>(columns);
  return packMessage("TRANSFORM", device, timeSec, Bytes(first, first + sizeof(columns)), metadata, headerVersion);
}

Bytes packImage(const std::string& device, double timeSec, const cv::Mat& image, const Eigen::Matrix4d& imageToReference,
  const Metadata& metadata, int headerVersion)
{
  const bool isGood = !image.empty() && (image.depth() == CV_8U || image.depth() == CV_16U) && image.cols < 65536 &&
    image.rows < 65536 && (image.channels() == 1 || image.channels() == 3 || image.channels() == 4);
  if (!isGood)
  {
    throw std::invalid_argument("an image of 8 or 16 bits with 1, 3 or 4 channels is expected");
  }
  igtl_image_header header = imageHeader(image, imageToReference);
  igtl_image_convert_byte_order(&header);
  const std::size_t pixelBytes = image.total() * image.elemSize();
  Bytes bytes = beginMessage(sizeof(header) + pixelBytes, metadata, headerVersion);
  appendRaw(bytes, &header, sizeof(header));
  bytes.resize(bytes.size() + pixelBytes);
  cv::Mat sent(image.rows, image.cols, image.type(), bytes.data() + bytes.size() - pixelBytes);
  if (image.channels() == 1)
  {
    image.copyTo(sent);
  }
  else
  {
    cv::cvtColor(image, sent, image.channels() == 3 ? cv::COLOR_BGR2RGB : cv::COLOR_BGRA2RGBA);
  }
  finishMessage(bytes, "IMAGE", device, timeSec, metadata, headerVersion);
  return bytes;
}

Bytes packString(const std::string& device, double timeSec, const std::string& text, int headerVersion)
{
  if (text.size() > 65535)
  {
    throw std::invalid_argument("a STRING message holds at most 65535 bytes");
  }
  Bytes content;
  append16(content, Ascii);
  append16(content, std::uint32_t(text.size()));
  appendRaw(content, text.data(), text.size());
  return packMessage("STRING", device, timeSec, content, {}, headerVersion);
}

Bytes packStatus(const std::string& device, double timeSec, const DeviceStatus& status, int headerVersion)
{
  Bytes content;
  append16(content, std::uint32_t(status.code));
  append32(content, std::uint32_t(std::uint64_t(status.subcode) >> 32));
  append32(content, std::uint32_t(std::uint64_t(status.subcode)));
  char error[20];
  copyName(status.error, error);
  appendRaw(content, error, sizeof(error));
  appendRaw(content, status.message.c_str(), status.message.size() + 1);
  return packMessage("STATUS", device, timeSec, content, {}, headerVersion);
}

Bytes packTrackingData(const std::string& device, double timeSec, const std::vector<std::string>& names,
  const std::vector<Eigen::Matrix4d>& transforms, int headerVersion)
{
  if (names.size() != transforms.size())
  {
    throw std::invalid_argument("as many names as transforms are expected");
  }
  Bytes content;
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    igtl_tdata_element element = {};
    copyName(names[i], element.name);
    element.type = IGTL_TDATA_TYPE_6D;
    float columns[12];
    toColumns(transforms[i], columns);
    std::memcpy(element.transform, columns, sizeof(columns));
    igtl_tdata_convert_byte_order(&element, 1);
    appendRaw(content, &element, sizeof(element));
  }
  return packMessage("TDATA", device, timeSec, content, {}, headerVersion);
}

}  // namespace handeye::devices
