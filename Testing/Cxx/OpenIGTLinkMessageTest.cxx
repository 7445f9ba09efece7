// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Our messages against libopenigtlink's own classes, both ways; and messages that want to do harm.
#include "OpenIGTLinkMessage.h"
#include "Crc64.h"
#include "Simulation.h"

#include <gtest/gtest.h>
#include <igtlImageMessage.h>
#include <igtlPositionMessage.h>
#include <igtlQuaternionTrackingDataMessage.h>
#include <igtlStatusMessage.h>
#include <igtlStringMessage.h>
#include <igtlTrackingDataMessage.h>
#include <igtlTransformMessage.h>
#include <igtl_util.h>

#include <cstring>
#include <limits>

namespace
{

using namespace handeye::devices;
using handeye::test::Random;
using handeye::test::typicalMarkerToCamera;

struct Received
{
  std::optional<MessageHeader> header;
  ParsedMessage message;
  std::string problem;
};

Received receive(Bytes bytes)
{
  Received received;
  std::array<std::uint8_t, HeaderBytes> head;
  std::copy_n(bytes.begin(), HeaderBytes, head.begin());
  received.header = parseHeader(head, received.problem);
  if (!received.header || received.header->bodyBytes != bytes.size() - HeaderBytes)
  {
    received.problem = received.header ? "sizes differ" : received.problem;
    return received;
  }
  received.problem = checkCrc(*received.header, bytes.data() + HeaderBytes);
  FramePool pool;
  received.message = parseBody(*received.header, bytes.data() + HeaderBytes, pool);
  received.problem += received.message.problem;
  return received;
}

/// What the library sends: headers of version 1. Those of version 2 (protocol 3) Debian's library does not have; pyigtl does, see
/// Testing/Interop.
template<typename Pointer> Bytes packed(Pointer& message)
{
  message->SetDeviceName("StylusToTracker");
  igtl::TimeStamp::Pointer time = igtl::TimeStamp::New();
  time->SetTime(1234.25);
  message->SetTimeStamp(time);
  message->Pack();
  const auto* first = static_cast<const std::uint8_t*>(message->GetPackPointer());
  return Bytes(first, first + message->GetPackSize());
}

void toLibrary(const Eigen::Matrix4d& matrix, igtl::Matrix4x4& out)
{
  for (int i = 0; i < 16; ++i)
  {
    out[i / 4][i % 4] = float(matrix(i / 4, i % 4));
  }
}

TEST(Crc64, IsThatOfTheLibrary_ForEveryLength)
{
  Random random(1);
  Bytes bytes(1500);
  for (std::uint8_t& byte : bytes)
  {
    byte = std::uint8_t(random.integer(0, 255));
  }
  for (std::size_t count = 0; count < 700; ++count)
  {
    const std::uint64_t expected = crc64(bytes.data() + count, count, 12345 * count);
    ASSERT_EQ(crc64Ecma(bytes.data() + count, count, 12345 * count), expected) << count;
    ASSERT_EQ(crc64EcmaByTables(bytes.data() + count, count, 12345 * count), expected) << count;
  }
  EXPECT_EQ(crc64Ecma("123456789", 9), 0x6c40df5f0b497347ULL);
}

TEST(OpenIGTLinkMessage, LibrarysTransform_IsRead)
{
  igtl::TransformMessage::Pointer sent = igtl::TransformMessage::New();
  igtl::Matrix4x4 matrix;
  toLibrary(typicalMarkerToCamera().matrix(), matrix);
  sent->SetMatrix(matrix);
  const Received received = receive(packed(sent));
  ASSERT_EQ(received.problem, "");
  ASSERT_EQ(received.message.samples.size(), 1U);
  const DeviceSample& sample = received.message.samples[0];
  EXPECT_EQ(sample.name, "StylusToTracker");
  EXPECT_NEAR(sample.timeSec, 1234.25, 1e-7);  // the library keeps its fractions to some nanoseconds
  ASSERT_TRUE(sample.pose()->isValid);
  EXPECT_EQ(sample.pose()->received, typicalMarkerToCamera().matrix().cast<float>().cast<double>());
}

TEST(OpenIGTLinkMessage, OurTransform_IsReadByTheLibrary)
{
  const Bytes bytes = packTransform("MarkerToTracker", 99.5, typicalMarkerToCamera().matrix(), {}, 1);
  igtl::MessageHeader::Pointer header = igtl::MessageHeader::New();
  header->InitPack();
  std::memcpy(header->GetPackPointer(), bytes.data(), HeaderBytes);
  ASSERT_TRUE((header->Unpack() & igtl::MessageHeader::UNPACK_HEADER) != 0);
  igtl::TransformMessage::Pointer read = igtl::TransformMessage::New();
  read->SetMessageHeader(header);
  read->AllocatePack();
  ASSERT_EQ(std::size_t(read->GetPackBodySize()), bytes.size() - HeaderBytes);
  std::memcpy(read->GetPackBodyPointer(), bytes.data() + HeaderBytes, bytes.size() - HeaderBytes);
  ASSERT_TRUE((read->Unpack(1) & igtl::MessageHeader::UNPACK_BODY) != 0) << "the library's checksum";
  igtl::Matrix4x4 matrix;
  read->GetMatrix(matrix);
  for (int i = 0; i < 16; ++i)
  {
    EXPECT_EQ(matrix[i / 4][i % 4], float(typicalMarkerToCamera().matrix()(i / 4, i % 4)));
  }
}

TEST(OpenIGTLinkMessage, LibrarysImage_IsReadWithItsPlace)
{
  igtl::ImageMessage::Pointer sent = igtl::ImageMessage::New();
  sent->SetDimensions(5, 3, 1);
  sent->SetSpacing(0.5F, 0.25F, 1);
  sent->SetScalarType(igtl::ImageMessage::TYPE_UINT8);
  sent->SetNumComponents(3);
  sent->SetCoordinateSystem(igtl::ImageMessage::COORDINATE_LPS);
  sent->SetOrigin(10, 20, 30);
  sent->AllocateScalars();
  auto* pixels = static_cast<std::uint8_t*>(sent->GetScalarPointer());
  for (int i = 0; i < 45; ++i)
  {
    pixels[i] = std::uint8_t(i);
  }
  const Received received = receive(packed(sent));
  ASSERT_EQ(received.problem, "");
  const VideoFrame* frame = received.message.samples.at(0).frame();
  ASSERT_EQ(frame->image.size(), cv::Size(5, 3));
  EXPECT_EQ(frame->image.at<cv::Vec3b>(1, 2), cv::Vec3b(23, 22, 21));  // RGB 21 22 23 becomes BGR
  // The library keeps the middle; we say where the first pixel is, in RAS.
  float origin[3];
  sent->GetOrigin(origin);
  igtl::Matrix4x4 place;
  sent->GetMatrix(place);
  const Eigen::Vector4d middle = frame->imageToReference * Eigen::Vector4d(2, 1, 0, 1);
  EXPECT_NEAR(-middle.x(), double(place[0][3]), 1e-5);
  EXPECT_NEAR(-middle.y(), double(place[1][3]), 1e-5);
  EXPECT_NEAR(middle.z(), double(place[2][3]), 1e-5);
  EXPECT_NEAR(frame->imageToReference(0, 0), -0.5, 1e-6);
  EXPECT_NEAR(frame->imageToReference(1, 1), -0.25, 1e-6);
}

TEST(OpenIGTLinkMessage, OurImage_ReadsBackWithItsPlace)
{
  cv::Mat image(4, 6, CV_8UC3);
  cv::randu(image, 0, 256);
  Eigen::Matrix4d place = typicalMarkerToCamera().matrix();
  const Received received = receive(packImage("Video", 5, image, place, { { "Camera", "left" } }));
  ASSERT_EQ(received.problem, "");
  const DeviceSample& sample = received.message.samples.at(0);
  EXPECT_EQ(cv::norm(sample.frame()->image, image, cv::NORM_INF), 0);
  EXPECT_LT((sample.frame()->imageToReference - place).norm(), 1e-4);  // float32 on the way
  EXPECT_EQ(sample.metadata.at("Camera"), "left");
}

TEST(OpenIGTLinkMessage, LibrarysTrackingData_IsRead)
{
  igtl::TrackingDataMessage::Pointer sent = igtl::TrackingDataMessage::New();
  igtl::QuaternionTrackingDataMessage::Pointer quaternions = igtl::QuaternionTrackingDataMessage::New();
  const Eigen::Quaterniond turn(typicalMarkerToCamera().linear());
  const std::string fullName = "StylusTipToTrackers1";  // 20 bytes: no zero behind it
  for (const std::string& name : { fullName, std::string("MarkerToTracker") })
  {
    igtl::TrackingDataElement::Pointer element = igtl::TrackingDataElement::New();
    element->SetName(name.c_str());
    element->SetType(igtl::TrackingDataElement::TYPE_6D);
    igtl::Matrix4x4 matrix;
    toLibrary(typicalMarkerToCamera().matrix(), matrix);
    element->SetMatrix(matrix);
    sent->AddTrackingDataElement(element);
    igtl::QuaternionTrackingDataElement::Pointer other = igtl::QuaternionTrackingDataElement::New();
    other->SetName(name.c_str());
    other->SetPosition(18, -61, 34);
    other->SetQuaternion(float(turn.x()), float(turn.y()), float(turn.z()), float(turn.w()));
    quaternions->AddQuaternionTrackingDataElement(other);
  }
  for (const Bytes& bytes : { packed(sent), packed(quaternions) })
  {
    const Received received = receive(bytes);
    ASSERT_EQ(received.problem, "");
    ASSERT_EQ(received.message.samples.size(), 2U);
    EXPECT_EQ(received.message.samples[0].name, fullName);
    EXPECT_EQ(received.message.samples[1].name, "MarkerToTracker");
    for (const DeviceSample& sample : received.message.samples)
    {
      ASSERT_TRUE(sample.pose()->isValid) << sample.pose()->reason;
      EXPECT_LT((sample.pose()->transform.matrix() - typicalMarkerToCamera().matrix()).norm(), 1e-5);
    }
  }
}

/// The library itself writes beyond its memory when it packs the short forms (28 bytes into 24 or 12), so these are cut from the
/// long one.
TEST(OpenIGTLinkMessage, LibrarysPosition_IsReadInAllItsSizes)
{
  const Eigen::Quaterniond turn(typicalMarkerToCamera().linear());
  const double sign = turn.w() < 0 ? -1 : 1;  // three numbers leave the fourth's sign open: positive
  igtl::PositionMessage::Pointer sent = igtl::PositionMessage::New();
  sent->SetPackType(igtl::PositionMessage::ALL);
  sent->SetPosition(18, -61, 34);
  sent->SetQuaternion(float(sign * turn.x()), float(sign * turn.y()), float(sign * turn.z()), float(sign * turn.w()));
  const Bytes whole = packed(sent);
  ASSERT_EQ(whole.size(), HeaderBytes + 28);
  for (long count : { 28L, 24L, 12L })
  {
    const Bytes content(whole.begin() + HeaderBytes, whole.begin() + HeaderBytes + count);
    const Received received = receive(packMessage("POSITION", "StylusToTracker", 1, content, {}, 1));
    ASSERT_EQ(received.problem, "");
    const TrackedPose* pose = received.message.samples.at(0).pose();
    ASSERT_TRUE(pose->isValid) << pose->reason;
    EXPECT_LT((pose->transform.translation() - Eigen::Vector3d(18, -61, 34)).norm(), 1e-5);
    const Eigen::Matrix3d expected = count == 12 ? Eigen::Matrix3d::Identity().eval() : turn.toRotationMatrix();
    EXPECT_LT((pose->transform.linear() - expected).norm(), 1e-5);
  }
  EXPECT_EQ(receive(whole).message.samples.size(), 1U);
}

TEST(OpenIGTLinkMessage, LibrarysStringAndStatus_AreRead)
{
  igtl::StringMessage::Pointer text = igtl::StringMessage::New();
  text->SetString("pivot begins");
  EXPECT_EQ(receive(packed(text)).message.samples.at(0).text()->text, "pivot begins");
  igtl::StatusMessage::Pointer status = igtl::StatusMessage::New();
  status->SetCode(igtl::StatusMessage::STATUS_NOT_READY);
  status->SetSubCode(-7);
  status->SetErrorName("Warming up");
  status->SetStatusString("two minutes more");
  const Received received = receive(packed(status));
  const DeviceStatus* read = received.message.samples.at(0).status();
  EXPECT_EQ(read->code, int(igtl::StatusMessage::STATUS_NOT_READY));
  EXPECT_EQ(read->subcode, -7);
  EXPECT_EQ(read->error, "Warming up");
  EXPECT_EQ(read->message, "two minutes more");
}

TEST(OpenIGTLinkMessage, TransformStatus_IsHonoured)
{
  for (const char* status : { "INVALID", "MISSING", "OUT_OF_VIEW" })
  {
    const Received received =
      receive(packTransform("StylusToTracker", 1, Eigen::Matrix4d::Identity(), { { "TransformStatus", status } }));
    ASSERT_EQ(received.problem, "");
    EXPECT_FALSE(received.message.samples.at(0).pose()->isValid);
    EXPECT_NE(received.message.samples[0].pose()->reason.find(status), std::string::npos);
  }
  EXPECT_TRUE(receive(packTransform("S", 1, Eigen::Matrix4d::Identity(), { { "TransformStatus", "OK" } }))
                .message.samples.at(0)
                .pose()
                ->isValid);
}

TEST(OpenIGTLinkMessage, NumbersThatAreNoPose_AreNotValid)
{
  Eigen::Matrix4d notANumber = Eigen::Matrix4d::Identity();
  notANumber(1, 3) = std::numeric_limits<double>::quiet_NaN();
  Eigen::Matrix4d mirrored = Eigen::Matrix4d::Identity();
  mirrored(0, 0) = -1;
  for (const Eigen::Matrix4d& matrix : { notANumber, mirrored, Eigen::Matrix4d(Eigen::Matrix4d::Zero()) })
  {
    const Received received = receive(packTransform("StylusToTracker", 1, matrix));
    ASSERT_EQ(received.problem, "");
    EXPECT_FALSE(received.message.samples.at(0).pose()->isValid);
    EXPECT_FALSE(received.message.samples[0].pose()->reason.empty());
  }
}

TEST(OpenIGTLinkMessage, DeviceNameOfTwentyBytes_HasNoZero)
{
  const std::string name = "ABCDEFGHIJKLMNOPQRST";
  EXPECT_EQ(receive(packTransform(name, 1, Eigen::Matrix4d::Identity())).message.samples.at(0).name, name);
  EXPECT_THROW(packTransform(name + "U", 1, Eigen::Matrix4d::Identity()), std::invalid_argument);
}

/// Bytes that lie about what is in them: all must be refused with a sentence, and a sanitizer must have nothing to say.
TEST(OpenIGTLinkMessage, EveryTruncation_IsRefused)
{
  cv::Mat image(4, 6, CV_8UC3, cv::Scalar::all(7));
  const Bytes whole = packImage("Video", 1, image);
  const Bytes content(whole.begin() + HeaderBytes + 12, whole.end() - 2);
  for (const char* type : { "IMAGE", "TRANSFORM", "TDATA", "QTDATA", "POSITION", "STATUS", "STRING" })
  {
    int taken = 0;
    for (std::size_t count = 0; count < content.size(); ++count)
    {
      const Received received = receive(packMessage(type, "D", 1, Bytes(content.begin(), content.begin() + long(count)), {}, 1));
      taken += received.problem.empty() && !received.message.samples.empty() ? 1 : 0;
    }
    // Only sizes that are right for the type get through; pixels that are cut short never do.
    EXPECT_EQ(taken, std::strcmp(type, "IMAGE") == 0 ? 0 : taken) << type;
    EXPECT_LT(taken, int(content.size())) << type;
  }
  const Received received = receive(packMessage("TRANSFORM", "D", 1, Bytes(47), {}, 1));
  EXPECT_NE(received.problem.find("47 bytes"), std::string::npos) << received.problem;
}

TEST(OpenIGTLinkMessage, EveryFlippedByte_IsFoundByTheChecksum)
{
  const Bytes good = packTransform("StylusToTracker", 1, typicalMarkerToCamera().matrix(), { { "TransformStatus", "OK" } });
  for (std::size_t at = HeaderBytes; at < good.size(); ++at)
  {
    Bytes bad = good;
    bad[at] ^= 0x10;
    EXPECT_NE(receive(bad).problem.find("checksum"), std::string::npos) << at;
  }
}

TEST(OpenIGTLinkMessage, RandomBodiesWithGoodChecksums_DoNoHarm)
{
  Random random(5);
  for (int round = 0; round < 4000; ++round)
  {
    Bytes content(std::size_t(random.integer(0, 200)));
    for (std::uint8_t& byte : content)
    {
      byte = std::uint8_t(random.integer(0, 3) == 0 ? random.integer(0, 255) : random.integer(0, 2));
    }
    const char* types[] = { "IMAGE", "TRANSFORM", "TDATA", "QTDATA", "POSITION", "STATUS", "STRING", "VIDEO" };
    Bytes message = packMessage(types[round % 8], "D", 1, content, {}, 1);
    message[1] = std::uint8_t(1 + round % 2);  // as protocol 3: the body's beginning is taken for an extended header
    const Received received = receive(message);
    if (received.problem.empty() && received.message.isKnownType)
    {
      EXPECT_LE(received.message.samples.size(), 1 + content.size() / 50);
    }
  }
}

/// Every tool of a message gets its metadata: many of both would be a sender's way to take all memory.
TEST(OpenIGTLinkMessage, MoreToolsOrMetadataThanThereAre_AreRefused)
{
  constexpr std::size_t ToolBytes = 70;
  const Metadata much = { { "Note", std::string(70000, 'x') } };
  EXPECT_EQ(receive(packMessage("TDATA", "Tracker", 1, Bytes(1000 * ToolBytes))).message.samples.size(), 1000U);
  for (const Bytes& hostile :
    { packMessage("TDATA", "Tracker", 1, Bytes(1001 * ToolBytes)), packMessage("TDATA", "Tracker", 1, Bytes(ToolBytes), much) })
  {
    const Received received = receive(hostile);
    EXPECT_TRUE(received.message.samples.empty());
    EXPECT_NE(received.problem.find("are taken"), std::string::npos) << received.problem;
  }
}

TEST(OpenIGTLinkMessage, WhatIsNoHeader_IsRefused)
{
  std::array<std::uint8_t, HeaderBytes> bytes{};
  std::string problem;
  EXPECT_FALSE(parseHeader(bytes, problem));
  const char* web = "HTTP/1.1 400 Bad Request\r\nContent-Type: text/html; charset=utf-8\r\n";
  std::memcpy(bytes.data(), web, HeaderBytes);
  EXPECT_FALSE(parseHeader(bytes, problem));
  EXPECT_NE(problem.find("not OpenIGTLink"), std::string::npos);
}

TEST(FramePool, HandsOutMemoryAgainThatNobodyUses)
{
  FramePool pool;
  cv::Mat first = pool.take(4, 4, CV_8UC3);
  const std::uint8_t* memory = first.data;
  cv::Mat second = pool.take(4, 4, CV_8UC3);
  EXPECT_NE(second.data, memory);
  first.release();
  EXPECT_EQ(pool.take(4, 4, CV_8UC3).data, memory);
}

}  // namespace
