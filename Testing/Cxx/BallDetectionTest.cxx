// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallDetection.h"

#include "GeometryMatchers.h"
#include "SphereRenderer.h"
#include "TestCameras.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Status = BallDetection::Status;

Eigen::Vector2d centerOf(const CameraModel& camera, const RenderedBall& ball)
{
  return camera.project(ball.center_Camera).point_Image;
}

/// Centre errors (px) over places all over the image.
struct Accuracy
{
  double meanPx = 0;
  double worstPx = 0;
  double distanceShare = 0;  ///< largest relative error of the distance
};

Accuracy measure(const NamedCamera& named, double radiusPx, bool isShaded, const Photograph& how)
{
  const double places[][2] = { { 0.5, 0.5 }, { 0.27, 0.31 }, { 0.72, 0.35 }, { 0.3, 0.69 } };
  Accuracy accuracy;
  for (const auto& place : places)
  {
    RenderedBall ball = ballSeenAt(named.camera, place[0] + 0.0007 * radiusPx, place[1], radiusPx);
    ball.isShaded = isShaded;
    const BallDetection found = detectBall(SphereScene(named.camera).add(ball).photograph(how), named.camera, ball.radiusMm);
    EXPECT_EQ(found.status, Status::Found) << named.name << ", " << radiusPx << " px: " << found.message;
    const double error = (found.ball_Image - centerOf(named.camera, ball)).norm();
    accuracy.meanPx += error / 4;
    accuracy.worstPx = std::max(accuracy.worstPx, error);
    const double distance = ball.center_Camera.norm();
    accuracy.distanceShare = std::max(accuracy.distanceShare, std::abs(found.distanceMm / distance - 1));
    EXPECT_GT(found.visibleShare, 0.75) << named.name << ", " << radiusPx << " px";  // the largest reach over the border
  }
  return accuracy;
}

const NamedCamera Webcam{ "webcam", webcam() };
const NamedCamera Laparoscope{ "laparoscope", laparoscope() };
const NamedCamera PassThrough{ "passThrough", passThrough() };

}  // namespace

TEST(BallDetection, FlatBall_IsFoundToAFewHundredthsOfAPixel)
{
  for (const NamedCamera& named : { Webcam, Laparoscope, PassThrough })
  {
    for (const double radiusPx : { 8.0, 14.0, 30.0, 60.0, 120.0 })
    {
      SCOPED_TRACE(named.name + ", " + std::to_string(radiusPx) + " px");
      const Accuracy accuracy = measure(named, radiusPx, false, {});
      EXPECT_LT(accuracy.meanPx, 0.05);
      EXPECT_LT(accuracy.worstPx, 0.08);
      EXPECT_LT(accuracy.distanceShare, 0.25 / radiusPx) << "a quarter of a pixel of the radius";
    }
  }
}

TEST(BallDetection, ShadedBallWithNoise_IsFoundToATenthOfAPixel)
{
  Photograph how;
  how.noise = 2;
  for (const NamedCamera& named : { Webcam, Laparoscope })
  {
    for (const double radiusPx : { 8.0, 30.0, 90.0 })
    {
      SCOPED_TRACE(named.name + ", " + std::to_string(radiusPx) + " px");
      const Accuracy accuracy = measure(named, radiusPx, true, how);
      EXPECT_LT(accuracy.meanPx, 0.06);
      EXPECT_LT(accuracy.worstPx, 0.1);
    }
  }
}

TEST(BallDetection, SharpAndSoftOptics_ChangeLittle)
{
  for (const double blurPx : { 0.0, 1.5, 2.5 })
  {
    Photograph how;
    how.blurPx = blurPx;
    EXPECT_LT(measure(Webcam, 30, false, how).meanPx, 0.05) << blurPx;
  }
}

TEST(BallDetection, CenterIsNotTheOutlinesCentroid)
{
  // Near and off the axis the two are px apart; this is what the cone is for.
  RenderedBall ball;
  ball.center_Camera = Eigen::Vector3d(55, 30, 130);
  ball.radiusMm = 25;
  const BallDetection found = detectBall(SphereScene(webcam()).add(ball).photograph(), webcam(), 25);
  ASSERT_EQ(found.status, Status::Found) << found.message;
  EXPECT_TRUE(pointNear(found.ball_Image, centerOf(webcam(), ball), 0.05));
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& edge : found.outline_Image)
  {
    centroid += edge / double(found.outline_Image.size());
  }
  EXPECT_GT((centroid - centerOf(webcam(), ball)).norm(), 1.5);
}

TEST(BallDetection, Result_IsConsistentInItself)
{
  const RenderedBall ball = ballSeenAt(laparoscope(), 0.3, 0.62, 40);
  const BallDetection found = detectBall(SphereScene(laparoscope()).add(ball).photograph(), laparoscope(), ball.radiusMm);
  ASSERT_TRUE(found.isFound());
  EXPECT_NEAR(found.ray_Camera.norm(), 1, 1e-12);
  EXPECT_TRUE(pointNear(found.ball_Image, laparoscope().project(found.ray_Camera).point_Image, 1e-9));
  EXPECT_TRUE(pointNear(found.ray_Camera, ball.center_Camera.normalized(), 1e-4));
  EXPECT_NEAR(found.radiusPx, 40, 3) << "the apparent radius, at this place of this lens";
  EXPECT_GT(found.confidence, 0.9);
  EXPECT_LE(found.confidence, 1);
  EXPECT_GT(found.outline_Image.size(), 50U);
  EXPECT_GT(found.covariance_Image.determinant(), 0);
  EXPECT_LT(found.covariance_Image.trace(), 0.05);
  EXPECT_FALSE(found.message.empty());
}

TEST(BallDetection, PartlyHiddenBall_IsFoundAsPreciselyAsAWholeOne)
{
  struct Case
  {
    double chord;        ///< where the block begins, in radii from the centre
    double minimumFill;  ///< the default asks for three quarters of the disc in the ball's colour
  };
  for (const Case& hidden : { Case{ 0.6, BallDetectionOptions().minimumFill }, Case{ 0.12, 0.4 } })
  {
    for (const double radiusPx : { 18.0, 45.0 })
    {
      const RenderedBall ball = ballSeenAt(webcam(), 0.45, 0.55, radiusPx);
      const Eigen::Vector2d center = centerOf(webcam(), ball);
      const int reach = int(2 * radiusPx), x = int(center.x()), y = int(center.y());
      const int chord = int(std::ceil(hidden.chord * radiusPx));
      BallDetectionOptions options;
      options.minimumFill = hidden.minimumFill;
      for (const cv::Rect& block :
        { cv::Rect(x + chord, y - reach, reach, 2 * reach), cv::Rect(x - reach, y - reach - chord, 2 * reach, reach) })
      {
        const cv::Mat image = SphereScene(webcam()).add(ball).cover(block).photograph();
        const BallDetection found = detectBall(image, webcam(), ball.radiusMm, options);
        ASSERT_EQ(found.status, Status::Found) << found.message << ", hidden from " << hidden.chord << " radii";
        EXPECT_TRUE(pointNear(found.ball_Image, center, 0.08));
        EXPECT_NEAR(found.visibleShare, 1 - std::acos(hidden.chord) / EIGEN_PI, 0.1);
      }
    }
  }
}

TEST(BallDetection, BallCutByTheImageBorder_IsFound)
{
  for (const auto& [x, y] : { std::pair(0.01, 0.5), std::pair(0.98, 0.4), std::pair(0.6, 0.99), std::pair(0.03, 0.035) })
  {
    const RenderedBall ball = ballSeenAt(webcam(), x, y, 35);
    const BallDetection found = detectBall(SphereScene(webcam()).add(ball).photograph(), webcam(), ball.radiusMm);
    ASSERT_EQ(found.status, Status::Found) << x << ", " << y << ": " << found.message;
    EXPECT_TRUE(pointNear(found.ball_Image, centerOf(webcam(), ball), 0.25)) << x << ", " << y;
    EXPECT_LT(found.visibleShare, 0.8);
  }
}

TEST(BallDetection, ShaftInTheBallsOwnColor_DoesNotDrawTheCentre)
{
  const RenderedBall ball = ballSeenAt(webcam(), 0.5, 0.45, 30);
  const Eigen::Vector2d center = centerOf(webcam(), ball);
  SphereScene scene(webcam());
  scene.add(ball).cover({ int(center.x()) - 8, int(center.y()), 16, 150 }, BallRed);
  const BallDetection found = detectBall(scene.photograph(), webcam(), ball.radiusMm);
  ASSERT_EQ(found.status, Status::Found) << found.message;
  EXPECT_TRUE(pointNear(found.ball_Image, center, 0.15));
}

TEST(BallDetection, Highlight_IsPartOfTheBall)
{
  RenderedBall ball = ballSeenAt(webcam(), 0.5, 0.45, 40);
  ball.isShaded = true;
  const Eigen::Vector2d center = centerOf(webcam(), ball);
  SphereScene scene(webcam());
  scene.add(ball);
  cv::circle(scene.light(), { int(center.x()) - 14, int(center.y()) - 16 }, 9, cv::Scalar(0.95, 0.95, 0.95), cv::FILLED);
  const BallDetection found = detectBall(scene.photograph(), webcam(), ball.radiusMm);
  ASSERT_EQ(found.status, Status::Found) << found.message;
  EXPECT_TRUE(pointNear(found.ball_Image, center, 0.08));
}

TEST(BallDetection, RedRingBesideTheBall_IsNotTaken)
{
  for (const double ballRadiusPx : { 14.0, 30.0 })
  {
    const RenderedBall ball = ballSeenAt(webcam(), 0.3, 0.4, ballRadiusPx);
    SphereScene scene(webcam());
    scene.add(ball);
    cv::circle(scene.light(), { 430, 260 }, 45, cv::Scalar(0.02, 0.015, 0.55), 10, cv::LINE_AA);
    const BallDetection found = detectBall(scene.photograph(), webcam(), ball.radiusMm);
    ASSERT_EQ(found.status, Status::Found) << found.message;
    EXPECT_TRUE(pointNear(found.ball_Image, centerOf(webcam(), ball), 0.08));
  }
}

TEST(BallDetection, OtherRedThings_AreNoBall)
{
  SphereScene scene(webcam());
  cv::circle(scene.light(), { 430, 260 }, 45, cv::Scalar(0.02, 0.015, 0.55), 10, cv::LINE_AA);
  scene.cover({ 60, 60, 120, 70 }, BallRed);
  const BallDetection found = detectBall(scene.photograph(), webcam(), 15);
  EXPECT_FALSE(found.isFound()) << found.ball_Image.transpose() << ", confidence " << found.confidence;
}

TEST(BallDetection, NoBall_IsNotFound)
{
  Photograph noisy;
  noisy.noise = 5;
  for (const Light& light : { TableGrey, Light(0, 0, 0), Light(1, 1, 1), GloveBlue })
  {
    const BallDetection found = detectBall(SphereScene(webcam(), light).photograph(noisy), webcam(), 15);
    EXPECT_EQ(found.status, Status::NotFound);
    EXPECT_TRUE(says(found.message, { "no ball" }));
  }
  RenderedBall blue = ballSeenAt(webcam(), 0.5, 0.5, 40);
  blue.color = GloveBlue;
  EXPECT_EQ(detectBall(SphereScene(webcam()).add(blue).photograph(), webcam(), 15).status, Status::NotFound);
}

TEST(BallDetection, BallOfAnotherColor_IsFoundWhereThatIsAskedFor)
{
  RenderedBall blue = ballSeenAt(webcam(), 0.5, 0.5, 40);
  blue.color = Light(0.55F, 0.03F, 0.02F);
  BallDetectionOptions options;
  options.color.hueDeg = 240;
  const BallDetection found = detectBall(SphereScene(webcam()).add(blue).photograph(), webcam(), blue.radiusMm, options);
  ASSERT_EQ(found.status, Status::Found) << found.message;
  EXPECT_TRUE(pointNear(found.ball_Image, centerOf(webcam(), blue), 0.05));
}

TEST(BallDetection, TwoEqualBalls_AreSeveral)
{
  const RenderedBall left = ballSeenAt(webcam(), 0.3, 0.5, 30), right = ballSeenAt(webcam(), 0.7, 0.5, 30);
  const BallDetection found = detectBall(SphereScene(webcam()).add(left).add(right).photograph(), webcam(), 15);
  EXPECT_EQ(found.status, Status::SeveralBalls);
  EXPECT_TRUE(says(found.message, { "2 things", "ball" }));
}

TEST(BallDetection, BallAllButHidden_IsTooLittleVisible)
{
  const RenderedBall ball = ballSeenAt(webcam(), 0.5, 0.5, 60);
  const Eigen::Vector2d center = centerOf(webcam(), ball);
  // A frame of gloves leaves the middle and a piece of the outline.
  SphereScene scene(webcam());
  scene.add(ball).cover({ 0, 0, 640, int(center.y()) - 30 }).cover({ int(center.x()) + 25, 0, 640, 480 });
  scene.cover({ 0, int(center.y()) + 25, 640, 480 });
  const BallDetection found = detectBall(scene.photograph(), webcam(), ball.radiusMm);
  EXPECT_FALSE(found.isFound()) << found.visibleShare;
}

TEST(BallDetection, BallBelowTheSmallestRadius_IsNotFound)
{
  const RenderedBall ball = ballSeenAt(webcam(), 0.5, 0.5, 12);
  const cv::Mat image = SphereScene(webcam()).add(ball).photograph();
  BallDetectionOptions options;
  options.minimumRadiusPx = 18;
  EXPECT_TRUE(detectBall(image, webcam(), ball.radiusMm).isFound());
  EXPECT_FALSE(detectBall(image, webcam(), ball.radiusMm, options).isFound());
}
