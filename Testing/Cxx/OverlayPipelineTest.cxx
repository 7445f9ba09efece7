// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHandEyeOverlayPipeline.h"

#include "EigenVtk.h"
#include "ImageBaseline.h"
#include "OverlayRingScene.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <vtkAppendPolyData.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkRenderWindow.h>
#include <vtkSphereSource.h>

#include <limits>
#include <stdexcept>

namespace
{

using namespace handeye::test;

vtkSmartPointer<vtkPolyData> sphere(double radius)
{
  vtkNew<vtkSphereSource> source;
  source->SetRadius(radius);
  source->SetThetaResolution(48);
  source->SetPhiResolution(48);
  source->Update();
  return source->GetOutput();
}

}  // namespace

TEST(OverlayPipeline, VideoAlone_IsUnchangedToTheLastBit)
{
  for (const cv::Size& size : { cv::Size(640, 480), cv::Size(333, 217), cv::Size(1280, 720), cv::Size(2, 3) })
  {
    const Pipeline pipeline = newPipeline();
    const cv::Mat frame = noise(size.width, size.height);
    pipeline->SetVideoFrame(frame);
    EXPECT_EQ(largestDifference(rendered(pipeline), frame), 0) << size;
  }
}

TEST(OverlayPipeline, HiddenModel_LeavesTheVideoUnchanged)
{
  const cv::Mat frame = noise(640, 480);
  const Pipeline pipeline = ringPipeline(webcam(), frame);
  pipeline->SetModelVisible(false);
  EXPECT_EQ(largestDifference(rendered(pipeline), frame), 0);
  pipeline->SetModelVisible(true);
  EXPECT_GT(largestDifference(rendered(pipeline), frame), 0);
  pipeline->SetModelOpacity(0);
  EXPECT_EQ(largestDifference(rendered(pipeline), frame), 0);
  pipeline->SetModelOpacity(1);
  pipeline->SetModel(nullptr);
  EXPECT_EQ(largestDifference(rendered(pipeline), frame), 0);
}

TEST(OverlayPipeline, AwayFromTheModel_TheVideoIsUnchanged)
{
  const cv::Mat frame = noise(720, 576);
  const Pipeline pipeline = ringPipeline(laparoscope(), frame);
  cv::Mat nearModel;
  cv::dilate(renderedMask(pipeline), nearModel, cv::Mat::ones(5, 5, CV_8U));
  for (const double opacity : { 0.3, 0.65, 1.0 })
  {
    pipeline->SetModelOpacity(opacity);
    cv::Mat difference;
    cv::absdiff(rendered(pipeline), frame, difference);
    difference.setTo(cv::Scalar::all(0), nearModel);
    EXPECT_EQ(cv::norm(difference, cv::NORM_INF), 0) << opacity;
  }
}

TEST(OverlayPipeline, GreyVideo_IsShownGrey)
{
  const Pipeline pipeline = newPipeline();
  cv::Mat grey(48, 64, CV_8UC1), expected;
  cv::randu(grey, 0, 256);
  pipeline->SetVideoFrame(grey);
  cv::cvtColor(grey, expected, cv::COLOR_GRAY2BGR);
  EXPECT_EQ(largestDifference(rendered(pipeline), expected), 0);
}

TEST(OverlayPipeline, NextFrame_ReplacesTheOneBefore)
{
  const Pipeline pipeline = newPipeline();
  pipeline->SetVideoFrame(noise(64, 48));
  static_cast<void>(rendered(pipeline));
  cv::Mat next(48, 64, CV_8UC3, cv::Scalar(1, 2, 3));
  pipeline->SetVideoFrame(next);
  next.setTo(cv::Scalar(9, 9, 9));  // the pipeline has its own copy
  EXPECT_EQ(largestDifference(rendered(pipeline), cv::Mat(48, 64, CV_8UC3, cv::Scalar(1, 2, 3))), 0);
  pipeline->SetVideoFrame(noise(96, 32));
  EXPECT_EQ(largestDifference(rendered(pipeline), noise(96, 32)), 0);

  vtkNew<vtkImageData> image;
  handeye::toVtk(noise(64, 48), image);
  pipeline->SetVideoImage(image);
  EXPECT_EQ(largestDifference(rendered(pipeline), noise(64, 48)), 0);
  handeye::toVtk(next, image);
  EXPECT_EQ(largestDifference(rendered(pipeline), next), 0);
}

TEST(OverlayPipeline, Mask_IsBlackAndWhiteWhateverTheLook)
{
  const Pipeline pipeline = ringPipeline(laparoscope(), noise(720, 576));
  const cv::Mat mask = renderedMask(pipeline);
  EXPECT_EQ(cv::countNonZero(mask == 255) + cv::countNonZero(mask == 0), 720 * 576);
  EXPECT_GT(cv::countNonZero(mask), 10000);
  pipeline->SetModelOpacity(0.01);
  pipeline->SetModelColor(0.2, 0, 0.9);
  EXPECT_EQ(largestDifference(renderedMask(pipeline), mask), 0);
  pipeline->SetModelOpacity(0);
  EXPECT_EQ(largestDifference(renderedMask(pipeline), mask), 0);
  pipeline->SetModelVisible(false);
  EXPECT_EQ(cv::countNonZero(renderedMask(pipeline)), 0);
}

TEST(OverlayPipeline, Mask_IsWhereThePictureChanges)
{
  const cv::Mat frame(576, 720, CV_8UC3, cv::Scalar(255, 0, 0));
  const Pipeline pipeline = ringPipeline(laparoscope(), frame);
  pipeline->SetModelOpacity(1);
  cv::Mat difference, changed, disagreement;
  cv::absdiff(rendered(pipeline), frame, difference);
  cv::cvtColor(difference, difference, cv::COLOR_BGR2GRAY);
  changed = difference > 0;
  const cv::Mat mask = renderedMask(pipeline);
  cv::Mat core, hull;
  cv::erode(mask, core, cv::Mat::ones(3, 3, CV_8U));
  cv::dilate(mask, hull, cv::Mat::ones(3, 3, CV_8U));
  EXPECT_EQ(cv::countNonZero(core & ~changed), 0);
  EXPECT_EQ(cv::countNonZero(changed & ~hull), 0);
}

TEST(OverlayPipeline, WhatIsBehindTheForemostSurface_IsNotSeen)
{
  const cv::Mat frame = scene(640, 480);
  const Pipeline pipeline = newPipeline();
  pipeline->SetCameraModel(webcam());
  pipeline->SetVideoFrame(frame);
  pipeline->SetModelToCamera(handeye::toVtk(tiltedModelToCamera(5, 5, 250)));
  pipeline->SetModel(sphere(40));
  const cv::Mat outerAlone = rendered(pipeline);
  vtkNew<vtkAppendPolyData> both;
  both->AddInputData(sphere(20));
  both->AddInputData(sphere(40));
  both->AddInputData(sphere(30));
  both->Update();
  pipeline->SetModel(both->GetOutput());
  EXPECT_LE(largestDifference(rendered(pipeline), outerAlone), 1);
}

TEST(OverlayPipeline, HalfOpacity_IsBetweenVideoAndModel)
{
  const Pipeline pipeline = newPipeline();
  pipeline->SetCameraModel(webcam());
  pipeline->SetVideoFrame(cv::Mat(480, 640, CV_8UC3, cv::Scalar(200, 0, 0)));
  pipeline->SetModel(sphere(40));
  pipeline->SetModelToCamera(handeye::toVtk(tiltedModelToCamera(0, 0, 250)));
  const cv::Point middle(316, 245);
  pipeline->SetModelOpacity(1);
  const cv::Vec3b opaque = rendered(pipeline).at<cv::Vec3b>(middle);
  pipeline->SetModelOpacity(0.5);
  const cv::Vec3b half = rendered(pipeline).at<cv::Vec3b>(middle);
  EXPECT_NEAR(half[0], (opaque[0] + 200) / 2.0, 2);
  EXPECT_NEAR(half[1], opaque[1] / 2.0, 2);
  EXPECT_NEAR(half[2], opaque[2] / 2.0, 2);
}

TEST(OverlayPipeline, OtherSizeOfVideo_ShowsNoModelAndSaysWhy)
{
  const cv::Mat frame = noise(320, 240);
  const Pipeline pipeline = ringPipeline(webcam(), frame);
  EXPECT_EQ(pipeline->GetProblem(), "the video is 320 x 240 px, but the camera was calibrated for 640 x 480 px");
  cv::Mat picture;
  EXPECT_THROW(pipeline->RenderToImage(picture), std::runtime_error);
  vtkNew<vtkRenderWindow> window;
  pipeline->AttachTo(window);
  EXPECT_EQ(largestDifference(renderedWindow(window, 320, 240), frame), 0);
  pipeline->SetVideoFrame(noise(640, 480));
  EXPECT_EQ(pipeline->GetProblem(), "");
  EXPECT_GT(largestDifference(rendered(pipeline), noise(640, 480)), 0);
}

TEST(OverlayPipeline, NoCamera_ShowsNoModelAndSaysWhy)
{
  const Pipeline pipeline = newPipeline();
  cv::Mat picture;
  EXPECT_THROW(pipeline->RenderToImage(picture), std::runtime_error);
  pipeline->SetVideoFrame(noise(64, 48));
  pipeline->SetModel(ring());
  EXPECT_NE(pipeline->GetProblem().find("no camera"), std::string::npos);
  EXPECT_THROW(pipeline->RenderToImage(picture), std::runtime_error);
}

TEST(OverlayPipeline, CameraWithoutSize_TakesTheVideos)
{
  const handeye::CameraModel known = webcam();
  const Pipeline pipeline = ringPipeline(known, scene(640, 480));
  const cv::Mat expected = rendered(pipeline);
  pipeline->SetCameraModel(handeye::CameraModel(0, 0, known.cameraMatrix(), known.distortionCoefficients()));
  EXPECT_EQ(pipeline->GetProblem(), "");
  EXPECT_EQ(largestDifference(rendered(pipeline), expected), 0);
  pipeline->SetVideoFrame(cv::Mat());
  EXPECT_NE(pipeline->GetProblem(), "");
}

TEST(OverlayPipeline, WithoutVideo_TheModelIsOnBlack)
{
  const Pipeline pipeline = ringPipeline(webcam(), scene(640, 480));
  const cv::Mat mask = renderedMask(pipeline);
  pipeline->SetVideoFrame(cv::Mat());
  cv::Mat picture = rendered(pipeline);
  ASSERT_EQ(picture.size(), cv::Size(640, 480));
  EXPECT_GT(cv::norm(picture, cv::NORM_L1), 0);
  cv::Mat hull;
  cv::dilate(mask, hull, cv::Mat::ones(3, 3, CV_8U));
  picture.setTo(cv::Scalar::all(0), hull);
  EXPECT_EQ(cv::norm(picture, cv::NORM_INF), 0);
}

TEST(OverlayPipeline, Nonsense_IsRefused)
{
  const Pipeline pipeline = newPipeline();
  EXPECT_THROW(pipeline->SetVideoFrame(cv::Mat(4, 4, CV_32FC3)), std::invalid_argument);
  EXPECT_THROW(pipeline->SetModelToCamera(nullptr), std::invalid_argument);
  vtkNew<vtkMatrix4x4> matrix;
  matrix->SetElement(0, 3, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(pipeline->SetModelToCamera(matrix), std::invalid_argument);
  EXPECT_THROW(pipeline->SetNearestDistanceMm(0), std::invalid_argument);
  vtkNew<vtkPolyData> nothing;
  pipeline->SetCameraModel(webcam());
  pipeline->SetModel(nothing);
  EXPECT_EQ(cv::norm(rendered(pipeline), cv::NORM_INF), 0);
  vtkNew<vtkImageData> noPixels;
  pipeline->SetVideoImage(noPixels);
  vtkNew<vtkRenderWindow> window;
  pipeline->AttachTo(window);
  EXPECT_EQ(cv::norm(renderedWindow(window, 100, 80), cv::NORM_INF), 0);
}

TEST(OverlayPipeline, Webcam_LooksAsBefore)
{
  // Averaged differences of edge pixels: another Mesa moves shading by a grey level or two, a fault moves hundreds of pixels.
  expectLikeBaseline(rendered(ringPipeline(webcam(), scene(640, 480))), "", 40);
}

TEST(OverlayPipeline, Laparoscope_LooksAsBefore)
{
  const Pipeline pipeline = ringPipeline(laparoscope(), scene(720, 576));
  // Reaches over the border, where the lens bends most.
  pipeline->SetModelToCamera(handeye::toVtk(tiltedModelToCamera(40, 25, 150)));
  expectLikeBaseline(rendered(pipeline), "", 40);  // see above
}

TEST(OverlayPipeline, OpaqueInWindow_LooksAsBefore)
{
  const Pipeline pipeline = ringPipeline(laparoscope(), scene(720, 576));
  pipeline->SetModelOpacity(1);
  pipeline->SetModelColor(0.4, 0.75, 0.95);
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  pipeline->AttachTo(window);
  expectLikeBaseline(renderedWindow(window, 500, 600), "", 60);  // see above; the outlines are not smoothed here
}
