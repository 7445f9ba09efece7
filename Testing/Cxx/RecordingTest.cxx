// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Recording.h"

#include "ImageFile.h"
#include "IoTestSupport.h"
#include "SequenceMetafileWriter.h"

#include <opencv2/imgcodecs.hpp>

using namespace handeye::io;
using namespace handeye::io::test;

namespace
{

/// A tracking file in which the marker moves along x by one mm a frame; frame 1 is hidden.
void writeTracking(const std::filesystem::path& path, int frameCount, bool withImages = false)
{
  SequenceMetafileWriter writer(path);
  for (int i = 0; i < frameCount; ++i)
  {
    SequenceFrame frame;
    Eigen::Matrix4d markerToTracker = Eigen::Matrix4d::Identity();
    markerToTracker(0, 3) = i;
    frame.transforms["MarkerToTracker"] = { markerToTracker, i == 1 ? "INVALID" : "OK" };
    frame.timestampSec = 10 + i;
    writer.append(frame, withImages && i != 2 ? cv::Mat(4, 6, CV_8UC3, cv::Scalar(i, 20, 30)) : cv::Mat());
  }
  writer.close();
}

void writeFrame(const TemporaryFolder& folder, const std::string& name, int value)
{
  std::filesystem::create_directories(folder.path() / "frames");
  ASSERT_TRUE(cv::imwrite((folder.path() / "frames" / name).string(), cv::Mat(4, 6, CV_8UC3, cv::Scalar(value, 20, 30))));
}

}  // namespace

TEST(Recording, Folder_PairsImagesAndTransformsByIndex)
{
  const TemporaryFolder folder;
  writeTracking(folder.path() / "tracking.igs.mha", 3);
  for (int i = 0; i < 3; ++i)
  {
    writeFrame(folder, "000" + std::to_string(i) + ".png", i);
  }
  const Recording recording = Recording::open(folder.path());
  EXPECT_EQ(recording.path(), folder.path());
  ASSERT_EQ(recording.frameCount(), 3);
  EXPECT_TRUE(recording.hasImages());
  EXPECT_TRUE(recording.warnings().empty());
  EXPECT_EQ(recording.transformNames(), std::vector<std::string>{ "MarkerToTracker" });
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_EQ(recording.image(i).at<cv::Vec3b>(1, 1), cv::Vec3b(static_cast<uchar>(i), 20, 30));
    EXPECT_EQ(recording.timestampSec(i), 10.0 + i);
    const TransformSample markerToTracker = recording.transform(i, "MarkerToTracker");
    EXPECT_EQ(markerToTracker.status, i == 1 ? TransformSample::Status::Invalid : TransformSample::Status::Ok);
    EXPECT_TRUE(i == 1 || markerToTracker.transform.translation().isApprox(Eigen::Vector3d(i, 0, 0)));
  }
  EXPECT_THROW((void)recording.image(3), std::out_of_range);
  EXPECT_THROW((void)recording.transform(-1, "MarkerToTracker"), std::out_of_range);
}

TEST(Recording, Folder_KnowsAllImageEndingsAndManyDigits)
{
  const TemporaryFolder folder;
  writeTracking(folder.path() / "tracking.igs.mha", 6);
  int index = 0;
  for (const std::string name : { "0.jpg", "0001.JPG", "00002.jpeg", "3.png", "0004.bmp", "0005.tiff" })
  {
    writeFrame(folder, name, 50 + index++);
  }
  folder.write("frames/Thumbs.db", "x");
  folder.write("frames/.hidden.png", "x");
  const Recording recording = Recording::open(folder.path());
  ASSERT_EQ(recording.frameCount(), 6);
  EXPECT_TRUE(recording.warnings().empty());
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_NEAR(recording.image(i).at<cv::Vec3b>(1, 1)[0], 50 + i, 3) << i;  // jpeg is not exact
  }
}

TEST(Recording, Folder_ReportsGapsAndStrangersAmongTheImages)
{
  const TemporaryFolder folder;
  writeTracking(folder.path() / "tracking.igs.mha", 8);
  for (const std::string name : { "0001.png", "0004.png", "0005.png", "0007.png", "0007.jpg", "left.png" })
  {
    writeFrame(folder, name, 1);
  }
  const Recording recording = Recording::open(folder.path());
  EXPECT_EQ(recording.frameCount(), 8);
  EXPECT_TRUE(hasWarning(recording.warnings(), "no image 0000, 0002-0003, 0006"));
  EXPECT_TRUE(hasWarning(recording.warnings(), "frame 7 has two images"));
  EXPECT_TRUE(hasWarning(recording.warnings(), "1 images in frames/ have a name that is not a number"));
  EXPECT_FALSE(recording.hasImage(0));
  EXPECT_TRUE(recording.hasImage(1));
  expectFileError([&] { (void)recording.image(2); }, { "frames", "image of frame 2 is missing" });
}

TEST(Recording, Folder_UsesTheFramesThatHaveImageAndTracking)
{
  const TemporaryFolder folder;
  writeFrame(folder, "0000.png", 0);
  writeFrame(folder, "0001.png", 1);
  writeTracking(folder.path() / "tracking.igs.mha", 5);
  const Recording moreTracking = Recording::open(folder.path());
  EXPECT_EQ(moreTracking.frameCount(), 2);
  EXPECT_TRUE(hasWarning(moreTracking.warnings(), "the tracking frames after 1 are not used"));

  writeTracking(folder.path() / "tracking.igs.mha", 1);
  const Recording moreImages = Recording::open(folder.path());
  EXPECT_EQ(moreImages.frameCount(), 1);
  EXPECT_TRUE(hasWarning(moreImages.warnings(), "the images after 0 are not used"));
}

TEST(Recording, Folder_SaysWhichFileWasExpected)
{
  const TemporaryFolder folder;
  expectFileError([&] { (void)Recording::open(folder.path()); }, { (folder.path() / "tracking.igs.mha").string() });
  writeTracking(folder.path() / "tracking.igs.mha", 1);
  expectFileError([&] { (void)Recording::open(folder.path()); }, { (folder.path() / "frames" / "0000.jpg").string() });
  folder.write("frames/notes.txt", "x");
  expectFileError([&] { (void)Recording::open(folder.path()); }, { (folder.path() / "frames" / "0000.jpg").string() });
  expectFileError([&] { (void)Recording::open(folder.path() / "none"); }, { "none", "no such file" });
}

TEST(Recording, Folder_DamagedImageIsAnErrorOfThatFrameOnly)
{
  const TemporaryFolder folder;
  writeTracking(folder.path() / "tracking.igs.mha", 2);
  folder.write("frames/0000.jpg", "no picture");
  writeFrame(folder, "0001.jpg", 1);
  const Recording recording = Recording::open(folder.path());
  expectFileError([&] { (void)recording.image(0); }, { "0000.jpg", "not a readable image" });
  EXPECT_EQ(recording.image(1).size(), cv::Size(6, 4));
}

TEST(Recording, HugeImageNumber_DoesNotFillTheMemory)
{
  const TemporaryFolder folder;
  writeFrame(folder, "9999999.png", 1);
  writeFrame(folder, "99999999999999999999.png", 1);
  const Recording recording = Recording::openImages(folder.path());
  EXPECT_EQ(recording.frameCount(), 10000000);
  EXPECT_TRUE(recording.hasImage(9999999));
}

TEST(Recording, Metafile_HasImagesAndTransforms)
{
  const TemporaryFolder folder;
  const auto path = folder.path() / "capture.igs.mha";
  writeTracking(path, 4, true);
  const Recording recording = Recording::open(path);
  ASSERT_EQ(recording.frameCount(), 4);
  EXPECT_TRUE(recording.hasImages());
  EXPECT_EQ(recording.image(3).at<cv::Vec3b>(0, 0), cv::Vec3b(3, 20, 30));
  EXPECT_FALSE(recording.hasImage(2));
  expectFileError([&] { (void)recording.image(2); }, { "frame 2", "not valid" });
}

TEST(Recording, TransformsOnly_HasNoImages)
{
  const TemporaryFolder folder;
  writeTracking(folder.path() / "tracking.igs.mha", 2);
  writeFrame(folder, "0000.png", 1);
  const Recording recording = Recording::open(folder.path() / "tracking.igs.mha");
  EXPECT_FALSE(recording.hasImages());
  EXPECT_FALSE(recording.hasImage(0));
  EXPECT_TRUE(hasWarning(recording.warnings(), "open the folder"));
  expectFileError([&] { (void)recording.image(0); }, { "transforms only" });
  expectFileError([&] { (void)Recording::openImages(folder.path() / "tracking.igs.mha"); }, { "with images was expected" });
}

TEST(Recording, ImagesOnly_ServesLensCalibration)
{
  const TemporaryFolder folder;
  writeFrame(folder, "0000.png", 1);
  const Recording recording = Recording::openImages(folder.path());
  EXPECT_EQ(recording.frameCount(), 1);
  EXPECT_TRUE(recording.warnings().empty()) << "who asks for images needs no tracking";
  EXPECT_TRUE(recording.transformNames().empty());
  EXPECT_EQ(recording.transform(0, "MarkerToTracker").status, TransformSample::Status::Missing);
  EXPECT_FALSE(recording.timestampSec(0).has_value());
  expectFileError([&] { recording.requireTransform("MarkerToTracker"); }, { "no transforms at all" });
}

TEST(Recording, RequireTransform_ListsWhatThereIs)
{
  const Recording recording = Recording::open(std::filesystem::path(HANDEYE_TEST_DATA_DIR) / "plus_excerpt.igs.mha");
  EXPECT_NO_THROW(recording.requireTransform("StylusToTracker"));
  EXPECT_NO_THROW(recording.requireTransform("StylusToTrackerTransform"));
  expectFileError([&] { recording.requireTransform("ProbeToTrackerTransform"); },
    { "plus_excerpt.igs.mha", "'ProbeToTracker'", "ReferenceToTracker, StylusToTracker" });
}
