// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallTracker.h"

#include "GeometryMatchers.h"
#include "SphereRenderer.h"
#include "TestCameras.h"

#include <gtest/gtest.h>

using namespace handeye;
using namespace handeye::test;

namespace
{

class BallTrackerCase : public testing::Test
{
protected:
  const CameraModel camera = webcam();
  const BallDetector detector{ camera, 15 };
  BallTracker tracker{ detector };
  const cv::Rect whole{ 0, 0, camera.width(), camera.height() };

  cv::Mat frameWith(double x, double y, double radiusPx = 25) const
  {
    return SphereScene(camera).add(ballSeenAt(camera, x, y, radiusPx)).photograph({ 0.7, 1, CV_8UC3, unsigned(1000 * x) });
  }
};

}  // namespace

TEST_F(BallTrackerCase, MovingBall_IsFoundInAWindowAsPreciselyAsInTheWholeImage)
{
  for (int i = 0; i < 12; ++i)
  {
    const cv::Mat frame = frameWith(0.2 + 0.045 * i, 0.3 + 0.03 * i, 18 + 2 * i);
    const BallDetection followed = tracker.next(frame), alone = detector.detect(frame);
    ASSERT_TRUE(followed.isFound()) << i << ": " << followed.message;
    EXPECT_TRUE(pointNear(followed.ball_Image, alone.ball_Image, 0.02)) << i;
    // The first frame has no window, and of the second nobody knows yet how fast the ball is.
    EXPECT_EQ(tracker.searched() == whole, i < 2) << i;
  }
}

TEST_F(BallTrackerCase, BallThatJumps_IsFoundInTheWholeImage)
{
  (void)tracker.next(frameWith(0.2, 0.3));
  const BallDetection jumped = tracker.next(frameWith(0.8, 0.7));
  ASSERT_TRUE(jumped.isFound()) << jumped.message;
  EXPECT_EQ(tracker.searched(), whole);
  EXPECT_TRUE(tracker.next(frameWith(0.81, 0.7)).isFound());
  EXPECT_NE(tracker.searched(), whole);
}

TEST_F(BallTrackerCase, LostBall_IsNotFoundAndFoundAgain)
{
  (void)tracker.next(frameWith(0.4, 0.5));
  EXPECT_FALSE(tracker.next(SphereScene(camera).photograph()).isFound());
  EXPECT_TRUE(tracker.next(frameWith(0.7, 0.3)).isFound());
}

TEST_F(BallTrackerCase, BallCutByTheImagesBorder_IsFollowed)
{
  for (const double x : { 0.06, 0.045, 0.03, 0.02 })
  {
    EXPECT_TRUE(tracker.next(frameWith(x, 0.5)).isFound()) << x;
  }
  EXPECT_NE(tracker.searched(), whole);
}

TEST_F(BallTrackerCase, Prediction_LaysTheWindow)
{
  const RenderedBall ball = ballSeenAt(camera, 0.7, 0.6, 25);
  const cv::Mat frame = SphereScene(camera).add(ball).photograph();
  ASSERT_TRUE(tracker.next(frame, BallPrediction{ ball.center_Camera, 5 }).isFound());
  EXPECT_NE(tracker.searched(), whole) << "no frame before was needed";
}

TEST_F(BallTrackerCase, Reset_ForgetsTheLastPlace)
{
  (void)tracker.next(frameWith(0.4, 0.5));
  tracker.reset();
  EXPECT_TRUE(tracker.next(frameWith(0.41, 0.5)).isFound());
  EXPECT_EQ(tracker.searched(), whole);
}
