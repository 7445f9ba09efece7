// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StreamRecorder.h"
#include "DeviceTestSupport.h"
#include "IoTestSupport.h"
#include "Recording.h"

#include <sys/resource.h>

#include <csignal>

namespace
{

using namespace handeye::devices;
using namespace handeye::devices::test;
using handeye::io::Recording;
using handeye::io::TransformSample;
using handeye::io::test::TemporaryFolder;

PairedFrame frameAt(int i)
{
  PairedFrame frame;
  VideoFrame video;
  video.image = cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(i));
  frame.image = { "Video", 100 + 0.1 * i, 0, {}, video };
  handeye::PoseAtTime& pose = frame.poses["StylusToTracker"];
  pose.status = i % 3 == 1 ? handeye::PoseAtTime::Status::Stale : handeye::PoseAtTime::Status::Ok;
  pose.transform.translation().x() = i;
  return frame;
}

DeviceSample poseAt(double timeSec, const std::string& name, bool isValid)
{
  TrackedPose pose;
  pose.isValid = isValid;
  pose.transform.translation().x() = timeSec;
  return { name, timeSec, 0, {}, pose };
}

/// Files cannot grow beyond this in the test: a disk that is full.
class FullDisk
{
public:
  explicit FullDisk(rlim_t bytes)
  {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit now = { bytes, before_.rlim_max };
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &now);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

private:
  rlimit before_ = {};
};

TEST(StreamRecorder, ReadsBackImagesAndPoses)
{
  const TemporaryFolder folder;
  StreamRecorder recorder(folder.path() / "video.igs.mha", folder.path() / "poses.igs.mha");
  for (int i = 0; i < 5; ++i)
  {
    EXPECT_TRUE(recorder.add(frameAt(i)));
    EXPECT_TRUE(recorder.add(poseAt(100 + i, "StylusToTracker", i != 3)));
    EXPECT_TRUE(recorder.add(poseAt(100 + i, "MarkerToTracker", true)));
  }
  ASSERT_TRUE(recorder.close()) << recorder.error();
  const Recording video = Recording::open(folder.path() / "video.igs.mha");
  ASSERT_EQ(video.frameCount(), 5);
  EXPECT_EQ(video.image(3).at<cv::Vec3b>(0, 0)[0], 3);
  EXPECT_NEAR(*video.timestampSec(4), 100.4, 1e-9);
  EXPECT_EQ(video.transform(0, "StylusToTracker").status, TransformSample::Status::Ok);
  EXPECT_EQ(video.transform(1, "StylusToTracker").status, TransformSample::Status::Invalid);
  const Recording poses = Recording::open(folder.path() / "poses.igs.mha");
  ASSERT_EQ(poses.frameCount(), 5);
  EXPECT_EQ(poses.transformNames().size(), 2U);
  EXPECT_EQ(poses.transform(3, "StylusToTracker").status, TransformSample::Status::Invalid);
  EXPECT_EQ(poses.transform(4, "MarkerToTracker").transform.translation().x(), 104);
}

TEST(StreamRecorder, LatencyOfThePairing_IsWritten)
{
  const TemporaryFolder folder;
  StreamRecorder recorder(folder.path() / "video.igs.mha", folder.path() / "poses.igs.mha");
  PairedFrame frame = frameAt(0);
  frame.latencySec = -0.04;
  recorder.add(frame);
  recorder.add(poseAt(100, "StylusToTracker", true));
  ASSERT_TRUE(recorder.close()) << recorder.error();
  EXPECT_EQ(Recording::open(folder.path() / "video.igs.mha").appliedLatencySec(), -0.04);
  EXPECT_EQ(Recording::open(folder.path() / "poses.igs.mha").appliedLatencySec(), 0) << "these are by their own times";
}

TEST(StreamRecorder, FullDisk_EndsTheRecordingAndNothingElse)
{
  const TemporaryFolder folder;
  StreamRecorder recorder(folder.path() / "video.igs.mha", "");
  int taken = 0;
  {
    const FullDisk full(200000);
    for (int i = 0; i < 100; ++i)
    {
      taken += recorder.add(frameAt(i)) ? 1 : 0;
    }
    EXPECT_FALSE(recorder.close());
  }
  EXPECT_LT(taken, 100);
  EXPECT_TRUE(recorder.hasFailed());
  EXPECT_NE(recorder.error().find("video.igs.mha"), std::string::npos) << recorder.error();
  EXPECT_FALSE(recorder.add(frameAt(1)));
  EXPECT_EQ(folder.entryCount(), 0U);
}

TEST(StreamRecorder, AFailure_KeepsWhatWasRecorded)
{
  const TemporaryFolder folder;
  StreamRecorder recorder(folder.path() / "video.igs.mha", folder.path() / "poses.igs.mha");
  int taken = 0;
  {
    const FullDisk full(200000);
    for (int i = 0; i < 100; ++i)
    {
      taken += recorder.add(frameAt(i)) ? 1 : 0;
    }
  }
  ASSERT_LT(taken, 100);
  EXPECT_TRUE(recorder.add(poseAt(100, "StylusToTracker", true))) << "the other file goes on";
  EXPECT_FALSE(recorder.close()) << "not all was recorded";
  const Recording video = Recording::open(folder.path() / "video.igs.mha");
  ASSERT_EQ(video.frameCount(), taken);
  EXPECT_EQ(video.image(taken - 1).at<cv::Vec3b>(47, 63)[2], taken - 1);
  EXPECT_EQ(Recording::open(folder.path() / "poses.igs.mha").frameCount(), 1);
}

TEST(StreamRecorder, WhatCannotBeWritten_IsLeftOutAndTheRestGoesOn)
{
  const TemporaryFolder folder;
  StreamRecorder recorder(folder.path() / "video.igs.mha", folder.path() / "poses.igs.mha");
  for (int i = 0; i < 4; ++i)
  {
    PairedFrame frame = frameAt(i);
    frame.poses["My Needle"] = frame.poses["StylusToTracker"];
    frame.poses["StylusToTrackerTransform"] = frame.poses["StylusToTracker"];
    if (i == 2)
    {
      VideoFrame other;
      other.image = cv::Mat(10, 10, CV_8UC3, cv::Scalar::all(0));
      frame.image.content = other;
    }
    EXPECT_TRUE(recorder.add(frame));
    EXPECT_TRUE(recorder.add(poseAt(100 + i, "a=b", true)));
    EXPECT_TRUE(recorder.add(poseAt(100 + i, "StylusToTracker", true)));
  }
  EXPECT_EQ(recorder.leftOutCount(), 4) << "an image and three tools";
  EXPECT_NE(recorder.leftOutReason().find("My Needle"), std::string::npos) << recorder.leftOutReason();
  ASSERT_TRUE(recorder.close()) << recorder.error();
  const Recording video = Recording::open(folder.path() / "video.igs.mha");
  ASSERT_EQ(video.frameCount(), 3);
  EXPECT_EQ(video.transformNames(), std::vector<std::string>({ "StylusToTracker" }));
  EXPECT_EQ(video.image(2).at<cv::Vec3b>(0, 0)[0], 3);
  EXPECT_EQ(Recording::open(folder.path() / "poses.igs.mha").frameCount(), 4);
}

TEST(StreamRecorder, FolderThatIsNotThere_IsAFileError)
{
  handeye::io::test::expectFileError([] { StreamRecorder recorder("/nowhere/video.igs.mha", ""); }, { "/nowhere" });
}

}  // namespace
