// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the overlay draws a point is compared with plain arithmetic (OverlayOracle.h).
#include "OverlayOracle.h"
#include "ImageBaseline.h"
#include "OverlayMarkers.h"

#include <gtest/gtest.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>
#include <vector>

namespace
{

using namespace handeye::test;

constexpr double MarkerRadiusPx = 5;

class OverlayOracle : public testing::TestWithParam<Lens>
{
};

}  // namespace

TEST_P(OverlayOracle, Markers_AreWhereArithmeticPutsThem)
{
  const Lens lens = GetParam();
  const MarkerField field = markers(lens, MarkerRadiusPx);
  ASSERT_GT(field.expected_Image.size(), 90u);
  cv::Mat picture;
  maskPipeline(lens, field.mesh)->RenderToImage(picture);
  ASSERT_EQ(picture.size(), cv::Size(lens.width, lens.height));
  const Deviation off = deviation(grey(picture), field.expected_Image);
  std::cout << lens.name << ": " << field.expected_Image.size() << " markers, mean " << off.meanPx << " px, max " << off.maxPx
            << " px\n";
  // The centroid of a disc that consists of 80 whole pixels scatters by about 0.1 px; the test below looks closer.
  EXPECT_LT(off.meanPx, 0.12);
  EXPECT_LT(off.maxPx, 0.4);
}

TEST_P(OverlayOracle, MarkersMagnified_AreWhereArithmeticPutsThem)
{
  // Six window pixels for one of the video: what is left of the deviation is the lens' bending of a disc of 3 px, and our error.
  constexpr int magnification = 6;
  const Lens lens = GetParam();
  const MarkerField field = markers(lens, 3);
  const auto pipeline = maskPipeline(lens, field.mesh);
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  pipeline->AttachTo(window);
  const cv::Mat mask = grey(renderedWindow(window, magnification * lens.width, magnification * lens.height));
  std::vector<Eigen::Vector2d> expected_Window;
  for (const Eigen::Vector2d& point : field.expected_Image)
  {
    expected_Window.emplace_back(magnification * (point.array() + 0.5) - 0.5);
  }
  const Deviation off = deviation(mask, expected_Window);
  std::cout << lens.name << ": " << field.expected_Image.size() << " markers, mean " << off.meanPx / magnification << " px, max "
            << off.maxPx / magnification << " px of the video\n";
  EXPECT_LT(off.meanPx / magnification, 0.02);
  EXPECT_LT(off.maxPx / magnification, 0.05);
}

TEST_P(OverlayOracle, Windows_OfAnySizeAndAspect_KeepTheMarkersInPlace)
{
  const Lens lens = GetParam();
  const MarkerField field = markers(lens, lens.width > 700 ? 9 : 6);  // large enough for a small window
  const auto pipeline = maskPipeline(lens, field.mesh);
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  pipeline->AttachTo(window);
  for (const auto& [width, height] : { std::pair(500, 900), std::pair(1280, 720), std::pair(431, 1201), std::pair(2000, 1001) })
  {
    const cv::Mat mask = grey(renderedWindow(window, width, height));
    const double scale = std::min(double(width) / lens.width, double(height) / lens.height);
    const int pictureWidth = int(std::lround(lens.width * scale)), pictureHeight = int(std::lround(lens.height * scale));
    const int left = (width - pictureWidth) / 2, top = height - pictureHeight - (height - pictureHeight) / 2;
    std::vector<Eigen::Vector2d> expected_Window;
    for (const Eigen::Vector2d& point : field.expected_Image)
    {
      expected_Window.emplace_back(
        left + (point.x() + 0.5) / lens.width * pictureWidth - 0.5, top + (point.y() + 0.5) / lens.height * pictureHeight - 0.5);
    }
    const Deviation off = deviation(mask, expected_Window);
    // In px of the window: again the whole pixels that a disc consists of, fewer in a small window.
    EXPECT_LT(off.meanPx, 0.2) << width << " x " << height;
    EXPECT_LT(off.maxPx, 0.6) << width << " x " << height;

    double point_Image[2], point_Display[2];
    const double point_Window[2] = { expected_Window[7].x(), height - 1 - expected_Window[7].y() };
    ASSERT_TRUE(pipeline->DisplayToImage(point_Window, point_Image));
    EXPECT_NEAR(point_Image[0], field.expected_Image[7].x(), 1e-9);
    EXPECT_NEAR(point_Image[1], field.expected_Image[7].y(), 1e-9);
    ASSERT_TRUE(pipeline->ImageToDisplay(point_Image, point_Display));
    EXPECT_NEAR(point_Display[0], point_Window[0], 1e-9);
    EXPECT_NEAR(point_Display[1], point_Window[1], 1e-9);
  }
}

TEST_P(OverlayOracle, FiveHundredMarkers_AreWhereArithmeticPutsThem_BothWays)
{
  // 25 x 20 over the whole picture, through the anti-aliased picture itself and not through a mask.
  const Lens lens = GetParam();
  for (const bool undistorted : { false, true })
  {
    const Lens shown = undistorted ? straightened(lens) : lens;
    // Within 0.92 of the radius where the lens model ends: beyond, a marker is squeezed to less than a pixel's width.
    const MarkerField field = markers(shown, 4, 25, 20, 0.92 / 0.97 * lens.foldRadius());
    ASSERT_GT(field.expected_Image.size(), lens.name == "Wide" || lens.name == "StrongBarrel" ? 400u : 499u);
    const auto pipeline = maskPipeline(lens, field.mesh);
    pipeline->SetMaskMode(false);
    pipeline->SetModelOpacity(1);
    pipeline->SetVideoFrame(cv::Mat(lens.height, lens.width, CV_8UC3, cv::Scalar(0, 0, 0)));
    handeye::OverlayLook look;
    look.undistorted = undistorted;
    pipeline->SetLook(look);
    cv::Mat picture;
    pipeline->RenderToImage(picture);
    const Deviation off = weightedDeviation(grey(picture), field.expected_Image);
    std::cout << lens.name << (undistorted ? ", undistorted video: " : ", raw video: ") << field.expected_Image.size()
              << " markers, mean " << off.meanPx << " px, max " << off.maxPx << " px\n";
    EXPECT_LT(off.meanPx, 0.1);
    EXPECT_LT(off.maxPx, 0.3);
  }
}

TEST_P(OverlayOracle, UndistortedVideo_ShowsWhatTheLensSawThere)
{
  // Blurred dots in the raw video, drawn with plain arithmetic, are to be found where a pinhole camera would see them: what fits
  // the model in the undistorted picture must be the video as well.
  const Lens lens = GetParam();
  cv::Mat raw(lens.height, lens.width, CV_8UC3, cv::Scalar(0, 0, 0));
  std::vector<Eigen::Vector2d> expected;
  constexpr int columns = 25, rows = 20;
  for (int i = 0; i < columns * rows; ++i)
  {
    const Eigen::Vector2d wanted(
      12 + (lens.width - 25.0) * (i % columns) / (columns - 1), 12 + (lens.height - 25.0) * int(i / columns) / (rows - 1));
    Eigen::Vector2d seen;
    if (straightened(lens).seenAt(wanted, seen) && seen.norm() < 0.97 * lens.foldRadius())
    {
      const Eigen::Vector2d dot = lens.pixel(seen.x(), seen.y());
      if (dot.x() > 8 && dot.y() > 8 && dot.x() < lens.width - 9 && dot.y() < lens.height - 9)
      {
        drawDot(raw, dot);
        expected.push_back(wanted);
      }
    }
  }
  ASSERT_GT(expected.size(), 350u);
  vtkNew<vtkPolyData> nothing;
  const auto pipeline = maskPipeline(lens, nothing);
  pipeline->SetMaskMode(false);
  pipeline->SetVideoFrame(raw);
  handeye::OverlayLook look;
  look.undistorted = true;
  pipeline->SetLook(look);
  cv::Mat picture;
  pipeline->RenderToImage(picture);
  const Deviation off = weightedDeviation(grey(picture), expected);
  std::cout << lens.name << ", undistorted video: " << expected.size() << " dots of the video, mean " << off.meanPx << " px, max "
            << off.maxPx << " px\n";
  EXPECT_LT(off.meanPx, 0.05);
  EXPECT_LT(off.maxPx, 0.3);
}

TEST_P(OverlayOracle, UndistortedWindow_KnowsThePixelsOfTheRecordedVideo)
{
  const Lens lens = GetParam();
  vtkNew<vtkPolyData> nothing;
  const auto pipeline = maskPipeline(lens, nothing);
  handeye::OverlayLook look;
  look.undistorted = true;
  pipeline->SetLook(look);
  vtkNew<vtkRenderWindow> window;
  pipeline->AttachTo(window);
  window->SetSize(lens.width, lens.height);
  window->Render();
  const double x = 0.21, y = -0.17;
  const double display[2] = { lens.fx * x + lens.cx, lens.height - 1 - (lens.fy * y + lens.cy) };
  double image[2], back[2];
  ASSERT_TRUE(pipeline->DisplayToImage(display, image));
  EXPECT_NEAR(image[0], lens.pixel(x, y).x(), 1e-9);
  EXPECT_NEAR(image[1], lens.pixel(x, y).y(), 1e-9);
  ASSERT_TRUE(pipeline->ImageToDisplay(image, back));
  EXPECT_NEAR(back[0], display[0], 1e-6);
  EXPECT_NEAR(back[1], display[1], 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Lenses, OverlayOracle, testing::ValuesIn(allLenses), [](const auto& lens) { return lens.param.name; });
