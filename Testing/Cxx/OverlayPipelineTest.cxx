// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraModel.h"
#include "EigenVtk.h"
#include "ImageBaseline.h"
#include "OffscreenRendering.h"
#include "OverlayMesh.h"
#include "vtkHandEyeOverlayPipeline.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <vtkAppendPolyData.h>
#include <vtkCellArray.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRenderWindow.h>
#include <vtkRendererCollection.h>
#include <vtkReverseSense.h>
#include <vtkSphereSource.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace
{

using handeye::test::expectLikeBaseline;
using handeye::test::largestDifference;
using handeye::test::renderedWindow;
using Pipeline = vtkSmartPointer<vtkHandEyeOverlayPipeline>;

Eigen::Matrix3d matrixOf(double fx, double fy, double cx, double cy)
{
  Eigen::Matrix3d matrix;
  matrix << fx, 0, cx, 0, fy, cy, 0, 0, 1;
  return matrix;
}

handeye::CameraModel webcam()
{
  return handeye::CameraModel(640, 480, matrixOf(601.7, 602.9, 316.2, 244.8), { 0.041, -0.112, -0.0007, 0.0011, 0.02 });
}

handeye::CameraModel laparoscope()
{
  return handeye::CameraModel(720, 576, matrixOf(812.3, 826, 366.9, 281.4), { -0.251, 0.094, 0.0008, -0.001, 0.011 });
}

vtkSmartPointer<vtkPolyData> sphere(double radius)
{
  vtkNew<vtkSphereSource> source;
  source->SetRadius(radius);
  source->SetThetaResolution(48);
  source->SetPhiResolution(48);
  source->Update();
  return source->GetOutput();
}

/// A thick ring with rounded edges: something with a hole, edges, and surfaces behind surfaces.
vtkSmartPointer<vtkPolyData> ring()
{
  constexpr int around = 80, across = 48;
  constexpr double ringRadius = 30, sectionRadius = 14;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> faces;
  for (int i = 0; i < around; ++i)
  {
    for (int j = 0; j < across; ++j)
    {
      const double turn = 2 * M_PI * i / around, section = 2 * M_PI * j / across;
      const double c = std::cos(section), s = std::sin(section);
      const double radius = sectionRadius / std::pow(std::pow(c, 4) + std::pow(s, 4), 0.25);
      const double outward = ringRadius + radius * c;
      points->InsertNextPoint(outward * std::cos(turn), outward * std::sin(turn), radius * s);
      const vtkIdType nextI = (i + 1) % around, nextJ = (j + 1) % across;
      faces->InsertNextCell({ i * across + j, nextI * across + j, nextI * across + nextJ, i * across + nextJ });
    }
  }
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(points);
  mesh->SetPolys(faces);
  return mesh;
}

Eigen::Isometry3d pose(double x, double y, double z)
{
  Eigen::Isometry3d modelToCamera = Eigen::Isometry3d::Identity();
  modelToCamera.linear() = Eigen::AngleAxisd(-0.9, Eigen::Vector3d(1, 0.4, 0.2).normalized()).toRotationMatrix();
  modelToCamera.translation() << x, y, z;
  return modelToCamera;
}

cv::Mat noise(int width, int height)
{
  cv::Mat frame(height, width, CV_8UC3);
  cv::RNG(7).fill(frame, cv::RNG::UNIFORM, 0, 256);
  return frame;
}

/// Something like an operating field: a soft colour gradient with a few shapes.
cv::Mat scene(int width, int height)
{
  cv::Mat frame(height, width, CV_8UC3);
  for (int v = 0; v < height; ++v)
  {
    for (int u = 0; u < width; ++u)
    {
      frame.at<cv::Vec3b>(v, u) =
        cv::Vec3b(uchar(90 + 60 * v / height), uchar(70 + 40 * u / width), uchar(30 + 30 * (u + v) / (width + height)));
    }
  }
  cv::circle(frame, { width / 4, height / 4 }, height / 9, { 40, 40, 210 }, cv::FILLED);
  cv::rectangle(frame, cv::Rect(width * 5 / 8, height * 5 / 8, width / 5, height / 5), { 60, 170, 60 }, cv::FILLED);
  cv::ellipse(frame, { width * 3 / 4, height / 3 }, { width / 8, height / 12 }, 30, 0, 360, { 150, 160, 220 }, cv::FILLED);
  return frame;
}

Pipeline newPipeline()
{
  handeye::registerOffscreenRendering();
  return Pipeline::New();
}

Pipeline ringPipeline(const handeye::CameraModel& camera, const cv::Mat& frame)
{
  Pipeline pipeline = newPipeline();
  pipeline->SetCameraModel(camera);
  pipeline->SetVideoFrame(frame);
  pipeline->SetModel(ring());
  pipeline->SetModelToCamera(handeye::toVtk(pose(15, -8, 190)));
  return pipeline;
}

cv::Mat rendered(const Pipeline& pipeline)
{
  cv::Mat picture;
  pipeline->RenderToImage(picture);
  return picture;
}

cv::Mat renderedMask(const Pipeline& pipeline)
{
  pipeline->SetMaskMode(true);
  cv::Mat mask;
  cv::cvtColor(rendered(pipeline), mask, cv::COLOR_BGR2GRAY);
  pipeline->SetMaskMode(false);
  return mask;
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

TEST(OverlayPipeline, ReadShown_HasTheVideosPixelsWhateverTheWindowsSize)
{
  const cv::Mat frame = noise(640, 480);
  const Pipeline pipeline = ringPipeline(webcam(), frame);
  cv::Mat shown;
  EXPECT_FALSE(pipeline->ReadShown(shown));
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  pipeline->AttachTo(window);
  pipeline->SetModelVisible(false);
  // Bars at both sides, and two by two pixels for each of the video.
  static_cast<void>(renderedWindow(window, 1402, 960));
  ASSERT_TRUE(pipeline->ReadShown(shown));
  EXPECT_EQ(largestDifference(shown, frame), 0);
  const cv::Mat before = shown;
  pipeline->SetModelVisible(true);
  static_cast<void>(renderedWindow(window, 1402, 960));
  ASSERT_TRUE(pipeline->ReadShown(shown));
  EXPECT_LE(largestDifference(shown, rendered(pipeline)), 1);
  EXPECT_EQ(largestDifference(before, frame), 0) << "what was read stays as it was";
  // A window that is smaller than the video has less to give, but in the video's pixels.
  static_cast<void>(renderedWindow(window, 400, 500));
  ASSERT_TRUE(pipeline->ReadShown(shown));
  EXPECT_EQ(shown.size(), frame.size());
}

TEST(OverlayPipeline, ClosedSurface_IsTold)
{
  const auto ball = [](double x)
  {
    vtkNew<vtkSphereSource> source;
    source->SetCenter(x, 0, 0);
    source->Update();
    return handeye::triangulatedWithNormals(source->GetOutput());
  };
  const auto both = [](vtkPolyData* a, vtkPolyData* b)
  {
    vtkNew<vtkAppendPolyData> append;
    append->AddInputData(a);
    append->AddInputData(b);
    append->Update();
    return vtkSmartPointer<vtkPolyData>(append->GetOutput());
  };
  vtkNew<vtkReverseSense> insideOut;
  insideOut->SetInputData(ball(3));
  insideOut->Update();
  vtkNew<vtkPolyData> open;
  open->DeepCopy(ball(0));
  open->BuildCells();
  open->DeleteCell(0);
  open->RemoveDeletedCells();
  EXPECT_TRUE(handeye::isClosedSurface(ball(0)));
  EXPECT_TRUE(handeye::isClosedSurface(both(ball(0), ball(3))));
  EXPECT_FALSE(handeye::isClosedSurface(open));
  EXPECT_FALSE(handeye::isClosedSurface(insideOut->GetOutput()));
  EXPECT_FALSE(handeye::isClosedSurface(both(ball(0), insideOut->GetOutput()))) << "one part of it is inside out";
  EXPECT_FALSE(handeye::isClosedSurface(vtkSmartPointer<vtkPolyData>::New()));
}

TEST(OverlayPipeline, HalfThatCannotBeSeen_IsLeftOutUnseen)
{
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(40);
  ball->SetThetaResolution(60);
  ball->SetPhiResolution(60);
  ball->Update();
  // The same ball, but open at a place that is not seen: all of it is drawn.
  vtkNew<vtkSphereSource> openBall;
  openBall->SetRadius(40);
  openBall->SetThetaResolution(60);
  openBall->SetPhiResolution(60);
  openBall->Update();
  vtkSmartPointer<vtkPolyData> open = handeye::triangulatedWithNormals(openBall->GetOutput());
  ASSERT_TRUE(handeye::isClosedSurface(open));
  vtkIdType furthest = 0;
  double z = -1e9;
  for (vtkIdType cell = 0; cell < open->GetNumberOfCells(); ++cell)
  {
    double bounds[6];
    open->GetCellBounds(cell, bounds);
    furthest = bounds[4] > z ? cell : furthest;
    z = std::max(z, bounds[4]);
  }
  open->BuildCells();
  open->DeleteCell(furthest);
  open->RemoveDeletedCells();
  ASSERT_FALSE(handeye::isClosedSurface(open));
  const Pipeline pipeline = ringPipeline(webcam(), scene(640, 480));
  for (const double opacity : { 0.65, 1.0 })
  {
    pipeline->SetModelOpacity(opacity);
    pipeline->SetModelToCamera(handeye::toVtk(Eigen::Isometry3d(Eigen::Translation3d(10, -5, 180))));
    pipeline->SetModel(ball->GetOutput());
    const cv::Mat closed = rendered(pipeline), closedMask = renderedMask(pipeline);
    pipeline->SetModel(open);
    EXPECT_EQ(largestDifference(closedMask, renderedMask(pipeline)), 0);
    // At its rim front and back have the same depth, to 24 bits, and a little other shading.
    EXPECT_LE(largestDifference(closed, rendered(pipeline)), 12);
  }
  // From inside it is the far half that is seen.
  pipeline->SetModel(ball->GetOutput());
  pipeline->SetModelToCamera(handeye::toVtk(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 5))));
  EXPECT_EQ(cv::countNonZero(renderedMask(pipeline)), 640 * 480);
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
  pipeline->SetModelToCamera(handeye::toVtk(pose(5, 5, 250)));
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
  pipeline->SetModelToCamera(handeye::toVtk(pose(0, 0, 250)));
  const cv::Point middle(316, 245);
  pipeline->SetModelOpacity(1);
  const cv::Vec3b opaque = rendered(pipeline).at<cv::Vec3b>(middle);
  pipeline->SetModelOpacity(0.5);
  const cv::Vec3b half = rendered(pipeline).at<cv::Vec3b>(middle);
  EXPECT_NEAR(half[0], (opaque[0] + 200) / 2.0, 2);
  EXPECT_NEAR(half[1], opaque[1] / 2.0, 2);
  EXPECT_NEAR(half[2], opaque[2] / 2.0, 2);
}

TEST(OverlayPipeline, Window_HasTheVideoInTheMiddleAndBlackBars)
{
  const cv::Mat frame = noise(320, 240);
  const Pipeline pipeline = newPipeline();
  pipeline->SetVideoFrame(frame);
  vtkNew<vtkRenderWindow> window;
  pipeline->AttachTo(window);
  EXPECT_EQ(largestDifference(renderedWindow(window, 320, 240), frame), 0);

  cv::Mat wide = renderedWindow(window, 400, 240);
  EXPECT_EQ(largestDifference(wide(cv::Rect(40, 0, 320, 240)), frame), 0);
  wide(cv::Rect(40, 0, 320, 240)).setTo(cv::Scalar::all(0));
  EXPECT_EQ(cv::norm(wide, cv::NORM_INF), 0);

  cv::Mat tall = renderedWindow(window, 640, 1000);
  cv::Mat doubled;
  cv::resize(frame, doubled, {}, 2, 2, cv::INTER_NEAREST);
  EXPECT_EQ(largestDifference(tall(cv::Rect(0, 260, 640, 480)), doubled), 0);
  tall(cv::Rect(0, 260, 640, 480)).setTo(cv::Scalar::all(0));
  EXPECT_EQ(cv::norm(tall, cv::NORM_INF), 0);

  // After a video of another aspect, nothing of the old picture remains in the new bars.
  pipeline->SetVideoFrame(cv::Mat(480, 320, CV_8UC3, cv::Scalar(0, 255, 0)));
  const cv::Mat other = renderedWindow(window, 640, 480);
  EXPECT_EQ(other.at<cv::Vec3b>(240, 100), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(other.at<cv::Vec3b>(240, 320), cv::Vec3b(0, 255, 0));
}

TEST(OverlayPipeline, Picture_IsTheSameWhateverTheWindowDoes)
{
  const Pipeline pipeline = ringPipeline(webcam(), scene(640, 480));
  const cv::Mat before = rendered(pipeline);
  {
    vtkNew<vtkRenderWindow> window;
    pipeline->AttachTo(window);
    static_cast<void>(renderedWindow(window, 300, 700));
    EXPECT_EQ(largestDifference(rendered(pipeline), before), 0);
    vtkNew<vtkRenderWindow> another;
    pipeline->AttachTo(another);
    static_cast<void>(renderedWindow(another, 500, 200));
    EXPECT_EQ(window->GetRenderers()->GetNumberOfItems(), 0);
    pipeline->AttachTo(nullptr);
    pipeline->AttachTo(window);
  }  // a window may go before the pipeline
  EXPECT_EQ(largestDifference(rendered(pipeline), before), 0);
}

TEST(OverlayPipeline, Window_OutlivesThePipeline)
{
  vtkNew<vtkRenderWindow> window;
  {
    const Pipeline pipeline = ringPipeline(webcam(), scene(640, 480));
    pipeline->AttachTo(window);
    static_cast<void>(renderedWindow(window, 640, 480));
  }
  EXPECT_EQ(window->GetRenderers()->GetNumberOfItems(), 0);
  window->Render();
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

TEST(OverlayPipeline, Edges_AreShortEnoughForTheNearestDistance)
{
  const Pipeline pipeline = ringPipeline(laparoscope(), scene(720, 576));
  EXPECT_GT(pipeline->GetEdgeErrorPx(), 0);
  EXPECT_LE(pipeline->GetEdgeErrorPx(), 0.05 + 1e-9);
  const vtkIdType before = pipeline->GetModel()->GetNumberOfPolys();
  pipeline->SetNearestDistanceMm(20);
  EXPECT_LE(pipeline->GetEdgeErrorPx(), 0.05 + 1e-9);
  EXPECT_EQ(pipeline->GetModel()->GetNumberOfPolys(), before);
  pipeline->SetCameraModel(handeye::CameraModel(720, 576, laparoscope().cameraMatrix(), {}));
  EXPECT_NEAR(pipeline->GetEdgeErrorPx(), 0, 1e-6);
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
  pipeline->SetModelToCamera(handeye::toVtk(pose(40, 25, 150)));  // reaches over the border, where the lens bends most
  expectLikeBaseline(rendered(pipeline), "", 40);                 // see above
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
