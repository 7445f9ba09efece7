// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the tracker knows decides where the picture alone cannot, and never makes a ball of something that is none.
#include "BallDetector.h"
#include "BallTracker.h"
#include "ConditionScene.h"
#include "GeometryMatchers.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Status = BallDetection::Status;

constexpr double BallRadiusMm = 15;

RenderedBall ballAt(double xShare, double yShare, double radiusPx)
{
  RenderedBall ball = ballSeenAt(webcam(), xShare, yShare, radiusPx, BallRadiusMm);
  ball.isShaded = true;
  return ball;
}

Eigen::Vector2d centerOf(const RenderedBall& ball)
{
  return webcam().project(ball.center_Camera).point_Image;
}

/// As a tracker predicts: a few mm off.
BallPrediction predictionOf(const RenderedBall& ball)
{
  return { ball.center_Camera + Eigen::Vector3d(1.5, -1, 4), 8 };
}

class BallPredictions : public ::testing::TestWithParam<Background>
{
protected:
  ConditionScene scene() const { return ConditionScene(GetParam()); }
  const BallDetector detector_{ webcam(), BallRadiusMm };
};

std::string nameOf(const ::testing::TestParamInfo<Background>& info)
{
  std::string name = info.param.name;
  name[name.find(' ')] = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, BallPredictions, ::testing::ValuesIn(ConditionScene::backgrounds()), nameOf);

}  // namespace

TEST_P(BallPredictions, OfTwoEqualBalls_ThePredictedOneIsTaken)
{
  for (const double radiusPx : { 18.0, 32.0, 60.0 })
  {
    SCOPED_TRACE("radius " + std::to_string(int(radiusPx)) + " px");
    const RenderedBall left = ballAt(0.27, 0.45, radiusPx), right = ballAt(0.71, 0.52, radiusPx);
    const cv::Mat image = scene().add(left).add(right).photograph();
    for (const RenderedBall& wanted : { left, right })
    {
      const BallDetection found = detector_.detect(image, predictionOf(wanted));
      ASSERT_EQ(found.status, Status::Found) << found.message;
      EXPECT_TRUE(pointNear(found.ball_Image, centerOf(wanted), 0.3));
    }
  }
}

TEST_P(BallPredictions, SmallBallInTheRightPlace_BeatsALargeOneElsewhere)
{
  const RenderedBall wanted = ballAt(0.74, 0.52, 14), other = ballAt(0.27, 0.45, 60);
  const BallDetection found = detector_.detect(scene().add(wanted).add(other).photograph(), predictionOf(wanted));
  ASSERT_EQ(found.status, Status::Found) << found.message;
  EXPECT_TRUE(pointNear(found.ball_Image, centerOf(wanted), 0.3));
}

TEST_P(BallPredictions, BallFarFromThePrediction_IsNotTaken)
{
  const RenderedBall seen = ballAt(0.27, 0.45, 32), expected = ballAt(0.75, 0.55, 32);
  const BallDetection found = detector_.detect(scene().add(seen).photograph(), predictionOf(expected));
  EXPECT_FALSE(found.isFound()) << found.ball_Image.transpose();
  EXPECT_FALSE(found.message.empty());
}

TEST_P(BallPredictions, NothingInThePredictedPlace_IsNoBall)
{
  const RenderedBall expected = ballAt(0.5, 0.5, 32);
  const BallDetection found = detector_.detect(scene().photograph(), predictionOf(expected));
  EXPECT_FALSE(found.isFound()) << found.ball_Image.transpose();
}

TEST_P(BallPredictions, RedThingInThePredictedPlace_IsNoBall)
{
  const RenderedBall expected = ballAt(0.5, 0.5, 32);
  const Eigen::Vector2d center = centerOf(expected);
  const cv::Mat ring = scene().ring(center, 32, 7, BallRed).photograph();
  EXPECT_FALSE(detector_.detect(ring, predictionOf(expected)).isFound());
  const cv::Mat glove = scene().glove(center + Eigen::Vector2d(0, 90), 120, BallRed).photograph();
  EXPECT_FALSE(detector_.detect(glove, predictionOf(expected)).isFound());
}

TEST_P(BallPredictions, Tracking_FollowsAndFindsAgain)
{
  BallTracker tracker(detector_);
  for (int i = 0; i < 12; ++i)
  {
    SCOPED_TRACE("frame " + std::to_string(i));
    // It leaves for three frames and comes back somewhere else.
    const bool isAway = i >= 5 && i < 8;
    const RenderedBall ball = i < 5 ? ballAt(0.3 + 0.012 * i, 0.4, 26) : ballAt(0.72 - 0.012 * i, 0.55, 34);
    ConditionScene picture = scene();
    if (!isAway)
    {
      picture.add(ball);
    }
    const cv::Mat image = picture.photograph(1, 1.5, unsigned(i + 1));
    const BallDetection followed = tracker.next(image), searched = detector_.detect(image);
    ASSERT_EQ(followed.isFound(), !isAway) << followed.message;
    ASSERT_EQ(followed.status, searched.status) << searched.message;
    const bool isFirst = i == 0 || i == 8;
    EXPECT_EQ(tracker.searched().size() == image.size(), isFirst || isAway);
    if (!isAway)
    {
      EXPECT_TRUE(pointNear(followed.ball_Image, centerOf(ball), 0.3));
      EXPECT_TRUE(pointNear(followed.ball_Image, searched.ball_Image, 0.05)) << "as in the whole image, only sooner";
    }
  }
}
