// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ImageBaseline.h"
#include "OverlayTestScene.h"
#include "vtkHandEyeStereoOverlay.h"

#include <gtest/gtest.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRendererCollection.h>

#include <stdexcept>
#include <utility>
#include <vector>

namespace
{

using namespace handeye::test;
using Layout = vtkHandEyeStereoOverlay::Layout;
using Stereo = vtkSmartPointer<vtkHandEyeStereoOverlay>;

handeye::CameraModel rightCamera()
{
  Eigen::Matrix3d matrix;
  matrix << 306, 0, 161.7, 0, 305, 118.1, 0, 0, 1;
  return handeye::CameraModel(FieldWidth, FieldHeight, matrix, { -0.3, 0.05, 0, 0 });
}

cv::Mat rightVideo()
{
  cv::Mat video;
  cv::flip(fieldVideo(), video, 1);
  return video;
}

/// Another lens, another video and another hand-eye for each eye.
void setEye(vtkHandEyeOverlayPipeline* eye, bool right)
{
  eye->SetCameraModel(right ? rightCamera() : fieldCamera());
  eye->SetVideoFrame(right ? rightVideo() : fieldVideo());
  eye->SetModel(handeye::readMesh(std::string(HANDEYE_RESOURCES_DIR) + "/Meshes/Vertebra.ply"));
  Eigen::Isometry3d modelToEye = fieldModelToCamera();
  modelToEye.translation().x() -= right ? 6 : 0;
  eye->SetModelToCamera(handeye::toVtk(modelToEye));
}

Stereo fieldStereo(Layout layout)
{
  handeye::registerOffscreenRendering();
  Stereo stereo = Stereo::New();
  setEye(stereo->GetLeft(), false);
  setEye(stereo->GetRight(), true);
  stereo->SetLayout(layout);
  return stereo;
}

/// What one eye shows by itself.
cv::Mat eyePicture(bool right)
{
  const Pipeline eye = fieldPipeline();
  setEye(eye, right);
  return handeye::test::rendered(eye);
}

/// Pixels that differ by more than rounding: places in a window are rounded differently in another part of it, on few edge pixels.
int differentPixels(const cv::Mat& a, const cv::Mat& b)
{
  cv::Mat difference;
  cv::absdiff(a, b, difference);
  return cv::countNonZero(difference.reshape(1) > 2);
}

cv::Mat pictureOf(const Stereo& stereo)
{
  cv::Mat picture;
  stereo->RenderToImage(picture);
  return picture;
}

}  // namespace

TEST(StereoOverlay, SideBySide_IsBothEyesBesideEachOther)
{
  const cv::Mat picture = pictureOf(fieldStereo(Layout::SideBySide));
  ASSERT_EQ(picture.size(), cv::Size(2 * FieldWidth, FieldHeight));
  EXPECT_LE(differentPixels(picture.colRange(0, FieldWidth), eyePicture(false)), 30);
  EXPECT_LE(differentPixels(picture.colRange(FieldWidth, 2 * FieldWidth), eyePicture(true)), 30);
  cv::Mat half;
  cv::resize(picture, half, {}, 0.5, 0.5, cv::INTER_AREA);
  expectLikeBaseline(half, "", Threshold);
}

TEST(StereoOverlay, TopBottom_IsTheLeftEyeAboveTheRight)
{
  const cv::Mat picture = pictureOf(fieldStereo(Layout::TopBottom));
  ASSERT_EQ(picture.size(), cv::Size(FieldWidth, 2 * FieldHeight));
  EXPECT_LE(differentPixels(picture.rowRange(0, FieldHeight), eyePicture(false)), 30);
  EXPECT_LE(differentPixels(picture.rowRange(FieldHeight, 2 * FieldHeight), eyePicture(true)), 30);
  cv::Mat half;
  cv::resize(picture, half, {}, 0.5, 0.5, cv::INTER_AREA);
  expectLikeBaseline(half, "", Threshold);
}

TEST(StereoOverlay, Interlaced_GivesEachEyeItsRows)
{
  for (const bool swapped : { false, true })
  {
    const Stereo stereo = fieldStereo(Layout::Interlaced);
    stereo->SetSwapped(swapped);
    stereo->GetLeft()->SetModelVisible(false);
    stereo->GetRight()->SetModelVisible(false);
    const cv::Mat picture = pictureOf(stereo);
    ASSERT_EQ(picture.size(), cv::Size(FieldWidth, FieldHeight));
    for (int row = 0; row < picture.rows; ++row)
    {
      const bool left = (row % 2 == 0) != swapped;
      ASSERT_EQ(largestDifference(picture.row(row), (left ? fieldVideo() : rightVideo()).row(row)), 0) << row;
    }
  }
}

TEST(StereoOverlay, Interlaced_WithOutlines_LooksAsBefore)
{
  const Stereo stereo = fieldStereo(Layout::Interlaced);
  EXPECT_TRUE(stereo->HandleKey('o'));
  const cv::Mat picture = pictureOf(stereo);
  expectLikeBaseline(picture, "", 60);  // outlines are not smoothed in rows
  // The rows of an eye hold nothing of the other one: without the right eye's model they stay as they are.
  stereo->GetRight()->SetModelVisible(false);
  const cv::Mat leftAlone = pictureOf(stereo);
  for (int row = 0; row < picture.rows; row += 2)
  {
    ASSERT_EQ(largestDifference(picture.row(row), leftAlone.row(row)), 0) << row;
  }
}

TEST(StereoOverlay, Anaglyph_HasTheLeftEyeInRedAndTheRightInCyan)
{
  const cv::Mat picture = pictureOf(fieldStereo(Layout::Anaglyph));
  cv::Mat left, channels[3], right[3];
  cv::cvtColor(eyePicture(false), left, cv::COLOR_BGR2GRAY);
  cv::split(picture, channels);
  cv::split(eyePicture(true), right);
  EXPECT_LE(cv::norm(channels[2], left, cv::NORM_INF), 3);
  EXPECT_LE(cv::norm(channels[1], right[1], cv::NORM_INF), 1);
  EXPECT_LE(cv::norm(channels[0], right[0], cv::NORM_INF), 1);
  expectLikeBaseline(picture, "", Threshold);
}

TEST(StereoOverlay, Squeezed_FillsHalvesOfTheWindow)
{
  const Stereo stereo = fieldStereo(Layout::SideBySide);
  stereo->SetSqueezed(true);
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  stereo->AttachTo(window);
  const cv::Mat picture = renderedWindow(window, 2 * FieldWidth, 2 * FieldHeight);
  cv::Mat left, right;
  cv::resize(picture.colRange(0, FieldWidth), left, { FieldWidth, FieldHeight }, 0, 0, cv::INTER_AREA);
  cv::resize(picture.colRange(FieldWidth, 2 * FieldWidth), right, { FieldWidth, FieldHeight }, 0, 0, cv::INTER_AREA);
  EXPECT_LT(cv::norm(left, eyePicture(false), cv::NORM_L1) / double(3 * left.total()), 2);
  EXPECT_LT(cv::norm(right, eyePicture(true), cv::NORM_L1) / double(3 * right.total()), 2);
  stereo->AttachTo(nullptr);
  EXPECT_EQ(window->GetRenderers()->GetNumberOfItems(), 0);
}

TEST(StereoOverlay, ReadShown_IsThePictureOfTheLayout)
{
  const std::vector<std::pair<Layout, cv::Size>> windows{ { Layout::SideBySide, { 4 * FieldWidth, 2 * FieldHeight + 30 } },
    { Layout::TopBottom, { 2 * FieldWidth + 10, 4 * FieldHeight } }, { Layout::Anaglyph, { 2 * FieldWidth + 10, 2 * FieldHeight } },
    { Layout::Interlaced, { FieldWidth, FieldHeight } } };
  for (const bool swapped : { false, true })
  {
    for (const auto& [layout, size] : windows)
    {
      const Stereo stereo = fieldStereo(layout);
      stereo->SetSwapped(swapped);
      vtkNew<vtkRenderWindow> window;
      window->SetMultiSamples(0);
      stereo->AttachTo(window);
      cv::Mat shown;
      EXPECT_FALSE(stereo->ReadShown(shown));
      static_cast<void>(renderedWindow(window, size.width, size.height));
      ASSERT_TRUE(stereo->ReadShown(shown));
      const cv::Mat picture = pictureOf(stereo);
      ASSERT_EQ(shown.size(), picture.size()) << int(layout);
      EXPECT_LE(differentPixels(shown, picture), 60) << int(layout) << swapped;
    }
  }
}

TEST(StereoOverlay, Keys_ChangeLayoutAndEyes)
{
  const Stereo stereo = fieldStereo(Layout::Interlaced);
  EXPECT_TRUE(stereo->HandleKey('S'));
  EXPECT_EQ(stereo->GetLayout(), Layout::Anaglyph);
  EXPECT_TRUE(stereo->HandleKey('s'));
  EXPECT_EQ(stereo->GetLayout(), Layout::SideBySide);
  EXPECT_TRUE(stereo->HandleKey('e'));
  EXPECT_TRUE(stereo->GetSwapped());
  EXPECT_TRUE(stereo->HandleKey('k'));
  EXPECT_TRUE(stereo->GetLeft()->GetLook().keyhole);
  EXPECT_TRUE(stereo->GetRight()->GetLook().keyhole);
  EXPECT_FALSE(stereo->HandleKey('#'));
}

TEST(StereoOverlay, EyeWithoutACamera_IsNamed)
{
  const Stereo stereo = fieldStereo(Layout::SideBySide);
  stereo->GetRight()->SetVideoFrame(cv::Mat(10, 10, CV_8UC3, cv::Scalar(0, 0, 0)));
  EXPECT_EQ(stereo->GetProblem().rfind("right eye: the video is 10 x 10 px", 0), 0u) << stereo->GetProblem();
  cv::Mat picture;
  EXPECT_THROW(stereo->RenderToImage(picture), std::runtime_error);
}
