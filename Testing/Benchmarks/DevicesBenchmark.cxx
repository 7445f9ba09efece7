// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a frame of full HD costs from the bytes of its message to an image: ours, libopenigtlink's own classes, and a bare copy.
#include "Crc64.h"
#include "OpenIGTLinkMessage.h"
#include "PoseTrack.h"
#include "RigidTransform.h"

#include <benchmark/benchmark.h>
#include <igtlImageMessage.h>
#include <igtlMessageHeader.h>
#include <igtl_util.h>

#include <chrono>
#include <cstring>
#include <functional>

namespace
{

using namespace handeye::devices;

const Bytes& fullHdMessage()
{
  static const Bytes message = []
  {
    cv::Mat picture(1080, 1920, CV_8UC3);
    cv::randu(picture, 0, 256);
    return packImage("Video", 1, picture, Eigen::Matrix4d::Identity(), {}, 1);
  }();
  return message;
}

/// Checksum, parsing, RGB to BGR, into an image of its own.
void receiveOurs(Bytes& body, const MessageHeader& header, FramePool& pool)
{
  benchmark::DoNotOptimize(checkCrc(header, body.data()));
  benchmark::DoNotOptimize(parseBody(header, body.data(), pool));
}

/// The library's way to the same: unpack with its checksum; its pixels stay RGB and in its own buffer.
void receiveLibrary(const Bytes& message)
{
  igtl::MessageHeader::Pointer header = igtl::MessageHeader::New();
  header->InitPack();
  std::memcpy(header->GetPackPointer(), message.data(), HeaderBytes);
  header->Unpack();
  igtl::ImageMessage::Pointer image = igtl::ImageMessage::New();
  image->SetMessageHeader(header);
  image->AllocatePack();
  std::memcpy(image->GetPackBodyPointer(), message.data() + HeaderBytes, message.size() - HeaderBytes);
  benchmark::DoNotOptimize(image->Unpack(1));
}

/// Runs both in turn, so that what the machine does meanwhile hits them alike; the times of ours are the benchmark's.
void compare(benchmark::State& state, const char* peer, const std::function<void()>& ours, const std::function<void()>& theirs)
{
  using Clock = std::chrono::steady_clock;
  double oursSec = 0, theirsSec = 0;
  for (auto _ : state)
  {
    const auto begin = Clock::now();
    ours();
    const auto middle = Clock::now();
    theirs();
    const auto end = Clock::now();
    oursSec += std::chrono::duration<double>(middle - begin).count();
    theirsSec += std::chrono::duration<double>(end - middle).count();
    state.SetIterationTime(std::chrono::duration<double>(middle - begin).count());
  }
  state.counters[std::string("ratio_to_") + peer] = oursSec / theirsSec;
  state.counters["theirs_ms"] = 1000 * theirsSec / double(state.iterations());
}

MessageHeader headerOf(const Bytes& message)
{
  std::array<std::uint8_t, HeaderBytes> bytes;
  std::copy_n(message.begin(), HeaderBytes, bytes.begin());
  std::string problem;
  return *parseHeader(bytes, problem);
}

void frameAgainstLibrary(benchmark::State& state)
{
  const Bytes& message = fullHdMessage();
  const MessageHeader header = headerOf(message);
  Bytes body(message.begin() + HeaderBytes, message.end());
  FramePool pool;
  compare(
    state, "libopenigtlink", [&] { receiveOurs(body, header, pool); }, [&] { receiveLibrary(message); });
}
BENCHMARK(frameAgainstLibrary)->UseManualTime()->Unit(benchmark::kMillisecond);

void frameAgainstBareCopy(benchmark::State& state)
{
  const Bytes& message = fullHdMessage();
  const MessageHeader header = headerOf(message);
  Bytes body(message.begin() + HeaderBytes, message.end()), copy(body.size());
  FramePool pool;
  compare(
    state, "bare_copy", [&] { receiveOurs(body, header, pool); },
    [&]
    {
      std::memcpy(copy.data(), body.data(), body.size());
      benchmark::ClobberMemory();
    });
}
BENCHMARK(frameAgainstBareCopy)->UseManualTime()->Unit(benchmark::kMillisecond);

void checksumAgainstLibrary(benchmark::State& state)
{
  Bytes body(fullHdMessage().begin() + HeaderBytes, fullHdMessage().end());
  compare(
    state, "libopenigtlink", [&] { benchmark::DoNotOptimize(crc64Ecma(body.data(), body.size())); },
    [&] { benchmark::DoNotOptimize(crc64(body.data(), body.size(), 0)); });
}
BENCHMARK(checksumAgainstLibrary)->UseManualTime()->Unit(benchmark::kMillisecond);

/// Five seconds of poses at 100 Hz, asked for the moment of an image.
void poseAtImageTime(benchmark::State& state)
{
  handeye::PoseTrack track;
  for (int i = 0; i < 500; ++i)
  {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = handeye::rotationFromVector({ 0.001 * i, 0, 0 });
    track.add(0.01 * i, pose);
  }
  double timeSec = 0;
  for (auto _ : state)
  {
    timeSec = timeSec > 4.9 ? 0 : timeSec + 0.0333;
    benchmark::DoNotOptimize(track.at(timeSec));
  }
}
BENCHMARK(poseAtImageTime);

}  // namespace

BENCHMARK_MAIN();
