// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Every look: a picture against its baseline.
#include "OverlayLook.h"

#include "ImageBaseline.h"
#include "OverlayTestScene.h"

#include <gtest/gtest.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>

using handeye::OverlayLook;
using namespace handeye::test;

TEST(OverlayLook, Plain_LooksAsBefore)
{
  expectLikeBaseline(pictureOf({}), "", Threshold);
}

TEST(OverlayLook, RawBarrel_LooksAsBefore)
{
  expectLikeBaseline(pictureOf({}, barrelCamera()), "", Threshold);
}

TEST(OverlayLook, UndistortedBarrel_LooksAsBefore)
{
  OverlayLook look;
  look.undistorted = true;
  expectLikeBaseline(pictureOf(look, barrelCamera()), "", Threshold);
}

TEST(OverlayLook, Outline_LooksAsBefore)
{
  OverlayLook look;
  look.outline = true;
  expectLikeBaseline(pictureOf(look), "", Threshold);
  look.surface = false;
  expectLikeBaseline(pictureOf(look), "Alone", Threshold);
}

TEST(OverlayLook, Wireframe_LooksAsBefore)
{
  OverlayLook look;
  look.wireframe = true;
  const Pipeline pipeline = fieldPipeline();
  pipeline->SetLook(look);
  pipeline->SetModelOpacity(1);
  expectLikeBaseline(rendered(pipeline), "", 60);  // thousands of lines of a pixel's width: all of them are edges
}

TEST(OverlayLook, Clipping_LooksAsBefore)
{
  OverlayLook look;
  look.clipping = true;
  look.clippingDepth = 0.4;
  expectLikeBaseline(pictureOf(look), "", Threshold);
}

TEST(OverlayLook, Keyhole_LooksAsBefore)
{
  OverlayLook look;
  look.keyhole = true;
  look.keyholeCenter = { 0.55, 0.55 };
  look.keyholeRadius = 0.22;
  expectLikeBaseline(pictureOf(look), "", Threshold);
}

TEST(OverlayLook, Ghosting_LooksAsBefore)
{
  OverlayLook look;
  look.ghosting = true;
  const Pipeline pipeline = fieldPipeline();
  pipeline->SetLook(look);
  pipeline->SetModelOpacity(1);
  expectLikeBaseline(rendered(pipeline), "", Threshold);
}

TEST(OverlayLook, DepthColors_LooksAsBefore)
{
  OverlayLook look;
  look.depthColors = true;
  expectLikeBaseline(pictureOf(look), "", Threshold);
}

TEST(OverlayLook, ErrorHalo_LooksAsBefore)
{
  OverlayLook look;
  look.errorHalo = true;
  look.outline = true;
  const Pipeline pipeline = fieldPipeline();
  pipeline->SetLook(look);
  pipeline->SetCalibrationCovariance(shiftCovariance(1.2, 0.5));
  expectLikeBaseline(rendered(pipeline), "", Threshold);
}

TEST(OverlayLook, Stylus_LooksAsBefore)
{
  const Pipeline pipeline = fieldPipeline();
  pipeline->SetModelOpacity(1);
  holdStylus(pipeline, { 6, -4, 95 });
  expectLikeBaseline(rendered(pipeline), "InFront", Threshold);
  OverlayLook look;
  look.occlusion = false;
  pipeline->SetLook(look);
  expectLikeBaseline(rendered(pipeline), "NotHiding", Threshold);
}

TEST(OverlayLook, Faded_LooksAsBefore)
{
  const Pipeline pipeline = fieldPipeline();
  pipeline->SetFade(0.35);
  pipeline->SetNotice("the phantom is not seen, for 0.4 s");
  expectLikeBaseline(rendered(pipeline), "", Threshold);
}

TEST(OverlayLook, ResizedWindow_LooksAsBefore)
{
  const Pipeline pipeline = fieldPipeline(barrelCamera());
  OverlayLook look;
  look.outline = true;
  look.keyhole = true;
  look.keyholeRadius = 0.3;
  pipeline->SetLook(look);
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  pipeline->AttachTo(window);
  static_cast<void>(renderedWindow(window, 320, 240));
  expectLikeBaseline(renderedWindow(window, 400, 200), "", 60);  // outlines are not smoothed here
}

TEST(OverlayLook, DoubledPixelRatio_IsTheSamePictureFiner)
{
  // A window on a HiDPI screen has twice the device pixels: everything must cover twice as many, lines and halo included.
  const Pipeline pipeline = fieldPipeline();
  OverlayLook look;
  look.outline = true;
  look.outlineWidthPx = 4;
  look.errorHalo = true;
  look.keyhole = true;
  pipeline->SetLook(look);
  pipeline->SetCalibrationCovariance(shiftCovariance(1, 1));
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  pipeline->AttachTo(window);
  const cv::Mat once = renderedWindow(window, FieldWidth, FieldHeight);
  cv::Mat twice = renderedWindow(window, 2 * FieldWidth, 2 * FieldHeight);
  cv::resize(twice, twice, once.size(), 0, 0, cv::INTER_AREA);
  expectLikeBaseline(twice, "", Threshold);
  EXPECT_LT(cv::mean(difference(once, twice))[0], 3);  // grey levels; edges are smooth in the one and not in the other
}
