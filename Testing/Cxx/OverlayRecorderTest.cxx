// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OverlayRecorder.h"

#include "FileError.h"
#include "SequenceMetafile.h"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include <filesystem>
#include <limits>
#include <stdexcept>

namespace
{

using namespace handeye;
namespace fs = std::filesystem;

fs::path freshFolder()
{
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const fs::path folder = fs::path(HANDEYE_TEST_OUTPUT_DIR) / (std::string("OverlayRecorder.") + info->name());
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

cv::Mat picture(int index, const cv::Size& size = { 160, 120 })
{
  cv::Mat bgr(size, CV_8UC3, cv::Scalar(40, 60, 90));
  cv::circle(bgr, { 20 + 8 * index, 60 }, 14, { 30, 30, 220 }, cv::FILLED);
  return bgr;
}

Eigen::Isometry3d shifted(double x)
{
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.translation().x() = x;
  return transform;
}

void record(const fs::path& file, const cv::Size& size = { 160, 120 })
{
  OverlayRecorder recorder(file);
  for (int i = 0; i < 12; ++i)
  {
    OverlayTransformSet transforms{ { "ModelToCamera", shifted(i) } };
    if (i == 5)
    {
      transforms["ModelToCamera"].reset();
    }
    recorder.append(picture(i, size), 100 + 0.04 * i, transforms);
  }
  EXPECT_FALSE(recorder.encoder().empty());
  std::cout << file.filename().string() << ": " << recorder.encoder() << "\n";
  recorder.close();
}

void expectVideo(const fs::path& file, const cv::Size& size)
{
  cv::VideoCapture video(file.string());
  ASSERT_TRUE(video.isOpened()) << file;
  cv::Mat frame;
  int count = 0;
  while (video.read(frame))
  {
    ASSERT_EQ(frame.size(), size);
    const cv::Vec3b ball = frame.at<cv::Vec3b>(60, 20 + 8 * count);
    EXPECT_GT(int(ball[2]), 150) << "frame " << count;  // red, not blue, and where it was drawn
    EXPECT_LT(int(ball[0]), 100) << "frame " << count;
    ++count;
  }
  EXPECT_EQ(count, 12);
}

}  // namespace

TEST(OverlayRecorder, Video_HasEveryFrameAndItsTransformsBesideIt)
{
  const fs::path folder = freshFolder();
  for (const std::string name : { "overlay.mp4", "overlay.avi" })
  {
    record(folder / name);
    expectVideo(folder / name, { 160, 120 });
  }
  const io::SequenceMetafile metafile = io::SequenceMetafile::open(folder / "overlay.igs.mha");
  ASSERT_EQ(metafile.frameCount(), 12);
  EXPECT_FALSE(metafile.hasImages());
  EXPECT_NEAR(*metafile.frame(3).timestampSec, 100.12, 1e-9);
  EXPECT_EQ(metafile.transform(3, "ModelToCamera").transform.translation().x(), 3);
  EXPECT_EQ(metafile.transform(5, "ModelToCamera").status, io::TransformSample::Status::Invalid);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 3);
}

TEST(OverlayRecorder, OddSize_KeepsEveryPixel)
{
  const fs::path folder = freshFolder();
  record(folder / "odd.mp4", { 161, 121 });
  expectVideo(folder / "odd.mp4", { 162, 122 });
}

TEST(OverlayRecorder, WithoutClose_NothingRemains)
{
  const fs::path folder = freshFolder();
  {
    OverlayRecorder recorder(folder / "overlay.mp4");
    recorder.append(picture(0), 0, {});
  }
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST(OverlayRecorder, WhatCannotBeWritten_IsSaid)
{
  const fs::path folder = freshFolder();
  EXPECT_THROW(OverlayRecorder(folder / "overlay.png"), io::FileError);
  OverlayRecorder nowhere(folder / "no" / "such" / "folder.mp4");
  EXPECT_THROW(nowhere.append(picture(0), 0, {}), io::FileError);
  OverlayRecorder empty(folder / "empty.mp4");
  EXPECT_THROW(empty.close(), io::FileError);
}

TEST(OverlayRecorder, Nonsense_IsRefused)
{
  const fs::path folder = freshFolder();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  OverlayRecorder recorder(folder / "overlay.avi");
  EXPECT_THROW(recorder.append(cv::Mat(), 0, {}), std::invalid_argument);
  EXPECT_THROW(recorder.append(picture(0), nan, {}), std::invalid_argument);
  EXPECT_THROW(recorder.append(picture(0), 0, { { "ModelToCamera", shifted(nan) } }), std::invalid_argument);
  recorder.append(picture(0), 0, {});
  EXPECT_THROW(recorder.append(picture(0, { 80, 60 }), 1, {}), std::invalid_argument);
  OverlayRecorderOptions options;
  options.framesPerSec = 0;
  EXPECT_THROW(OverlayRecorder(folder / "overlay.avi", options), std::invalid_argument);
}

TEST(OverlayRecorder, Snapshot_HasItsTransformsBesideIt)
{
  const fs::path folder = freshFolder();
  writeOverlaySnapshot(folder / "snapshot.png", picture(1), 12.5, { { "ModelToCamera", shifted(7) } });
  EXPECT_EQ(cv::norm(cv::imread((folder / "snapshot.png").string()), picture(1), cv::NORM_INF), 0);
  const io::SequenceMetafile metafile = io::SequenceMetafile::open(folder / "snapshot.igs.mha");
  ASSERT_EQ(metafile.frameCount(), 1);
  EXPECT_EQ(metafile.transform(0, "ModelToCamera").transform.translation().x(), 7);
  EXPECT_EQ(*metafile.frame(0).timestampSec, 12.5);
}
