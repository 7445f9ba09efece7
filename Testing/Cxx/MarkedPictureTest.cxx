// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MarkedPicture.h"

#include <gtest/gtest.h>

using namespace handeye;
using namespace handeye::report;

namespace
{

BallDetection ballAt(double x, double y)
{
  BallDetection ball;
  ball.status = BallDetection::Status::Found;
  ball.ball_Image = { x, y };
  return ball;
}

/// The mean place of the pixels of a colour (BGR) right of `firstColumn`.
Eigen::Vector2d placeOf(const cv::Mat& picture, const cv::Vec3b& color, int firstColumn)
{
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (int row = 0; row < picture.rows; ++row)
  {
    for (int column = firstColumn; column < picture.cols; ++column)
    {
      if (cv::norm(picture.at<cv::Vec3b>(row, column), color) < 30)
      {
        sum += Eigen::Vector2d(column - firstColumn, row);
        ++count;
      }
    }
  }
  return count > 0 ? Eigen::Vector2d(sum / count) : Eigen::Vector2d(-1, -1);
}

constexpr int Enlargement = 640 + 6;  ///< where it begins in the picture of a frame of 4 to 3

}  // namespace

TEST(MarkedPicture, ErrorOfAPixel_IsSeenEnlarged)
{
  const cv::Mat image(480, 640, CV_8UC3, cv::Scalar(60, 60, 60));
  const PredictedCenter predicted{ { 201.2, 150.5 }, { 255, 0, 255 }, "" };
  const cv::Mat picture = drawMarkedPicture(image, ballAt(200, 150.5), { predicted });
  ASSERT_EQ(picture.size(), cv::Size(640 + 6 + 480, 480));
  const Eigen::Vector2d segmented = placeOf(picture, { 80, 220, 80 }, Enlargement),
                        shown = placeOf(picture, { 255, 0, 255 }, Enlargement);
  EXPECT_NEAR(segmented.x(), 239.5, 2) << "in the middle";
  EXPECT_NEAR(segmented.y(), 239.5, 2);
  EXPECT_GT(shown.x() - segmented.x(), 60) << "1.2 px are a good part of the enlargement";
  EXPECT_NEAR(shown.y(), segmented.y(), 3);
}

TEST(MarkedPicture, FarPrediction_LeavesAnArrowThatStaysInside)
{
  const cv::Mat image(480, 640, CV_8UC3, cv::Scalar(60, 60, 60));
  const std::vector<PredictedCenter> predicted = { { { 201, 150 }, { 255, 0, 255 }, "near" },
    { { 200, 450 }, { 255, 255, 0 }, "far" } };
  const cv::Mat picture = drawMarkedPicture(image, ballAt(200, 150), predicted);
  EXPECT_GT(placeOf(picture, { 255, 0, 255 }, Enlargement).x(), 0) << "the near one is still to be seen";
  const Eigen::Vector2d far = placeOf(picture, { 0, 255, 255 }, Enlargement);
  EXPECT_NEAR(far.x(), 239.5, 8) << "straight down";
  EXPECT_GT(far.y(), 300);
}

TEST(MarkedPicture, GreyAndDeepPictures_AreTaken)
{
  const std::vector<PredictedCenter> predicted = { { { 21, 15 }, { 255, 0, 255 }, "" } };
  for (const int type : { CV_8UC1, CV_16UC1, CV_8UC4, CV_16UC3 })
  {
    const cv::Mat image(48, 64, type, cv::Scalar::all(100));
    EXPECT_EQ(drawMarkedPicture(image, ballAt(20, 15), predicted).type(), CV_8UC3) << type;
    EXPECT_EQ(drawFrame(image, ballAt(20, 15), nullptr).size(), cv::Size(64, 48)) << type;
  }
}

TEST(MarkedPicture, NothingFound_IsTheFrameAlone)
{
  const cv::Mat image(240, 320, CV_8UC3, cv::Scalar(10, 20, 30));
  const cv::Mat picture = drawMarkedPicture(image, BallDetection(), {});
  EXPECT_EQ(picture.size(), cv::Size(640, 480));
  EXPECT_EQ(picture.at<cv::Vec3b>(100, 100), cv::Vec3b(10, 20, 30));
}
