// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// A video of full HD at 60 frames a second and two tools at 100 poses a second, over loopback: nothing is lost, memory stays flat.
// Faster than real time. HANDEYE_LOAD_SECONDS says how much stream time; `ctest --preset release -C Load -L load` runs ten minutes.
#include "DeviceTestSupport.h"
#include "OpenIGTLinkClient.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <fstream>

namespace
{

using namespace handeye::devices;
using namespace handeye::devices::test;

constexpr int FramesPerSec = 60, PosesPerSec = 100;

std::size_t residentBytes()
{
  std::ifstream file("/proc/self/statm");
  std::size_t total = 0, resident = 0;
  file >> total >> resident;
  return resident * 4096;
}

int streamSeconds()
{
  const char* asked = std::getenv("HANDEYE_LOAD_SECONDS");
  return asked != nullptr ? std::atoi(asked) : 10;
}

/// Sends the stream in the order of its times: every picture has its number in its first pixels.
/// It waits for the receiver when it is far ahead: what is tested is the way, and not who gets the processor.
void sendStream(RawServer& server, int seconds, const std::atomic<int>& received)
{
  constexpr int MostAhead = 20;
  cv::Mat picture(1080, 1920, CV_8UC3);
  cv::randu(picture, 0, 256);
  int pose = 0;
  for (int frame = 0; frame < seconds * FramesPerSec; ++frame)
  {
    if (!waitUntil([&] { return frame - received < MostAhead; }, 60))
    {
      return;  // the receiver has given up, which it says itself
    }
    for (; pose * FramesPerSec <= frame * PosesPerSec; ++pose)
    {
      server.send(packTransform("StylusToTracker", 1 + double(pose) / PosesPerSec, shiftedBy(pose)));
      server.send(packTransform("MarkerToTracker", 1 + double(pose) / PosesPerSec, shiftedBy(-pose)));
    }
    *picture.ptr<int>(0) = frame;
    server.send(packImage("Video", 1 + double(frame) / FramesPerSec, picture));
  }
}

TEST(DeviceLoad, FullHdAndTwoTools_LoseNothingAndMemoryStaysFlat)
{
  const int seconds = streamSeconds();
  ASSERT_GT(seconds, 0);
  RawServer server;
  OpenIGTLinkClientOptions options;
  options.port = server.port();
  OpenIGTLinkClient client(options);
  client.start();
  ASSERT_TRUE(server.acceptClient());
  const double beginSec = systemTimeSec();
  std::atomic<int> received = 0;
  std::thread sender([&] { sendStream(server, seconds, received); });
  const int frameCount = seconds * FramesPerSec;
  int frames = 0, poses[2] = { 0, 0 };
  bool isInOrder = true;
  std::size_t early = 0, highest = 0;
  while (frames < frameCount)
  {
    const std::optional<DeviceSample> sample = client.pop(60);
    if (!sample)
    {
      break;
    }
    if (const VideoFrame* frame = sample->frame())
    {
      isInOrder = isInOrder && *frame->image.ptr<int>(0) == frames;
      isInOrder = isInOrder && frame->image.cols == 1920;
      received = frames + 1;
      early = ++frames == frameCount / 4 ? residentBytes() : early;
      highest = frames > frameCount / 4 ? std::max(highest, residentBytes()) : highest;
    }
    else
    {
      int& count = poses[sample->name == "StylusToTracker" ? 0 : 1];
      isInOrder = isInOrder && std::abs(sample->pose()->received(0, 3)) == float(count);
      ++count;
    }
  }
  sender.join();
  const double tookSec = systemTimeSec() - beginSec;
  std::printf("%d s of stream time in %.1f s: %d frames, %d and %d poses, dropped %d, refused %d; memory %.0f MB after a quarter, "
              "%.0f MB at most\n",
    seconds, tookSec, frames, poses[0], poses[1], int(client.status().droppedCount), int(client.status().refusedCount),
    double(early) / 1048576, double(highest) / 1048576);
  EXPECT_EQ(frames, frameCount);
  EXPECT_EQ(poses[0], poses[1]);
  EXPECT_GE(poses[0], (frameCount - 1) * PosesPerSec / FramesPerSec);
  EXPECT_TRUE(isInOrder);
  EXPECT_EQ(client.status().droppedCount, 0U);
  EXPECT_EQ(client.status().refusedCount, 0U);
  // Twenty frames of 6 MB at most are on their way, in the buffer or in the pool, whatever else the machine does; early has some of
  // them. A leak of every tenth frame would be 280 MB in the ten seconds.
  constexpr std::size_t FrameBytes = std::size_t(1920) * 1080 * 3;
  EXPECT_LT(highest, early + 25 * FrameBytes);
}

}  // namespace
