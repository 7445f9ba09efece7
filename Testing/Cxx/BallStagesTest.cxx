// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallStages.h"

#include "GeometryMatchers.h"
#include "SphereRenderer.h"
#include "TestCameras.h"

#include <gtest/gtest.h>

using namespace handeye;
using namespace handeye::test;

namespace
{

const CameraModel Camera = webcam();
const RenderedBall Ball = ballSeenAt(Camera, 0.4, 0.6, 30);

/// The green of what is drawn: the scene has none.
cv::Mat drawn(const cv::Mat& picture)
{
  cv::Mat green;
  cv::inRange(picture, cv::Scalar(0, 180, 0), cv::Scalar(140, 255, 140), green);
  return green;
}

BallStages stagesOf(const cv::Mat& image, const BallDetectionOptions& options = {})
{
  return drawBallStages(image, detectBall(image, Camera, Ball.radiusMm, options), Camera, Ball.radiusMm, options);
}

}  // namespace

TEST(BallStages, EachStage_ShowsTheBallWhereItIs)
{
  const cv::Mat image = SphereScene(Camera).add(Ball).photograph();
  const Eigen::Vector2d center = Camera.project(Ball.center_Camera).point_Image;
  for (const auto method : { BallDetectionOptions::Method::Exact, BallDetectionOptions::Method::Hough })
  {
    BallDetectionOptions options;
    options.method = method;
    const BallStages stages = stagesOf(image, options);
    const cv::Point inside(int(center.x()), int(center.y())), outside(20, 20);
    for (const cv::Mat& grey : { stages.mask, stages.smoothed })
    {
      ASSERT_EQ(grey.type(), CV_8UC1);
      ASSERT_EQ(grey.size(), image.size());
      EXPECT_GT(grey.at<uchar>(inside), 200);
      EXPECT_EQ(grey.at<uchar>(outside), 0);
    }
    for (const cv::Mat& picture : { stages.edges, stages.outline })
    {
      ASSERT_EQ(picture.type(), CV_8UC3);
      ASSERT_EQ(picture.size(), image.size());
      const cv::Rect around = cv::boundingRect(drawn(picture));
      EXPECT_NEAR(around.x + around.width / 2.0, center.x(), 2);
      EXPECT_NEAR(around.y + around.height / 2.0, center.y(), 2);
      EXPECT_NEAR(around.width, 60, 8);
    }
  }
}

TEST(BallStages, NoBall_SaysWhyOnThePicture)
{
  const cv::Mat image = SphereScene(Camera).photograph();
  const BallStages stages = stagesOf(image);
  EXPECT_EQ(cv::countNonZero(stages.mask), 0);
  EXPECT_EQ(cv::countNonZero(drawn(stages.edges)), 0);
  EXPECT_GT(cv::norm(stages.outline, image, cv::NORM_INF), 100) << "the reason is written on the frame";
}

TEST(BallStages, OtherKindsOfImages_AreDrawnTheSame)
{
  const cv::Mat image = SphereScene(Camera).add(Ball).photograph();
  const BallStages plain = stagesOf(image);
  cv::Mat rgba, wide;
  cv::cvtColor(image, rgba, cv::COLOR_BGR2RGBA);
  image.convertTo(wide, CV_16U, 257);
  BallDetectionOptions options;
  options.color.channelOrder = BallColor::ChannelOrder::Rgb;
  EXPECT_EQ(cv::norm(stagesOf(rgba, options).outline, plain.outline, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(stagesOf(wide).outline, plain.outline, cv::NORM_INF), 0);
  expectInvalidArgument([&] { (void)drawBallStages({}, {}, Camera, 15); }, { "empty" });
}
