// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HoughBall.h"

#include "BallDetection.h"
#include "GeometryMatchers.h"
#include "SphereRenderer.h"
#include "TestCameras.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace handeye;
using namespace handeye::test;

TEST(HoughBall, LoneBall_IsFoundToAPixelOrTwo)
{
  for (const double radiusPx : { 20.0, 50.0 })
  {
    const RenderedBall ball = ballSeenAt(webcam(), 0.48, 0.53, radiusPx);
    const std::optional<HoughCircle> circle = findHoughCircle(SphereScene(webcam()).add(ball).photograph());
    ASSERT_TRUE(circle.has_value());
    const Eigen::Vector2d center = webcam().project(ball.center_Camera).point_Image;
    EXPECT_TRUE(pointNear(Eigen::Vector2d(circle->center_Image.x, circle->center_Image.y), center, 2.5));
    EXPECT_NEAR(circle->radiusPx, radiusPx, 3);
  }
}

TEST(HoughBall, NoBall_IsNothing)
{
  EXPECT_FALSE(findHoughCircle(SphereScene(webcam()).photograph()).has_value());
  BallDetectionOptions options;
  options.method = BallDetectionOptions::Method::Hough;
  const BallDetection none = detectBall(SphereScene(webcam()).photograph(), webcam(), 15, options);
  EXPECT_EQ(none.status, BallDetection::Status::NotFound);
  EXPECT_TRUE(says(none.message, { "no circle" }));
}

TEST(HoughBall, RedRing_IsTakenForTheBall)
{
  // Known of the published way, and the reason why it is not the default.
  SphereScene scene(webcam());
  cv::circle(scene.light(), { 430, 260 }, 45, cv::Scalar(0.02, 0.015, 0.55), 10, cv::LINE_AA);
  const std::optional<HoughCircle> circle = findHoughCircle(scene.photograph());
  ASSERT_TRUE(circle.has_value());
  EXPECT_NEAR(circle->center_Image.x, 430, 4);
  EXPECT_NEAR(circle->center_Image.y, 260, 4);
}

TEST(HoughBall, AsADetection_GivesRayAndDistance)
{
  const RenderedBall ball = ballSeenAt(laparoscope(), 0.5, 0.45, 45);
  BallDetectionOptions options;
  options.method = BallDetectionOptions::Method::Hough;
  const BallDetection found = detectBall(SphereScene(laparoscope()).add(ball).photograph(), laparoscope(), ball.radiusMm, options);
  ASSERT_TRUE(found.isFound()) << found.message;
  EXPECT_TRUE(pointNear(found.ray_Camera, ball.center_Camera.normalized(), 0.004));
  EXPECT_NEAR(found.distanceMm / ball.center_Camera.norm(), 1, 0.08);
  EXPECT_GE(std::sqrt(found.covariance_Image.trace() / 2), 1) << "it is no sub-pixel method, and says so";
  EXPECT_TRUE(pointNear(laparoscope().project(found.ray_Camera).point_Image, found.ball_Image, 1e-6));
}

TEST(HoughBall, OtherImages_ThrowASentence)
{
  expectInvalidArgument([] { (void)findHoughCircle({}); }, { "empty" });
  expectInvalidArgument([] { (void)findHoughCircle(cv::Mat(10, 10, CV_8U)); }, { "1 channel" });
}
