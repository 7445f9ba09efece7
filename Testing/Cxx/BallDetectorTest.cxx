// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallDetector.h"

#include "GeometryMatchers.h"
#include "SphereRenderer.h"
#include "TestCameras.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Status = BallDetection::Status;

class BallDetectorCase : public testing::Test
{
protected:
  const CameraModel camera = webcam();
  const RenderedBall ball = ballSeenAt(camera, 0.3, 0.6, 30);
  const RenderedBall twin = ballSeenAt(camera, 0.7, 0.4, 30);
  const cv::Mat one = SphereScene(camera).add(ball).photograph();
  const cv::Mat two = SphereScene(camera).add(ball).add(twin).photograph();
  const BallDetector detector{ camera, ball.radiusMm };

  Eigen::Vector2d seenAt(const RenderedBall& rendered) const { return camera.project(rendered.center_Camera).point_Image; }
};

}  // namespace

TEST_F(BallDetectorCase, Detector_GivesWhatDetectBallGives)
{
  const BallDetection whole = detector.detect(one), plain = detectBall(one, camera, ball.radiusMm);
  ASSERT_TRUE(whole.isFound()) << whole.message;
  EXPECT_EQ(whole.ball_Image, plain.ball_Image);
  EXPECT_EQ(whole.covariance_Image, plain.covariance_Image);
}

TEST_F(BallDetectorCase, Window_GivesTheSameBallInPixelsOfTheWholeImage)
{
  const Eigen::Vector2d center = seenAt(ball);
  const cv::Rect window(int(center.x()) - 60, int(center.y()) - 55, 120, 110);
  const BallDetection whole = detector.detect(one), part = detector.detectIn(one, window);
  ASSERT_TRUE(part.isFound()) << part.message;
  EXPECT_TRUE(pointNear(part.ball_Image, whole.ball_Image, 0.01));
  EXPECT_FALSE(detector.detectIn(one, { 400, 10, 100, 100 }).isFound()) << "the ball is elsewhere";
  EXPECT_EQ(detector.detectIn(one, { 700, 500, 100, 100 }).status, Status::NotFound) << "outside of the image";
}

TEST_F(BallDetectorCase, RgbImage_GivesTheSameBall)
{
  BallDetectionOptions options;
  options.color.channelOrder = BallColor::ChannelOrder::Rgb;
  cv::Mat rgb, rgba;
  cv::cvtColor(one, rgb, cv::COLOR_BGR2RGB);
  cv::cvtColor(one, rgba, cv::COLOR_BGR2RGBA);
  const BallDetection bgr = detector.detect(one);
  for (const cv::Mat& image : { rgb, rgba })
  {
    const BallDetection found = BallDetector(camera, ball.radiusMm, options).detect(image);
    ASSERT_TRUE(found.isFound()) << found.message;
    EXPECT_TRUE(pointNear(found.ball_Image, bgr.ball_Image, 1e-3));
    EXPECT_FALSE(detector.detect(image).isFound()) << "read as BGR it is a blue ball";
  }
}

TEST_F(BallDetectorCase, BallOutsideOfTheWorkingRange_IsRefusedWithBothNumbers)
{
  const double distanceMm = ball.center_Camera.norm();
  BallDetectionOptions options;
  options.furthestMm = 0.7 * distanceMm;
  const BallDetection far = BallDetector(camera, ball.radiusMm, options).detect(one);
  EXPECT_EQ(far.status, Status::OutOfRange);
  EXPECT_NE(far.message.find("working range"), std::string::npos) << far.message;
  options.nearestMm = 1.4 * distanceMm;
  options.furthestMm = 3 * distanceMm;
  EXPECT_EQ(BallDetector(camera, ball.radiusMm, options).detect(one).status, Status::OutOfRange);
  options.nearestMm = 0.9 * distanceMm;
  EXPECT_TRUE(BallDetector(camera, ball.radiusMm, options).detect(one).isFound());
}

TEST_F(BallDetectorCase, WorkingRange_ChoosesBetweenTwoBalls)
{
  const RenderedBall further = ballSeenAt(camera, 0.7, 0.4, 15);
  const cv::Mat image = SphereScene(camera).add(ball).add(further).photograph();
  BallDetectionOptions options;
  options.nearestMm = 0.9 * further.center_Camera.norm();
  const BallDetection found = BallDetector(camera, ball.radiusMm, options).detect(image);
  ASSERT_TRUE(found.isFound()) << found.message;
  EXPECT_TRUE(pointNear(found.ball_Image, seenAt(further), 0.1));
}

TEST_F(BallDetectorCase, Prediction_ChoosesBetweenTwoBalls)
{
  EXPECT_EQ(detector.detect(two).status, Status::SeveralBalls);
  for (const RenderedBall& wanted : { ball, twin })
  {
    const BallDetection found = detector.detect(two, BallPrediction{ wanted.center_Camera, 8 });
    ASSERT_TRUE(found.isFound()) << found.message;
    EXPECT_TRUE(pointNear(found.ball_Image, seenAt(wanted), 0.1));
  }
}

TEST_F(BallDetectorCase, BallFarFromThePrediction_IsElsewhere)
{
  const BallDetection found = detector.detect(one, BallPrediction{ twin.center_Camera, 8 });
  EXPECT_EQ(found.status, Status::Elsewhere);
  EXPECT_NE(found.message.find("px from where the tracker puts"), std::string::npos) << found.message;
  const BallDetection nearer = detector.detect(one, BallPrediction{ 0.6 * ball.center_Camera, 8 });
  EXPECT_EQ(nearer.status, Status::Elsewhere) << "the same place in the image, another distance";
  const BallDetection behind = detector.detect(one, BallPrediction{ -ball.center_Camera, 8 });
  EXPECT_EQ(behind.status, Status::Elsewhere);
  EXPECT_NE(behind.message.find("out of view"), std::string::npos) << behind.message;
}

TEST_F(BallDetectorCase, NumbersThatMakeNoSense_Throw)
{
  expectInvalidArgument([&] { (void)detector.detect(one, BallPrediction{ { NAN, 0, 1 }, 8 }); }, { "prediction" });
  expectInvalidArgument([&] { (void)detector.detect(one, BallPrediction{ { 0, 0, 100 }, 0 }); }, { "prediction" });
  BallDetectionOptions options;
  options.nearestMm = 300;
  options.furthestMm = 200;
  expectInvalidArgument([&] { BallDetector(camera, 15, options); }, { "working range" });
  expectInvalidArgument([&] { BallDetector(camera, 0); }, { "radius" });
}
