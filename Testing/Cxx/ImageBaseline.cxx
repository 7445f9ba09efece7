// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ImageBaseline.h"

#include "EigenVtk.h"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vtkImageData.h>
#include <vtkImageDifference.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkUnsignedCharArray.h>

#include <filesystem>
#include <limits>

namespace handeye::test
{

void expectLikeBaseline(const cv::Mat& picture, const std::string& name, double threshold)
{
  namespace fs = std::filesystem;
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const std::string file = std::string(info->test_suite_name()) + "." + info->name() + name + ".png";
  const fs::path baseline = fs::path(HANDEYE_BASELINE_DIR) / file, output = fs::path(HANDEYE_TEST_OUTPUT_DIR) / file;
  fs::create_directories(output.parent_path());
  ASSERT_TRUE(cv::imwrite(output.string(), picture));
  ASSERT_TRUE(fs::exists(baseline)) << "no baseline " << baseline << "; the picture is " << output;
  const cv::Mat expected = cv::imread(baseline.string());
  ASSERT_EQ(expected.size(), picture.size());
  vtkNew<vtkImageData> left, right;
  toVtk(picture, left);
  toVtk(expected, right);
  vtkNew<vtkImageDifference> difference;
  difference->SetInputData(left);
  difference->SetImageData(right);
  difference->Update();
  EXPECT_LE(difference->GetThresholdedError(), threshold) << output << " differs from " << baseline;
}

cv::Mat renderedWindow(vtkRenderWindow* window, int width, int height)
{
  window->SetSize(width, height);
  window->Render();
  vtkNew<vtkUnsignedCharArray> pixels;
  window->GetPixelData(0, 0, width - 1, height - 1, 0, pixels);
  cv::Mat upright, picture;
  cv::flip(cv::Mat(height, width, CV_8UC3, pixels->GetPointer(0)), upright, 0);
  cv::cvtColor(upright, picture, cv::COLOR_RGB2BGR);
  return picture;
}

double largestDifference(const cv::Mat& a, const cv::Mat& b)
{
  return a.size() == b.size() ? cv::norm(a, b, cv::NORM_INF) : std::numeric_limits<double>::infinity();
}

}  // namespace handeye::test
