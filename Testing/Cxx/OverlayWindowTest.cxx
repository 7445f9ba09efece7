// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The pipeline in a window: where the video is in it, what is read from it, and which of the two goes first.
#include "ImageBaseline.h"
#include "OverlayRingScene.h"

#include <gtest/gtest.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRendererCollection.h>

using namespace handeye::test;

TEST(OverlayWindow, ReadShown_HasTheVideosPixelsWhateverTheWindowsSize)
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

TEST(OverlayWindow, Window_HasTheVideoInTheMiddleAndBlackBars)
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

TEST(OverlayWindow, Picture_IsTheSameWhateverTheWindowDoes)
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

TEST(OverlayWindow, Window_OutlivesThePipeline)
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
