// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FixedText.h"
#include "OpenIGTLinkMessage.h"
#include "RigidTransform.h"

#include <igtl_image.h>
#include <igtl_position.h>
#include <igtl_qtdata.h>
#include <igtl_string.h>
#include <igtl_tdata.h>
#include <igtl_transform.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace handeye::devices
{

namespace
{

constexpr std::size_t ExtendedHeaderBytes = 12;

std::uint16_t read16(const std::uint8_t* bytes)
{
  return std::uint16_t((bytes[0] << 8) | bytes[1]);
}

std::uint32_t read32(const std::uint8_t* bytes)
{
  return (std::uint32_t(read16(bytes)) << 16) | read16(bytes + 2);
}

std::string sizeProblem(const MessageHeader& header, std::size_t found, const std::string& expected)
{
  return header.type + " '" + header.device + "' has a content of " + std::to_string(found) + " bytes; " + expected +
    " were expected";
}

/// The content of a message and its metadata, without the extended header of protocol 3.
struct Content
{
  std::uint8_t* bytes = nullptr;
  std::size_t count = 0;
  Metadata metadata;
};

/// @return a sentence if the parts do not fit into each other
std::string readMetadata(const std::uint8_t* bytes, std::size_t headerCount, std::size_t bodyCount, Metadata& metadata)
{
  const std::string damaged = "the metadata do not fit their own sizes";
  if (headerCount < 2 || 2 + std::size_t(read16(bytes)) * 8 > headerCount)
  {
    return headerCount == 0 && bodyCount == 0 ? "" : damaged;
  }
  const std::size_t entries = read16(bytes);
  std::size_t at = headerCount;
  for (std::size_t i = 0; i < entries; ++i)
  {
    const std::uint8_t* entry = bytes + 2 + 8 * i;
    const std::size_t keyBytes = read16(entry), valueBytes = read32(entry + 4);
    if (keyBytes > headerCount + bodyCount - at || valueBytes > headerCount + bodyCount - at - keyBytes)
    {
      return damaged;
    }
    const char* text = reinterpret_cast<const char*>(bytes + at);
    metadata[std::string(text, keyBytes)] = std::string(text + keyBytes, valueBytes);
    at += keyBytes + valueBytes;
  }
  return "";
}

std::string splitBody(const MessageHeader& header, std::uint8_t* body, Content& content)
{
  content = { body, std::size_t(header.bodyBytes), {} };
  if (header.version < 2)
  {
    return "";
  }
  const std::string damaged = header.type + " '" + header.device + "': the extended header does not fit the message";
  if (content.count < ExtendedHeaderBytes)
  {
    return damaged;
  }
  const std::size_t extended = read16(body), metaHeader = read16(body + 2), metaBody = read32(body + 4);
  if (extended < ExtendedHeaderBytes || extended > content.count || metaHeader > content.count - extended ||
    metaBody > content.count - extended - metaHeader)
  {
    return damaged;
  }
  content.bytes = body + extended;
  content.count -= extended + metaHeader + metaBody;
  const std::string problem = readMetadata(content.bytes + content.count, metaHeader, metaBody, content.metadata);
  return problem.empty() ? "" : header.type + " '" + header.device + "': " + problem;
}

/// Twelve numbers column by column: three axes and the translation.
TrackedPose poseFrom(const float* columns)
{
  TrackedPose pose;
  for (int i = 0; i < 12; ++i)
  {
    pose.received(i % 3, i / 3) = double(columns[i]);
  }
  const std::optional<Eigen::Isometry3d> rigid = toRigid(pose.received);
  pose.isValid = rigid.has_value();
  pose.transform = rigid.value_or(Eigen::Isometry3d::Identity());
  pose.reason = rigid           ? ""
    : pose.received.allFinite() ? "the matrix is not a rotation and a translation"
                                : "the matrix holds numbers that are not finite";
  return pose;
}

/// qx qy qz w.
TrackedPose poseFrom(const float* position, const float* quaternion)
{
  const Eigen::Vector4d xyzw = Eigen::Vector4f::Map(quaternion).cast<double>();
  const Eigen::Quaterniond q(xyzw);  // x y z w, as Eigen keeps them; not made a unit one: a wrong one is no rotation, and refused
  const Eigen::Matrix3d rotation = q.toRotationMatrix();
  float columns[12];
  for (int i = 0; i < 9; ++i)
  {
    columns[i] = float(rotation(i % 3, i / 3));
  }
  std::copy(position, position + 3, columns + 9);
  return poseFrom(columns);
}

/// What the sender says of the pose.
void applyStatus(const Metadata& metadata, TrackedPose& pose)
{
  const auto status = metadata.find("TransformStatus");
  if (pose.isValid && status != metadata.end() && status->second != "OK")
  {
    pose.isValid = false;
    pose.reason = "the tracker reports the status " + status->second.substr(0, 40);
  }
}

DeviceSample sampleOf(const MessageHeader& header, const Content& content, const std::string& name)
{
  DeviceSample sample;
  sample.name = name;
  sample.timeSec = header.timeSec;
  sample.metadata = content.metadata;
  return sample;
}

void addPose(const MessageHeader& header, const Content& content, const std::string& name, TrackedPose pose, ParsedMessage& message)
{
  applyStatus(content.metadata, pose);
  message.samples.push_back(sampleOf(header, content, name));
  message.samples.back().content = std::move(pose);
}

void parseTransform(const MessageHeader& header, const Content& content, ParsedMessage& message)
{
  if (content.count != IGTL_TRANSFORM_SIZE)
  {
    message.problem = sizeProblem(header, content.count, "48");
    return;
  }
  float numbers[12];
  std::memcpy(numbers, content.bytes, sizeof(numbers));
  igtl_transform_convert_byte_order(numbers);
  addPose(header, content, header.device, poseFrom(numbers), message);
}

/// Every element gets the metadata: without limits, one message of a hostile sender would take terabytes.
constexpr std::size_t MostElements = 1000, MostMetadataBytes = std::size_t(64) << 10;

template<typename Element, typename Convert, typename ToPose>
void parseElements(const MessageHeader& header, const Content& content, Convert convert, ToPose toPose, ParsedMessage& message)
{
  if (content.count % sizeof(Element) != 0)
  {
    message.problem = sizeProblem(header, content.count, "a multiple of " + std::to_string(sizeof(Element)));
    return;
  }
  std::size_t metadataBytes = 0;
  for (const auto& [key, value] : content.metadata)
  {
    metadataBytes += key.size() + value.size();
  }
  if (content.count / sizeof(Element) > MostElements || metadataBytes > MostMetadataBytes)
  {
    message.problem = header.type + " '" + header.device + "' has " + std::to_string(content.count / sizeof(Element)) +
      " tools and " + std::to_string(metadataBytes) + " bytes of metadata; at most " + std::to_string(MostElements) + " and " +
      std::to_string(MostMetadataBytes) + " are taken";
    return;
  }
  for (std::size_t at = 0; at < content.count; at += sizeof(Element))
  {
    Element element;
    std::memcpy(&element, content.bytes + at, sizeof(Element));
    convert(&element, 1);
    addPose(header, content, fixedText(element.name, sizeof(element.name)), toPose(element), message);
  }
}

void parseTrackingData(const MessageHeader& header, const Content& content, ParsedMessage& message)
{
  const auto toPose = [](const igtl_tdata_element& element)
  {
    float numbers[12];
    std::memcpy(numbers, element.transform, sizeof(numbers));
    return poseFrom(numbers);
  };
  parseElements<igtl_tdata_element>(header, content, igtl_tdata_convert_byte_order, toPose, message);
}

void parseQuaternionData(const MessageHeader& header, const Content& content, ParsedMessage& message)
{
  const auto toPose = [](const igtl_qtdata_element& element)
  {
    float position[3], quaternion[4];
    std::memcpy(position, element.position, sizeof(position));
    std::memcpy(quaternion, element.quaternion, sizeof(quaternion));
    return poseFrom(position, quaternion);
  };
  parseElements<igtl_qtdata_element>(header, content, igtl_qtdata_convert_byte_order, toPose, message);
}

/// With four, three (the fourth follows from unit length) or no numbers of a quaternion.
void parsePosition(const MessageHeader& header, const Content& content, ParsedMessage& message)
{
  igtl_position position = {};
  if (content.count != 28 && content.count != 24 && content.count != 12)
  {
    message.problem = sizeProblem(header, content.count, "28, 24 or 12");
    return;
  }
  std::memcpy(&position, content.bytes, content.count);
  igtl_position_convert_byte_order(&position);
  float place[3], quaternion[4];
  std::memcpy(place, position.position, sizeof(place));
  std::memcpy(quaternion, position.quaternion, sizeof(quaternion));
  const double rest =
    1 - double(quaternion[0]) * quaternion[0] - double(quaternion[1]) * quaternion[1] - double(quaternion[2]) * quaternion[2];
  quaternion[3] = content.count == 28 ? quaternion[3] : float(std::sqrt(std::max(0.0, rest)));
  addPose(header, content, header.device, poseFrom(place, quaternion), message);
}

/// OpenIGTLink places the picture's centre; the sample says where its first pixel is, in RAS.
Eigen::Matrix4d imagePlace(const igtl_image_header& image)
{
  Eigen::Matrix4d place = Eigen::Matrix4d::Identity();
  float numbers[12];
  std::memcpy(numbers, image.matrix, sizeof(numbers));
  for (int i = 0; i < 12; ++i)
  {
    place(i % 3, i / 3) = double(numbers[i]);
  }
  const Eigen::Vector3d middle((image.size[0] - 1) / 2.0, (image.size[1] - 1) / 2.0, (image.size[2] - 1) / 2.0);
  place.topRightCorner<3, 1>() -= place.topLeftCorner<3, 3>() * middle;
  if (image.coord == IGTL_IMAGE_COORD_LPS)
  {
    place.topRows<2>() *= -1;
  }
  return place;
}

/// @return a sentence if the header is not that of one whole picture
std::string checkImage(const igtl_image_header& image, std::size_t pixelBytes)
{
  const bool is8 = image.scalar_type == IGTL_IMAGE_STYPE_TYPE_UINT8, is16 = image.scalar_type == IGTL_IMAGE_STYPE_TYPE_UINT16;
  const int channels = image.num_components;
  if (!(is8 || is16) || (channels != 1 && channels != 3 && channels != 4))
  {
    return "has " + std::to_string(channels) + " components of the type " + std::to_string(image.scalar_type) +
      "; 1, 3 or 4 of uint8 (3) or uint16 (5) were expected";
  }
  if (image.size[0] == 0 || image.size[1] == 0 || image.size[2] != 1)
  {
    return "is of the size " + std::to_string(image.size[0]) + " x " + std::to_string(image.size[1]) + " x " +
      std::to_string(image.size[2]) + "; one picture was expected";
  }
  for (int i = 0; i < 3; ++i)
  {
    if (image.subvol_offset[i] != 0 || image.subvol_size[i] != image.size[i])
    {
      return "holds a part of a picture; a whole one was expected";
    }
  }
  const std::uint64_t expected = std::uint64_t(image.size[0]) * image.size[1] * std::uint64_t(channels) * (is8 ? 1 : 2);
  return expected == pixelBytes
    ? ""
    : "has " + std::to_string(pixelBytes) + " bytes of pixels; its size needs " + std::to_string(expected);
}

void parseImage(const MessageHeader& header, const Content& content, FramePool& pool, ParsedMessage& message)
{
  if (content.count < IGTL_IMAGE_HEADER_SIZE)
  {
    message.problem = sizeProblem(header, content.count, "at least 72");
    return;
  }
  igtl_image_header image;
  std::memcpy(&image, content.bytes, sizeof(image));
  igtl_image_convert_byte_order(&image);
  const std::string problem = checkImage(image, content.count - IGTL_IMAGE_HEADER_SIZE);
  if (!problem.empty())
  {
    message.problem = "IMAGE '" + header.device + "' " + problem;
    return;
  }
  const int depth = image.scalar_type == IGTL_IMAGE_STYPE_TYPE_UINT8 ? CV_8U : CV_16U;
  const int type = CV_MAKETYPE(depth, image.num_components);
  cv::Mat sent(image.size[1], image.size[0], type, content.bytes + IGTL_IMAGE_HEADER_SIZE);
  if (depth == CV_16U && image.endian == IGTL_IMAGE_ENDIAN_BIG)
  {
    for (std::size_t i = 0; i + 1 < content.count - IGTL_IMAGE_HEADER_SIZE; i += 2)
    {
      std::swap(sent.data[i], sent.data[i + 1]);
    }
  }
  VideoFrame frame;
  frame.imageToReference = imagePlace(image);
  frame.image = pool.take(sent.rows, sent.cols, type);
  if (image.num_components == 1)
  {
    sent.copyTo(frame.image);
  }
  else
  {
    cv::cvtColor(sent, frame.image, image.num_components == 3 ? cv::COLOR_RGB2BGR : cv::COLOR_RGBA2BGRA);
  }
  message.samples.push_back(sampleOf(header, content, header.device));
  message.samples.back().content = std::move(frame);
}

void parseString(const MessageHeader& header, const Content& content, ParsedMessage& message)
{
  if (content.count < IGTL_STRING_HEADER_SIZE || content.count - IGTL_STRING_HEADER_SIZE < read16(content.bytes + 2))
  {
    message.problem = sizeProblem(header, content.count, "4 and the length of the text");
    return;
  }
  message.samples.push_back(sampleOf(header, content, header.device));
  message.samples.back().content =
    DeviceText{ std::string(reinterpret_cast<const char*>(content.bytes) + IGTL_STRING_HEADER_SIZE, read16(content.bytes + 2)) };
}

void parseStatus(const MessageHeader& header, const Content& content, ParsedMessage& message)
{
  constexpr std::size_t FixedBytes = 30;  // code 2, subcode 8, error's name 20
  if (content.count < FixedBytes)
  {
    message.problem = sizeProblem(header, content.count, "at least 30");
    return;
  }
  DeviceStatus status;
  status.code = read16(content.bytes);
  status.subcode = std::int64_t((std::uint64_t(read32(content.bytes + 2)) << 32) | read32(content.bytes + 6));
  const char* text = reinterpret_cast<const char*>(content.bytes);
  status.error = fixedText(text + 10, 20);
  status.message = std::string(text + FixedBytes, strnlen(text + FixedBytes, content.count - FixedBytes));
  message.samples.push_back(sampleOf(header, content, header.device));
  message.samples.back().content = std::move(status);
}

}  // namespace

ParsedMessage parseBody(const MessageHeader& header, std::uint8_t* body, FramePool& pool)
{
  ParsedMessage message;
  Content content;
  message.problem = splitBody(header, body, content);
  if (!message.problem.empty())
  {
    return message;
  }
  using Parse = void (*)(const MessageHeader&, const Content&, ParsedMessage&);
  static const std::map<std::string, Parse> parsers = { { "TRANSFORM", parseTransform }, { "TDATA", parseTrackingData },
    { "QTDATA", parseQuaternionData }, { "POSITION", parsePosition }, { "QTRANS", parsePosition }, { "STRING", parseString },
    { "STATUS", parseStatus } };
  const auto parser = parsers.find(header.type);
  if (parser != parsers.end())
  {
    parser->second(header, content, message);
  }
  else if (header.type == "IMAGE")
  {
    parseImage(header, content, pool, message);
  }
  else
  {
    message.isKnownType = false;
  }
  return message;
}

}  // namespace handeye::devices
