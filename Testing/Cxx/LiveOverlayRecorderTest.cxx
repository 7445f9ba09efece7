// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LiveOverlayRecorder.h"

#include "FileError.h"
#include "SequenceMetafile.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include <chrono>
#include <filesystem>
#include <thread>

namespace
{

using namespace handeye;
namespace fs = std::filesystem;

fs::path freshFolder()
{
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const fs::path folder = fs::path(HANDEYE_TEST_OUTPUT_DIR) / (std::string("LiveOverlayRecorder.") + info->name());
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

/// A grey that tells which picture it is, also after an encoder.
cv::Mat picture(int index, const cv::Size& size = { 160, 120 })
{
  return cv::Mat(size, CV_8UC3, cv::Scalar::all(20 + 12 * index));
}

OverlayTransformSet placed(double x)
{
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.translation().x() = x;
  return { { "ModelToCamera", transform } };
}

/// Which picture is in each frame of a video.
std::vector<int> picturesIn(const fs::path& file)
{
  cv::VideoCapture video(file.string());
  std::vector<int> indices;
  for (cv::Mat frame; video.read(frame);)
  {
    indices.push_back(int(std::lround((cv::mean(frame)[1] - 20) / 12)));
  }
  return indices;
}

}  // namespace

TEST(LiveOverlayRecorder, UnevenPictures_LastAsLongAsTheyWereSeen)
{
  const fs::path folder = freshFolder();
  OverlayRecorderOptions options;
  options.framesPerSec = 10;
  {
    LiveOverlayRecorder recorder(folder / "overlay.avi", options);
    int index = 0;
    // The second is 0.3 s later; the third a little early; the fourth comes with the third; a second without pictures.
    for (const double timeSec : { 100.0, 100.3, 100.39, 100.41, 100.6 })
    {
      EXPECT_TRUE(recorder.add(picture(index), timeSec, placed(index)));
      ++index;
    }
  }  // nothing is lost where nobody waits
  EXPECT_EQ(picturesIn(folder / "overlay.avi"), (std::vector<int>{ 0, 0, 0, 1, 2, 3, 4 }));
  const io::SequenceMetafile metafile = io::SequenceMetafile::open(folder / "overlay.igs.mha");
  ASSERT_EQ(metafile.frameCount(), 7);
  EXPECT_NEAR(*metafile.frame(2).timestampSec, 100.0, 1e-9);
  EXPECT_NEAR(*metafile.frame(3).timestampSec, 100.3, 1e-9);
  EXPECT_EQ(metafile.transform(5, "ModelToCamera").transform.translation().x(), 3);
}

TEST(LiveOverlayRecorder, TimesThatGoBackOrPause_GoOnWithoutAGap)
{
  const fs::path folder = freshFolder();
  OverlayRecorderOptions options;
  options.framesPerSec = 10;
  {
    LiveOverlayRecorder recorder(folder / "overlay.avi", options);
    int index = 0;
    for (const double timeSec : { 50.0, 50.1, 10.0, 10.1, 70.0, 70.1 })
    {
      EXPECT_TRUE(recorder.add(picture(index), timeSec, placed(index)));
      ++index;
    }
  }
  EXPECT_EQ(picturesIn(folder / "overlay.avi"), (std::vector<int>{ 0, 1, 2, 3, 4, 5 }));
}

TEST(LiveOverlayRecorder, FinishDoesNotWait_AndAllIsWritten)
{
  const fs::path folder = freshFolder();
  LiveOverlayRecorder recorder(folder / "overlay.mp4");
  constexpr int count = 20;
  for (int i = 0; i < count; ++i)
  {
    EXPECT_TRUE(recorder.add(picture(i % 15, { 640, 480 }), 5 + i / 30.0, placed(i)));
  }
  recorder.finish();
  EXPECT_FALSE(recorder.add(picture(0, { 640, 480 }), 9, {})) << "after finish()";
  while (!recorder.state().isFinished)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const LiveOverlayRecorder::State state = recorder.state();
  EXPECT_EQ(state.error, "");
  EXPECT_EQ(state.pictureCount, count);
  EXPECT_EQ(state.frameCount, count);
  EXPECT_EQ(state.waitingCount, 0);
  EXPECT_EQ(state.leftOutCount, 0);
  EXPECT_FALSE(state.encoder.empty());
  EXPECT_EQ(int(picturesIn(folder / "overlay.mp4").size()), count);
}

TEST(LiveOverlayRecorder, WhatIsLeftOut_IsCountedAndSaid)
{
  const fs::path folder = freshFolder();
  LiveOverlayRecorder recorder(folder / "overlay.avi");
  recorder.add(picture(0), 1, {});
  recorder.add(picture(1, { 80, 60 }), 1.1, {});
  recorder.finish();
  while (!recorder.state().isFinished)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(recorder.state().pictureCount, 1);
  EXPECT_EQ(recorder.state().leftOutCount, 1);
  EXPECT_NE(recorder.state().leftOutReason.find("another size"), std::string::npos) << recorder.state().leftOutReason;
  EXPECT_EQ(recorder.state().error, "");

  // Faster than the file: forty pictures in a tenth of a second have no places in a video of 30 a second.
  LiveOverlayRecorder fast(folder / "fast.avi", {}, 100);
  for (int i = 0; i < 40; ++i)
  {
    fast.add(picture(0), 1 + 0.0025 * i, {});
  }
  fast.finish();
  while (!fast.state().isFinished)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_LE(fast.state().frameCount, 6);
  EXPECT_EQ(fast.state().pictureCount + fast.state().leftOutCount, 40);
}

TEST(LiveOverlayRecorder, PictureOfAnotherSize_TakesItsTimeAllTheSame)
{
  const fs::path folder = freshFolder();
  OverlayRecorderOptions options;
  options.framesPerSec = 10;
  LiveOverlayRecorder recorder(folder / "overlay.avi", options);
  recorder.add(cv::Mat(120, 160, CV_8UC1, cv::Scalar(9)), 0.5, {});  // before the first there is nothing that could stay
  recorder.add(picture(0), 1, placed(0));
  recorder.add(picture(1, { 80, 60 }), 1.2, placed(1));
  recorder.add(picture(2), 1.3, placed(2));
  recorder.add(picture(3, { 80, 60 }), 1.4, placed(3));
  recorder.finish();
  while (!recorder.state().isFinished)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(recorder.state().pictureCount, 2);
  EXPECT_EQ(recorder.state().leftOutCount, 3);
  EXPECT_EQ(recorder.state().frameCount, 5);
  EXPECT_EQ(picturesIn(folder / "overlay.avi"), (std::vector<int>{ 0, 0, 0, 2, 2 }));
  EXPECT_EQ(io::SequenceMetafile::open(folder / "overlay.igs.mha").frameCount(), 5);
}

TEST(LiveOverlayRecorder, VideoThatCannotBeWritten_EndsWithItsReason)
{
  EXPECT_THROW(LiveOverlayRecorder("overlay.gif"), io::FileError);
  const fs::path folder = freshFolder();
  LiveOverlayRecorder nowhere(folder / "no" / "such" / "overlay.avi");
  int taken = 0;
  for (int i = 0; i < 20; ++i)
  {
    taken += nowhere.add(picture(0), 1 + i / 30.0, {}) ? 1 : 0;
  }
  while (!nowhere.state().isFinished)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_FALSE(nowhere.state().error.empty());
  EXPECT_EQ(nowhere.state().waitingCount, 0) << "nobody waits for what is never written";
  EXPECT_EQ(nowhere.state().leftOutCount, taken);
  EXPECT_FALSE(nowhere.add(picture(1), 1.1, {}));
  LiveOverlayRecorder empty(folder / "empty.avi");
  empty.finish();
  while (!empty.state().isFinished)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_NE(empty.state().error.find("no pictures"), std::string::npos) << empty.state().error;
}
