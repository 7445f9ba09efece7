// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReplaySource.h"
#include "DeviceTestSupport.h"
#include "IoTestSupport.h"
#include "SequenceMetafileWriter.h"

#include <opencv2/imgcodecs.hpp>

#include <fstream>

namespace
{

using namespace handeye::devices;
using namespace handeye::devices::test;
using handeye::io::test::TemporaryFolder;

/// Five frames at 50 a second; the tool is hidden in the third.
std::filesystem::path recordingIn(const TemporaryFolder& folder)
{
  const std::filesystem::path path = folder.path() / "five.igs.mha";
  handeye::io::SequenceMetafileWriter writer(path);
  for (int i = 0; i < 5; ++i)
  {
    handeye::io::SequenceFrame frame;
    frame.timestampSec = 7 + 0.02 * i;
    frame.transforms["StylusToTracker"] = { shiftedBy(i), i == 2 ? "INVALID" : "OK" };
    writer.append(frame, cv::Mat(4, 6, CV_8UC3, cv::Scalar::all(10 * i)));
  }
  writer.close();
  return path;
}

ReplayOptions optionsFor(const std::filesystem::path& path)
{
  ReplayOptions options;
  options.recording = path;
  options.speed = 0;
  return options;
}

TEST(ReplaySource, DeliversEveryFrameOnceInOrder)
{
  const TemporaryFolder folder;
  ReplaySource source(optionsFor(recordingIn(folder)));
  source.start();
  for (int i = 0; i < 5; ++i)
  {
    const std::optional<DeviceSample> pose = source.pop(20), image = source.pop(20);
    ASSERT_TRUE(pose && image);
    EXPECT_EQ(pose->name, "StylusToTracker");
    EXPECT_EQ(pose->pose()->isValid, i != 2);
    EXPECT_NEAR(pose->timeSec, 7 + 0.02 * i, 1e-9);
    ASSERT_TRUE(image->frame());
    EXPECT_EQ(image->frame()->image.at<cv::Vec3b>(0, 0)[0], 10 * i);
  }
  EXPECT_TRUE(waitUntil([&] { return source.status().state == SourceState::Finished; }));
  EXPECT_FALSE(source.pop(0));
}

TEST(ReplaySource, WaitsForRoomAndLosesNothing)
{
  const TemporaryFolder folder;
  ReplayOptions options = optionsFor(recordingIn(folder));
  options.buffer.maximumCount = 1;
  ReplaySource source(options);
  source.start();
  int count = 0;
  while (source.pop(1))
  {
    ++count;
  }
  EXPECT_EQ(count, 10);
  EXPECT_EQ(source.status().droppedCount, 0U);
}

TEST(ReplaySource, Stepwise_GivesAFrameAStep)
{
  const TemporaryFolder folder;
  ReplayOptions options = optionsFor(recordingIn(folder));
  options.isStepwise = true;
  ReplaySource source(options);
  source.start();
  EXPECT_FALSE(source.pop(0.1));
  source.step();
  ASSERT_TRUE(source.pop(20));
  ASSERT_TRUE(source.pop(20));
  EXPECT_FALSE(source.pop(0.1));
  source.stop();  // while it waits for a step
  EXPECT_EQ(source.status().state, SourceState::Stopped);
}

TEST(ReplaySource, Loop_GoesOnWithLaterTimes)
{
  const TemporaryFolder folder;
  ReplayOptions options = optionsFor(recordingIn(folder));
  options.isLooping = true;
  ReplaySource source(options);
  source.start();
  double lastSec = 0;
  for (int i = 0; i < 20; ++i)
  {
    const std::optional<DeviceSample> pose = popNamed(source, "StylusToTracker");
    ASSERT_TRUE(pose);
    EXPECT_GT(pose->timeSec, lastSec);
    lastSec = pose->timeSec;
  }
}

TEST(ReplaySource, RealTime_TakesAsLongAsItTook)
{
  const TemporaryFolder folder;
  ReplayOptions options = optionsFor(recordingIn(folder));
  options.speed = 0.5;
  ReplaySource source(options);
  const double startSec = systemTimeSec();
  source.start();
  ASSERT_TRUE(waitUntil([&] { return source.status().state == SourceState::Finished; }));
  EXPECT_GE(systemTimeSec() - startSec, 0.15);  // 0.08 s at half the speed; never earlier, later on a loaded machine
}

TEST(ReplaySource, MissingRecording_IsTheEnd)
{
  ReplaySource source(optionsFor("/nowhere/at.igs.mha"));
  source.start();
  EXPECT_TRUE(waitUntil([&] { return source.status().state == SourceState::Finished; }));
  EXPECT_NE(source.status().lastProblem.find("/nowhere/at.igs.mha"), std::string::npos);
}

/// It is not begun again and again, which would fill a disk that records it.
TEST(ReplaySource, DamagedFrame_IsLeftOutAndTheRestIsPlayedOnce)
{
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "frames");
  handeye::io::SequenceMetafileWriter tracking(folder.path() / "tracking.igs.mha");
  for (int i = 0; i < 3; ++i)
  {
    handeye::io::SequenceFrame frame;
    frame.timestampSec = 7 + 0.02 * i;
    tracking.append(frame);
    const std::string name = (folder.path() / "frames" / ("000" + std::to_string(i) + ".png")).string();
    cv::imwrite(name, cv::Mat(4, 6, CV_8UC3, cv::Scalar::all(10 * i)));
  }
  tracking.close();
  std::ofstream(folder.path() / "frames/0001.png") << "no picture";
  ReplaySource source(optionsFor(folder.path()));
  source.start();
  std::vector<int> seen;
  while (const std::optional<DeviceSample> sample = source.pop(5))
  {
    seen.push_back(sample->frame()->image.at<cv::Vec3b>(0, 0)[0]);
  }
  EXPECT_EQ(seen, (std::vector<int>{ 0, 20 }));
  EXPECT_EQ(source.status().state, SourceState::Finished);
  EXPECT_EQ(source.status().refusedCount, 1U);
  EXPECT_NE(source.status().lastProblem.find("frame 1 is left out"), std::string::npos) << source.status().lastProblem;
}

TEST(ReplaySource, StartedAgain_PlaysFromTheBeginning)
{
  const TemporaryFolder folder;
  ReplayOptions options = optionsFor(recordingIn(folder));
  ReplaySource source(options);
  for (int round = 0; round < 2; ++round)
  {
    source.start();
    ASSERT_TRUE(waitUntil([&] { return source.status().state == SourceState::Finished; }));
    EXPECT_EQ(source.buffer().size(), 10U) << "nothing of the round before";
  }
}

TEST(ReplaySource, StepwiseStoppedAndStartedAgain_NeedsOneStepForAFrame)
{
  const TemporaryFolder folder;
  ReplayOptions options = optionsFor(recordingIn(folder));
  options.isStepwise = true;
  ReplaySource source(options);
  for (int round = 0; round < 3; ++round)
  {
    source.start();
    EXPECT_FALSE(source.pop(0.05));
    source.step();
    EXPECT_TRUE(source.pop(20)) << round;
    source.stop();
  }
}

}  // namespace
