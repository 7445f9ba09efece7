// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallColorLearning.h"

#include "BallDetection.h"
#include "GeometryMatchers.h"
#include "SphereRenderer.h"
#include "TestCameras.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Status = BallColorLearningResult::Status;

struct Painted
{
  const char* name;
  Light color;
};

/// The hue of a picture of the colour.
double hueOf(const Light& color)
{
  const cv::Mat picture = SphereScene(pinhole(), color).photograph();
  cv::Mat pixel, hsv;
  picture(cv::Rect(0, 0, 1, 1)).convertTo(pixel, CV_32F, 1 / 255.0);
  cv::cvtColor(pixel, hsv, cv::COLOR_BGR2HSV);
  return double(hsv.at<cv::Vec3f>(0)[0]);
}

/// Saturated colours as balls are sold in; linear light, blue first.
const Painted Colors[] = { { "red", { 0.02F, 0.015F, 0.55F } }, { "orange", { 0.01F, 0.15F, 0.6F } },
  { "green", { 0.04F, 0.4F, 0.03F } }, { "blue", { 0.5F, 0.1F, 0.02F } }, { "magenta", { 0.35F, 0.01F, 0.5F } } };

RenderedBall paint(const CameraModel& camera, const Light& color)
{
  RenderedBall ball = ballSeenAt(camera, 0.42, 0.55, 35);
  ball.color = color;
  ball.isShaded = true;
  return ball;
}

cv::Point pixelAt(const CameraModel& camera, const RenderedBall& ball, int dx, int dy)
{
  const Eigen::Vector2d center = camera.project(ball.center_Camera).point_Image;
  return { int(center.x()) + dx, int(center.y()) + dy };
}

}  // namespace

TEST(BallColorLearning, OneClick_FindsABallOfAnySaturatedColor)
{
  const CameraModel camera = webcam();
  for (const Painted& painted : Colors)
  {
    const RenderedBall ball = paint(camera, painted.color);
    const cv::Mat image = SphereScene(camera).add(ball).photograph({ 0.8, 2 });
    for (const int away : { 0, -20, 18 })
    {
      const BallColorLearningResult learnt = learnBallColor(image, pixelAt(camera, ball, away, -away / 2));
      ASSERT_TRUE(learnt.isUsable()) << painted.name << ": " << learnt.message;
      EXPECT_LT(std::abs(std::remainder(learnt.color.hueDeg - hueOf(painted.color), 360.0)), 4) << painted.name;
      BallDetectionOptions options;
      options.color = learnt.color;
      const BallDetection found = detectBall(image, camera, ball.radiusMm, options);
      ASSERT_TRUE(found.isFound()) << painted.name << ": " << found.message;
      EXPECT_TRUE(pointNear(found.ball_Image, camera.project(ball.center_Camera).point_Image, 0.15)) << painted.name;
    }
  }
}

TEST(BallColorLearning, ClickOnTheHighlight_LearnsTheBall)
{
  const CameraModel camera = webcam();
  const RenderedBall ball = paint(camera, BallRed);
  SphereScene scene = SphereScene(camera).add(ball);
  const cv::Point highlight = pixelAt(camera, ball, -6, -8);
  cv::circle(scene.light(), highlight, 6, cv::Scalar::all(0.95), cv::FILLED);
  const BallColorLearningResult learnt = learnBallColor(scene.photograph(), highlight);
  ASSERT_TRUE(learnt.isUsable()) << learnt.message;
  EXPECT_LT(std::abs(std::remainder(learnt.color.hueDeg, 360.0)), 5);
}

TEST(BallColorLearning, LearntColor_PassesOverBallsOfAnotherColor)
{
  const CameraModel camera = webcam();
  RenderedBall green = ballSeenAt(camera, 0.7, 0.4, 35);
  green.color = Colors[2].color;
  const RenderedBall blue = paint(camera, Colors[3].color);
  const cv::Mat image = SphereScene(camera).add(green).add(blue).photograph();
  BallDetectionOptions options;
  options.color = learnBallColor(image, pixelAt(camera, green, 3, 3)).color;
  const BallDetection found = detectBall(image, camera, 15, options);
  ASSERT_TRUE(found.isFound()) << found.message;
  EXPECT_TRUE(pointNear(found.ball_Image, camera.project(green.center_Camera).point_Image, 0.1));
}

TEST(BallColorLearning, GreyPlace_IsRefusedWithASentence)
{
  const CameraModel camera = webcam();
  const cv::Mat image = SphereScene(camera).add(paint(camera, BallRed)).photograph();
  const BallColorLearningResult learnt = learnBallColor(image, { 600, 30 });
  EXPECT_EQ(learnt.status, Status::NoColor);
  EXPECT_NE(learnt.message.find("click on the coloured ball"), std::string::npos) << learnt.message;
}

TEST(BallColorLearning, ColoredBackground_IsNoBall)
{
  const CameraModel camera = webcam();
  const cv::Mat image = SphereScene(camera, GloveBlue).add(paint(camera, BallRed)).photograph();
  const BallColorLearningResult learnt = learnBallColor(image, { 600, 30 });
  EXPECT_EQ(learnt.status, Status::NoBall);
  EXPECT_NE(learnt.message.find("% of the image"), std::string::npos) << learnt.message;
}

TEST(BallColorLearning, ClickOnTheBall_IsTaken_OneBesideItIsNot)
{
  const CameraModel camera = webcam();
  const RenderedBall ball = paint(camera, BallRed);
  SphereScene scene = SphereScene(camera).add(ball);
  scene.cover(cv::Rect(540, 380, 70, 30));  // blue, and no ball
  const cv::Mat image = scene.photograph({ 0.8, 1 });
  const BallColorLearningResult onBall = learnBallColor(image, pixelAt(camera, ball, 5, 5), camera, ball.radiusMm);
  ASSERT_TRUE(onBall.isUsable()) << onBall.message;
  EXPECT_LT(std::abs(std::remainder(onBall.color.hueDeg, 360.0)), 5);

  const BallColorLearningResult onBlue = learnBallColor(image, { 575, 395 }, camera, ball.radiusMm);
  EXPECT_EQ(onBlue.status, Status::NotFoundThere);
  EXPECT_NE(onBlue.message.find("looks like a ball"), std::string::npos) << onBlue.message;
  EXPECT_EQ(learnBallColor(image, { 30, 30 }, camera, ball.radiusMm).status, Status::NoColor);
}

TEST(BallColorLearning, ClickOnARedThingBesideTheBall_SaysThatTheBallIsElsewhere)
{
  const CameraModel camera = webcam();
  const RenderedBall ball = paint(camera, BallRed);
  SphereScene scene = SphereScene(camera).add(ball);
  scene.cover(cv::Rect(560, 400, 60, 8), BallRed);
  const BallColorLearningResult learnt = learnBallColor(scene.photograph({ 0.8, 1 }), { 590, 404 }, camera, ball.radiusMm);
  EXPECT_EQ(learnt.status, Status::NotFoundThere);
  EXPECT_NE(learnt.message.find("elsewhere"), std::string::npos) << learnt.message;
}

TEST(BallColorLearning, BadInput_Throws)
{
  const cv::Mat image(40, 60, CV_8UC3, cv::Scalar::all(90));
  expectInvalidArgument([&] { (void)learnBallColor(image, { 60, 10 }); }, { "60, 10", "60 x 40" });
  expectInvalidArgument([&] { (void)learnBallColor(cv::Mat(40, 60, CV_8UC1), { 1, 1 }); }, { "1 channel" });
  expectInvalidArgument([&] { (void)learnBallColor({}, { 1, 1 }); }, { "empty" });
}
