// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "VideoSource.h"
#include "DeviceTestSupport.h"
#include "IoTestSupport.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include <atomic>

namespace
{

using namespace handeye::devices;
using namespace handeye::devices::test;
using handeye::io::test::TemporaryFolder;

/// A camera whose cable can be pulled.
struct Cable
{
  std::atomic<bool> isPlugged{ true };
};

class FakeCamera : public FrameGrabber
{
public:
  explicit FakeCamera(std::shared_ptr<Cable> cable)
    : cable_(std::move(cable))
  {
  }
  cv::Mat grab() override
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return cable_->isPlugged ? cv::Mat(4, 4, CV_8UC3, cv::Scalar::all(9)) : cv::Mat();
  }
  bool isFinite() const override { return false; }

private:
  std::shared_ptr<Cable> cable_;
};

TEST(VideoSource, UnpluggedCamera_IsShownAndFoundAgain)
{
  const auto cable = std::make_shared<Cable>();
  VideoSource source({},
    [cable]() -> std::unique_ptr<FrameGrabber>
    {
      if (!cable->isPlugged)
      {
        throw std::runtime_error("camera 0 cannot be opened");
      }
      return std::make_unique<FakeCamera>(cable);
    });
  source.start();
  ASSERT_TRUE(source.pop(20));
  EXPECT_EQ(source.status().state, SourceState::Streaming);
  cable->isPlugged = false;
  ASSERT_TRUE(waitUntil([&] { return source.status().state == SourceState::Connecting; }));
  ASSERT_TRUE(waitUntil([&] { return source.status().message.find("cannot be opened") != std::string::npos; }));
  while (source.pop(0))
  {
  }
  cable->isPlugged = true;
  EXPECT_TRUE(source.pop(20));
  EXPECT_GE(source.status().connectionCount, 2U);
}

TEST(VideoSource, ImageSequence_IsDeliveredToItsEnd)
{
  const TemporaryFolder folder;
  for (int i = 0; i < 4; ++i)
  {
    cv::imwrite((folder.path() / ("000" + std::to_string(i) + ".png")).string(), cv::Mat(8, 8, CV_8UC3, cv::Scalar::all(20 * i)));
  }
  VideoSourceOptions options;
  options.device = (folder.path() / "%04d.png").string();
  options.realTime = false;
  VideoSource source(options);
  source.start();
  for (int i = 0; i < 4; ++i)
  {
    const std::optional<DeviceSample> sample = source.pop(20);
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->frame()->image.at<cv::Vec3b>(0, 0)[0], 20 * i);
  }
  EXPECT_TRUE(waitUntil([&] { return source.status().state == SourceState::Finished; }));
}

TEST(VideoSource, File_HasItsOwnTimes)
{
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "video.avi").string();
  {
    cv::VideoWriter writer(path, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25, { 32, 32 });
    ASSERT_TRUE(writer.isOpened());
    for (int i = 0; i < 5; ++i)
    {
      writer.write(cv::Mat(32, 32, CV_8UC3, cv::Scalar::all(40 * i)));
    }
  }
  VideoSourceOptions options;
  options.device = path;
  options.realTime = false;
  VideoSource source(options);
  source.start();
  for (int i = 0; i < 5; ++i)
  {
    const std::optional<DeviceSample> sample = source.pop(20);
    ASSERT_TRUE(sample);
    EXPECT_NEAR(sample->timeSec, i / 25.0, 1e-9);
  }
}

TEST(VideoSource, FileThatIsNoVideo_IsTheEnd)
{
  VideoSourceOptions options;
  options.device = "/nowhere/film.avi";
  VideoSource source(options);
  source.start();
  EXPECT_TRUE(waitUntil([&] { return source.status().state == SourceState::Finished; }));
  EXPECT_NE(source.status().lastProblem.find("/nowhere/film.avi"), std::string::npos);
  handeye::io::test::expectFileError([&] { requireReadable(options); }, { "/nowhere/film.avi", "video" });
  options.device = "97";
  EXPECT_NO_THROW(requireReadable(options)) << "a camera may be plugged in later";
}

/// Nobody listens there: stop() must not wait for a time-out of half a minute.
TEST(VideoSource, UrlThatDoesNotAnswer_IsTriedAgainAndCanBeStopped)
{
  VideoSourceOptions options;
  options.device = "http://127.0.0.1:9/video.mjpg";
  VideoSource source(options);
  source.start();
  EXPECT_TRUE(waitUntil([&] { return source.status().lastProblem.find("127.0.0.1:9") != std::string::npos; }));
  EXPECT_EQ(source.status().state, SourceState::Connecting);
  source.stop();
  EXPECT_EQ(source.status().state, SourceState::Stopped);
}

TEST(VideoSource, NoCamera_SaysWhatToLookFor)
{
  VideoSourceOptions options;
  options.device = "97";
  VideoSource source(options);
  source.start();
  EXPECT_TRUE(waitUntil([&] { return source.status().message.find("plugged in") != std::string::npos; }));
  source.stop();
}

}  // namespace
