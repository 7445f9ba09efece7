// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures that are not as they should be, each with its right answer, "no" among them. Before a grey table and in cluttered rooms.
#include "BallDetection.h"
#include "ConditionScene.h"
#include "GeometryMatchers.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Status = BallDetection::Status;

constexpr double Pi = double(EIGEN_PI);
constexpr double BallRadiusMm = 15;
/// An error this many times its standard deviation, in two dimensions, comes once in 3000 pictures.
constexpr double LargestMahalanobis = 4;

struct Place
{
  RenderedBall ball;
  Eigen::Vector2d center_Image;
  double radiusPx;
};

Place placeOf(double xShare, double yShare, double radiusPx)
{
  RenderedBall ball = ballSeenAt(webcam(), xShare, yShare, radiusPx, BallRadiusMm);
  ball.isShaded = true;
  return { ball, webcam().project(ball.center_Camera).point_Image, radiusPx };
}

BallDetection detect(const cv::Mat& image)
{
  return detectBall(image, webcam(), BallRadiusMm);
}

double sigmaPx(const BallDetection& found)
{
  return std::sqrt(found.covariance_Image.trace() / 2);
}

double errorPx(const BallDetection& found, const Place& place)
{
  return (found.ball_Image - place.center_Image).norm();
}

/// The error is one that the covariance owns up to.
::testing::AssertionResult isHonest(const BallDetection& found, const Place& place)
{
  const Eigen::Vector2d error = found.ball_Image - place.center_Image;
  const double distance = std::sqrt(error.dot(found.covariance_Image.inverse() * error));
  if (distance <= LargestMahalanobis)
  {
    return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure() << error.norm() << " px off, " << distance << " times the standard deviation of "
                                       << sigmaPx(found) << " px";
}

void expectFound(const BallDetection& found, const Place& place, double tolerancePx)
{
  if (!found.isFound())
  {
    ADD_FAILURE() << "not found: " << found.message;
    return;
  }
  EXPECT_LT(errorPx(found, place), tolerancePx);
  EXPECT_TRUE(isHonest(found, place));
}

/// The cases of a condition: every background, with its name for a failure's message.
class BallConditions : public ::testing::TestWithParam<Background>
{
protected:
  ConditionScene scene() const { return ConditionScene(GetParam()); }
  bool isCluttered() const { return GetParam().clutterSeed != 0; }
};

std::string nameOf(const ::testing::TestParamInfo<Background>& info)
{
  std::string name = info.param.name;
  name[name.find(' ')] = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, BallConditions, ::testing::ValuesIn(ConditionScene::backgrounds()), nameOf);

}  // namespace

TEST_P(BallConditions, MotionBlur_IsOwnedUpToOrRefused)
{
  for (const double radiusPx : { 18.0, 32.0, 60.0 })
  {
    const Place place = placeOf(0.46, 0.52, radiusPx);
    const BallDetection sharp = detect(scene().add(place.ball).photograph());
    ASSERT_TRUE(sharp.isFound()) << sharp.message;
    for (const double lengthPx : { 2.0, 4.0, 7.0, 10.0, 15.0 })
    {
      for (const double angle : { 0.0, 0.7, 1.9 })
      {
        SCOPED_TRACE("radius " + std::to_string(int(radiusPx)) + " px, blur " + std::to_string(int(lengthPx)) + " px at " +
          std::to_string(angle) + " rad");
        const Eigen::Vector2d motionPx = lengthPx * Eigen::Vector2d(std::cos(angle), std::sin(angle));
        const BallDetection found = detect(scene().add(place.ball, motionPx).photograph());
        if (!found.isFound())
        {
          EXPECT_GT(lengthPx, 4) << "a hand that is nearly still must not be refused: " << found.message;
          continue;
        }
        EXPECT_TRUE(isHonest(found, place));
        EXPECT_TRUE(lengthPx > 4 || errorPx(found, place) < 0.3) << errorPx(found, place) << " px off";
        if (lengthPx >= 7)
        {
          EXPECT_GT(sigmaPx(found), sigmaPx(sharp)) << "a smeared outline is a worse one";
        }
      }
    }
  }
}

TEST_P(BallConditions, MotionOfManyPixels_IsCalledBlurred)
{
  const Place place = placeOf(0.46, 0.52, 60);
  for (const double angle : { 0.0, 0.7, 1.9 })
  {
    const Eigen::Vector2d motionPx = 14 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const BallDetection found = detect(scene().add(place.ball, motionPx).photograph());
    EXPECT_EQ(found.status, Status::Blurred) << angle << " rad: " << found.message;
    EXPECT_TRUE(found.isFound() || says(found.message, { "hold the ball" }));
  }
}

TEST_P(BallConditions, OverExposed_RedIsClippedAndTheCenterStays)
{
  for (const double radiusPx : { 18.0, 32.0, 60.0 })
  {
    const Place place = placeOf(0.55, 0.47, radiusPx);
    for (const double exposure : { 2.0, 4.0 })
    {
      SCOPED_TRACE("radius " + std::to_string(int(radiusPx)) + " px, " + std::to_string(int(exposure)) + " times the light");
      const BallDetection found = detect(scene().add(place.ball).photograph(exposure));
      expectFound(found, place, 0.3);
    }
  }
}

TEST_P(BallConditions, LargeHighlight_IsPartOfTheBall)
{
  for (const double radiusPx : { 24.0, 32.0, 60.0 })
  {
    const Place place = placeOf(0.55, 0.47, radiusPx);
    // Within the ball; and reaching its outline.
    for (const double offset : { 0.3, 0.62 })
    {
      SCOPED_TRACE("radius " + std::to_string(int(radiusPx)) + " px, highlight at " + std::to_string(offset) + " of it");
      const Eigen::Vector2d highlight = place.center_Image + offset * radiusPx * Eigen::Vector2d(-0.6, -0.8);
      const cv::Mat image = scene().add(place.ball).disc(highlight, 0.42 * radiusPx, LampWhite).photograph(1.5);
      const BallDetection found = detect(image);
      expectFound(found, place, 0.3);
    }
  }
}

TEST_P(BallConditions, WashedOutToWhite_IsNotFound)
{
  const Place place = placeOf(0.55, 0.47, 32);
  const BallDetection found = detect(scene().add(place.ball).photograph(100));
  EXPECT_EQ(found.status, Status::NotFound) << found.message;
}

TEST_P(BallConditions, Dim_IsFoundAsLongAsThereIsColor)
{
  for (const double radiusPx : { 18.0, 32.0, 60.0 })
  {
    const Place place = placeOf(0.42, 0.55, radiusPx);
    for (const double exposure : { 0.5, 0.25, 0.12 })
    {
      SCOPED_TRACE("radius " + std::to_string(int(radiusPx)) + " px, " + std::to_string(exposure) + " of the light");
      const BallDetection found = detect(scene().add(place.ball).photograph(exposure, 2));
      expectFound(found, place, 0.4);
    }
  }
}

TEST_P(BallConditions, NearlyDark_IsNotFound)
{
  const Place place = placeOf(0.42, 0.55, 32);
  const BallDetection found = detect(scene().add(place.ball).photograph(0.002, 2));
  EXPECT_EQ(found.status, Status::NotFound) << found.message;
}

TEST_P(BallConditions, HalfHidden_IsFoundWhereTheBallIs)
{
  for (const double radiusPx : { 18.0, 32.0, 60.0 })
  {
    const Place place = placeOf(0.48, 0.5, radiusPx);
    for (const double visibleShare : { 0.75, 0.6, 0.5 })
    {
      for (const double angle : { 0.3, 1.8, 4.2 })
      {
        SCOPED_TRACE("radius " + std::to_string(int(radiusPx)) + " px, " + std::to_string(visibleShare) +
          " of the outline is seen, hand from " + std::to_string(angle) + " rad");
        ConditionScene picture = scene();
        picture.add(place.ball).hand(place.center_Image, radiusPx, visibleShare, angle);
        const BallDetection found = detect(picture.photograph());
        expectFound(found, place, 0.3);
        EXPECT_TRUE(!found.isFound() || std::abs(found.visibleShare - visibleShare) < 0.12) << found.visibleShare;
      }
    }
  }
}

TEST_P(BallConditions, FingerAcrossTheBall_IsNoPartOfIt)
{
  for (const double radiusPx : { 18.0, 32.0, 60.0 })
  {
    SCOPED_TRACE("radius " + std::to_string(int(radiusPx)) + " px");
    const Place place = placeOf(0.48, 0.5, radiusPx);
    const Eigen::Vector2d tip = place.center_Image - 0.35 * radiusPx * Eigen::Vector2d(0.9, 0.4);
    const Eigen::Vector2d knuckle = place.center_Image + 3 * radiusPx * Eigen::Vector2d(0.9, 0.4);
    const cv::Mat image = scene().add(place.ball).finger(tip, knuckle, int(0.6 * radiusPx), GloveBlue).photograph();
    const BallDetection found = detect(image);
    expectFound(found, place, 0.3);
  }
}

TEST_P(BallConditions, AllButHidden_IsNoAnswer)
{
  for (const double radiusPx : { 18.0, 32.0, 60.0 })
  {
    const Place place = placeOf(0.48, 0.5, radiusPx);
    for (const double visibleShare : { 0.22, 0.12 })
    {
      SCOPED_TRACE("radius " + std::to_string(int(radiusPx)) + " px, " + std::to_string(visibleShare) + " is seen");
      ConditionScene picture = scene();
      picture.add(place.ball).hand(place.center_Image, radiusPx, visibleShare, 1.1);
      const BallDetection found = detect(picture.photograph());
      EXPECT_FALSE(found.isFound()) << errorPx(found, place) << " px off";
      EXPECT_NE(found.status, Status::SeveralBalls);
    }
  }
}

TEST_P(BallConditions, TwoEqualBalls_AreSeveral)
{
  for (const double radiusPx : { 18.0, 32.0, 60.0 })
  {
    SCOPED_TRACE("radius " + std::to_string(int(radiusPx)) + " px");
    const Place left = placeOf(0.27, 0.45, radiusPx), right = placeOf(0.71, 0.52, radiusPx);
    const BallDetection found = detect(scene().add(left.ball).add(right.ball).photograph());
    EXPECT_EQ(found.status, Status::SeveralBalls) << found.message << ", " << found.ball_Image.transpose();
  }
}

TEST_P(BallConditions, TwoBallsSideBySide_AreSeveral)
{
  const Place left = placeOf(0.42, 0.5, 34), right = placeOf(0.53, 0.5, 34);
  const BallDetection found = detect(scene().add(left.ball).add(right.ball).photograph());
  EXPECT_EQ(found.status, Status::SeveralBalls) << found.message << ", " << found.ball_Image.transpose();
}

TEST_P(BallConditions, OneBallMuchCloser_IsTheOneWhereTheWorkingRangeSaysSo)
{
  for (const double furtherPx : { 9.0, 16.0 })
  {
    SCOPED_TRACE("the further one has " + std::to_string(int(furtherPx)) + " px");
    const Place near = placeOf(0.27, 0.45, 64), far = placeOf(0.75, 0.52, furtherPx);
    const cv::Mat image = scene().add(near.ball).add(far.ball).photograph();
    const BallDetection either = detect(image);
    // In clutter the small one may look so much less like a ball that there is no doubt; it is never the one that is taken.
    EXPECT_TRUE(either.status == Status::SeveralBalls || (isCluttered() && errorPx(either, near) < 0.3)) << either.message;
    BallDetectionOptions options;
    options.furthestMm = 1.2 * near.ball.center_Camera.norm();
    expectFound(detectBall(image, webcam(), BallRadiusMm, options), near, 0.3);
  }
}

TEST_P(BallConditions, FarBallAmongManyLargerRedPatches_IsFound)
{
  for (const double radiusPx : { 9.0, 14.0 })
  {
    SCOPED_TRACE("radius " + std::to_string(int(radiusPx)) + " px");
    const Place place = placeOf(0.52, 0.48, radiusPx);
    ConditionScene picture = scene();
    for (int i = 0; i < 14; ++i)
    {
      const Eigen::Vector2d center(60 + 85 * (i % 7), i < 7 ? 70 : 410), a(26, 4 + i % 3), b(-7, 22);
      picture.polygon({ center + a + b, center + a - b, center - a - b, center - a + b }, BallRed * (i % 2 == 0 ? 1.0F : 0.7F));
    }
    const BallDetection found = detect(picture.add(place.ball).photograph());
    expectFound(found, place, 0.3);
  }
}

TEST_P(BallConditions, OneBallMoreThanHalfHidden_TheOtherIsTheOne)
{
  const Place whole = placeOf(0.27, 0.45, 32), hidden = placeOf(0.73, 0.52, 32);
  ConditionScene picture = scene();
  picture.add(whole.ball).add(hidden.ball).hand(hidden.center_Image, 32, 0.38, 0.5);
  const BallDetection found = detect(picture.photograph());
  expectFound(found, whole, 0.3);
}

TEST_P(BallConditions, NoBall_IsNotFound)
{
  for (unsigned seed = 1; seed <= 3; ++seed)
  {
    const BallDetection found = detect(scene().photograph(1, 1.5, seed));
    EXPECT_EQ(found.status, Status::NotFound) << found.message << " at " << found.ball_Image.transpose();
  }
}

TEST_P(BallConditions, RedRings_AreNoBall)
{
  for (const double radiusPx : { 12.0, 25.0, 45.0, 80.0 })
  {
    const int widthPx = std::max(3, int(0.2 * radiusPx));
    const cv::Mat image = scene().ring({ 330.3, 251.6 }, radiusPx, widthPx, BallRed).photograph();
    const BallDetection found = detect(image);
    EXPECT_FALSE(found.isFound()) << radiusPx << " px, confidence " << found.confidence;
  }
}

TEST_P(BallConditions, SmallRedRingsBehindAHand_AreNoBall)
{
  for (const double radiusPx : { 6.0, 8.0, 11.0 })
  {
    for (const int coveredPx : { 0, 2, 4 })
    {
      const double left = 330.3 + radiusPx - coveredPx, top = 230, right = left + 60, bottom = 275;
      const BallDetection found =
        detect(scene()
                 .ring({ 330.3, 251.6 }, radiusPx, std::max(2, int(0.3 * radiusPx)), BallRed)
                 .polygon({ { left, top }, { right, top }, { right, bottom }, { left, bottom } }, GloveBlue)
                 .photograph());
      EXPECT_FALSE(found.isFound()) << radiusPx << " px, " << coveredPx << " px covered, confidence " << found.confidence;
    }
  }
}

TEST_P(BallConditions, RedSquare_IsNoBall)
{
  for (const double halfPx : { 10.0, 30.0, 70.0 })
  {
    for (const double angle : { 0.0, 0.4 })
    {
      const Eigen::Vector2d center(310.4, 226.7), a = halfPx * Eigen::Vector2d(std::cos(angle), std::sin(angle)), b(-a.y(), a.x());
      const cv::Mat image =
        scene().polygon({ center + a + b, center + a - b, center - a - b, center - a + b }, BallRed).photograph();
      const BallDetection found = detect(image);
      EXPECT_FALSE(found.isFound()) << halfPx << " px, " << angle << " rad, confidence " << found.confidence;
    }
  }
}

TEST_P(BallConditions, RedOval_IsNoBall)
{
  for (const double lengthening : { 1.25, 1.6, 2.5 })
  {
    const cv::Size halfAxes(int(28 * lengthening), 28);
    const BallDetection found = detect(scene().ellipse({ 310.4, 226.7 }, halfAxes, 25, BallRed).photograph());
    EXPECT_FALSE(found.isFound()) << lengthening << ", confidence " << found.confidence;
  }
}

TEST_P(BallConditions, PinkTissue_IsNoBall)
{
  ConditionScene picture = scene();
  picture.disc({ 210.2, 180.8 }, 45, TissuePink).ellipse({ 430.5, 300.1 }, { 90, 60 }, 30, TissuePink);
  const BallDetection found = detect(picture.photograph());
  EXPECT_EQ(found.status, Status::NotFound) << found.message << " at " << found.ball_Image.transpose();
}

TEST_P(BallConditions, RedGlove_IsNoBall)
{
  for (const double size : { 150.0, 230.0 })
  {
    const BallDetection found = detect(scene().glove({ 320, 440 }, size, BallRed).photograph());
    EXPECT_FALSE(found.isFound()) << size << " px, confidence " << found.confidence << " at " << found.ball_Image.transpose();
  }
}

TEST_P(BallConditions, RedFingertips_AreNoBall)
{
  for (const int widthPx : { 50, 90 })
  {
    ConditionScene picture = scene();
    picture.finger({ 250.3, 200.2 }, { 210, 470 }, widthPx, BallRed).finger({ 400.3, 180.2 }, { 430, 470 }, widthPx, BallRed);
    const BallDetection found = detect(picture.photograph());
    EXPECT_FALSE(found.isFound()) << widthPx << " px, confidence " << found.confidence << " at " << found.ball_Image.transpose();
  }
}

TEST_P(BallConditions, BallHeldByARedGlove_IsFound)
{
  const Place place = placeOf(0.5, 0.45, 34);
  ConditionScene picture = scene();
  picture.glove({ 430, 475 }, 130, BallRed * 0.7F).add(place.ball);
  const BallDetection found = detect(picture.photograph());
  expectFound(found, place, 0.3);
}

TEST(BallConditionsRendered, FramesWithoutBall_AreNotFound)
{
  const std::vector<PictureWithoutBall> pictures = picturesWithoutBall();
  ASSERT_EQ(pictures.size(), 8U);
  for (const PictureWithoutBall& picture : pictures)
  {
    const BallDetection found = detectBall(picture.image, picture.camera, BallRadiusMm);
    EXPECT_FALSE(found.isFound()) << found.message << " at " << found.ball_Image.transpose();
  }
}

TEST(BallConditionsRendered, ClutteredCollages_HaveNoBall)
{
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    const BallDetection found = detect(clutter({ 640, 480 }, seed));
    EXPECT_FALSE(found.isFound()) << "collage " << seed << ": " << found.message << " at " << found.ball_Image.transpose();
  }
}
