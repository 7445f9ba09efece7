// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallDetection.h"
#include "GeometryMatchers.h"
#include "SphereRenderer.h"
#include "TestCameras.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <set>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Status = BallDetection::Status;

class BallDetectionInput : public testing::Test
{
protected:
  const CameraModel camera = webcam();
  const RenderedBall ball = ballSeenAt(camera, 0.4, 0.6, 28);
  const SphereScene scene = SphereScene(camera).add(ball);
  const cv::Mat image = scene.photograph();
  const BallDetection plain = detectBall(image, camera, ball.radiusMm);

  void expectSame(const cv::Mat& other, double tolerancePx = 0) const
  {
    const BallDetection found = detectBall(other, camera, ball.radiusMm);
    ASSERT_EQ(found.status, Status::Found) << found.message;
    EXPECT_TRUE(pointNear(found.ball_Image, plain.ball_Image, tolerancePx));
    EXPECT_NEAR(found.radiusPx, plain.radiusPx, tolerancePx);
  }
};

}  // namespace

TEST_F(BallDetectionInput, Alpha_IsPassedOver)
{
  cv::Mat withAlpha;
  cv::cvtColor(image, withAlpha, cv::COLOR_BGR2BGRA);
  cv::Mat alpha(image.size(), CV_8U);
  cv::randu(alpha, 0, 256);
  cv::insertChannel(alpha, withAlpha, 3);
  expectSame(withAlpha);
}

TEST_F(BallDetectionInput, SixteenBits_OfTheSameValuesAreTheSame)
{
  cv::Mat wide;
  image.convertTo(wide, CV_16U, 257);
  expectSame(wide, 1e-4);  // the light of a value comes from another table, in single precision
  cv::Mat wideWithAlpha;
  cv::cvtColor(wide, wideWithAlpha, cv::COLOR_BGR2BGRA);
  expectSame(wideWithAlpha, 1e-4);
}

TEST_F(BallDetectionInput, SixteenBits_OfTheSceneAgree)
{
  Photograph how;
  how.type = CV_16UC3;
  const cv::Mat wide = scene.photograph(how);
  expectSame(wide, 0.02);
}

TEST_F(BallDetectionInput, PartOfALargerImage_IsTheSame)
{
  cv::Mat larger(image.rows + 37, image.cols + 53, CV_8UC3);
  cv::randu(larger, 0, 256);
  cv::Mat part = larger(cv::Rect({ 21, 11 }, image.size()));
  image.copyTo(part);
  ASSERT_FALSE(part.isContinuous());
  expectSame(part);
}

TEST_F(BallDetectionInput, Image_IsNotChangedAndTheAnswerIsAlwaysTheSame)
{
  const cv::Mat before = image.clone();
  expectSame(image);
  expectSame(image);
  EXPECT_EQ(cv::norm(before, image, cv::NORM_INF), 0);
}

TEST_F(BallDetectionInput, CameraWithoutImageSize_TakesAnyImage)
{
  const CameraModel sizeless(0, 0, camera.cameraMatrix(), camera.distortionCoefficients());
  const BallDetection found = detectBall(image, sizeless, ball.radiusMm);
  EXPECT_EQ(found.ball_Image, plain.ball_Image);
}

TEST_F(BallDetectionInput, BallRadius_ScalesTheDistanceAlone)
{
  const BallDetection larger = detectBall(image, camera, 3 * ball.radiusMm);
  EXPECT_EQ(larger.ball_Image, plain.ball_Image);
  EXPECT_NEAR(larger.distanceMm, 3 * plain.distanceMm, 1e-9);
}

TEST_F(BallDetectionInput, OtherImages_ThrowASentence)
{
  const CameraModel sizeless(0, 0, camera.cameraMatrix(), camera.distortionCoefficients());
  const auto expectRefused = [&](const cv::Mat& other, const CameraModel& lens, const std::vector<std::string>& words)
  {
    for (const auto method : { BallDetectionOptions::Method::Exact, BallDetectionOptions::Method::Hough })
    {
      BallDetectionOptions options;
      options.method = method;
      expectInvalidArgument([&] { (void)detectBall(other, lens, 15, options); }, words);
    }
  };
  expectRefused({}, sizeless, { "empty" });
  expectRefused({}, camera, { "0 x 0", "640 x 480" });
  expectRefused(cv::Mat(480, 640, CV_8UC1, cv::Scalar(90)), camera, { "1 channel", "colour" });
  expectRefused(cv::Mat(480, 640, CV_8UC2, cv::Scalar::all(90)), camera, { "2 channel" });
  expectRefused(cv::Mat(480, 640, CV_32FC3, cv::Scalar::all(0.5)), camera, { "8 nor 16 bits" });
  expectRefused(cv::Mat(720, 1280, CV_8UC3, cv::Scalar::all(90)), camera, { "1280 x 720", "640 x 480" });
  expectRefused(cv::Mat(640, 480, CV_8UC3, cv::Scalar::all(90)), camera, { "480 x 640" });
}

TEST_F(BallDetectionInput, BallRadiusThatIsNone_Throws)
{
  for (const double radius : { 0.0, -15.0, std::nan(""), std::numeric_limits<double>::infinity() })
  {
    expectInvalidArgument([&] { (void)detectBall(image, camera, radius); }, { "radius", "positive" });
  }
}

TEST_F(BallDetectionInput, OptionsThatMakeNoSense_Throw)
{
  const auto expectRefused = [&](const std::function<void(BallDetectionOptions&)>& damage, const std::string& word)
  {
    BallDetectionOptions options;
    damage(options);
    expectInvalidArgument([&] { (void)detectBall(image, camera, 15, options); }, { word });
  };
  expectRefused([](BallDetectionOptions& options) { options.minimumRadiusPx = 1; }, "radius");
  expectRefused([](BallDetectionOptions& options) { options.minimumVisibleShare = 1.5; }, "shares");
  expectRefused([](BallDetectionOptions& options) { options.minimumFill = std::nan(""); }, "shares");
  expectRefused([](BallDetectionOptions& options) { options.distinctionFactor = 0.9; }, "ball detection options");
  expectRefused([](BallDetectionOptions& options) { options.color.hueToleranceDeg = 0; }, "hue");
  expectRefused([](BallDetectionOptions& options) { options.color.minimumSaturation = -0.1; }, "shares");
}

TEST(BallDetectionSmallImages, AnyWeeImage_HasNoBall)
{
  for (const cv::Size& size : { cv::Size(1, 1), cv::Size(2, 30), cv::Size(30, 2), cv::Size(7, 7), cv::Size(20, 20) })
  {
    const CameraModel camera = makeCamera(size.width, size.height, 30, 30, size.width / 2.0, size.height / 2.0, {});
    const cv::Mat red(size, CV_8UC3, cv::Scalar(20, 15, 190));
    EXPECT_FALSE(detectBall(red, camera, 15).isFound()) << size;
  }
}

TEST(BallDetectionWords, ToString_NamesEachStatusDifferently)
{
  EXPECT_EQ(toString(Status::Found), "ok");
  std::set<std::string> names;
  for (const Status status : { Status::Found, Status::NotFound, Status::SeveralBalls, Status::TooLittleVisible })
  {
    names.insert(toString(status));
  }
  EXPECT_EQ(names.size(), 4U);
  EXPECT_EQ(names.count("unknown"), 0U);
}
