// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeGuidance.h"

#include "GeometryMatchers.h"
#include "HandEyePrediction.h"
#include "RegistrationProblems.h"
#include "SphereCone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Places = std::vector<Eigen::Vector3d>;

HandEyeGuidanceOptions optionsOf(const EvaluationCamera& view)
{
  HandEyeGuidanceOptions options;
  options.nearestMm = view.nearestMm;
  options.furthestMm = view.furthestMm;
  return options;
}

Places guided(const EvaluationCamera& view, int count)
{
  Places places;
  while (int(places.size()) < count)
  {
    places.push_back(suggestPlacement(places, { view.camera }, optionsOf(view)).ball_Camera);
  }
  return places;
}

double largestError(const Places& places, const EvaluationCamera& view)
{
  Places more = places;
  return suggestPlacement(more, { view.camera }, optionsOf(view)).maximumPx;
}

}  // namespace

TEST(HandEyeGuidance, Placements_AreInsideTheImageAndTheDepths)
{
  for (const EvaluationCamera& view : evaluationCameras())
  {
    Places places;
    for (int i = 0; i < 12; ++i)
    {
      const HandEyeGuidance next = suggestPlacement(places, { view.camera }, optionsOf(view));
      ASSERT_NE(next.status, HandEyeGuidance::Status::NoPlace);
      EXPECT_TRUE(pointNear(next.ball_Camera, *pointSeenAt({ view.camera }, next.ball_Image, next.ball_Camera.z()), 1e-6));
      EXPECT_GE(next.ball_Image.x(), 0.1 * view.camera.width() - 1);
      EXPECT_LE(next.ball_Image.y(), 0.9 * view.camera.height());
      EXPECT_GE(next.ball_Camera.z(), view.nearestMm - 1e-9);
      EXPECT_LE(next.ball_Camera.z(), view.furthestMm + 1e-9);
      EXPECT_TRUE(says(next.message, { " at the ", " px), ", "mm away" }));
      for (const Eigen::Vector3d& earlier : places)
      {
        EXPECT_GE((earlier - next.ball_Camera).norm(), 15);
      }
      places.push_back(next.ball_Camera);
    }
  }
}

TEST(HandEyeGuidance, NearBalls_AreSeenWhole)
{
  constexpr double ballRadiusMm = 15;
  for (const EvaluationCamera& view : evaluationCameras())
  {
    HandEyeGuidanceOptions options = optionsOf(view);
    options.ballRadiusMm = ballRadiusMm;
    Places places;
    for (int i = 0; i < 15; ++i)
    {
      const HandEyeGuidance next = suggestPlacement(places, { view.camera }, options);
      ASSERT_NE(next.status, HandEyeGuidance::Status::NoPlace);
      places.push_back(next.ball_Camera);
      const double distance = next.ball_Camera.norm();
      const SphereCone cone{ next.ball_Camera / distance, std::asin(ballRadiusMm / distance) };
      for (const Eigen::Vector2d& point : cone.outline(view.camera, 90).points_Image)
      {
        EXPECT_GE(point.x(), 0) << next.message;
        EXPECT_GE(point.y(), 0) << next.message;
        EXPECT_LE(point.x(), view.camera.width() - 1) << next.message;
        EXPECT_LE(point.y(), view.camera.height() - 1) << next.message;
      }
    }
  }
}

TEST(HandEyeGuidance, EachPlacement_DoesWhatItSays)
{
  const EvaluationCamera view = evaluationCameras().front();
  Places places = guided(view, 5);
  for (int i = 0; i < 5; ++i)
  {
    const HandEyeGuidance next = suggestPlacement(places, { view.camera }, optionsOf(view));
    places.push_back(next.ball_Camera);
    EXPECT_NEAR(largestError(places, view) / next.maximumAfterPx, 1, 1e-6);
    EXPECT_LT(next.maximumAfterPx, next.maximumPx);
    EXPECT_NEAR(next.gain, 1 - next.maximumAfterPx / next.maximumPx, 1e-9);
  }
}

TEST(HandEyeGuidance, TenGuidedPlacements_BeatFifteenRandomOnes)
{
  for (const EvaluationCamera& view : evaluationCameras())
  {
    Random random(1);
    double randomSquares = 0;
    for (int run = 0; run < 40; ++run)
    {
      Places places;
      for (int i = 0; i < 15; ++i)
      {
        places.push_back(randomPointInView(view.camera, { view.nearestMm, view.furthestMm, 0.1, 0, 0 }, random));
      }
      randomSquares += std::pow(largestError(places, view), 2) / 40;
    }
    EXPECT_LT(largestError(guided(view, 10), view), std::sqrt(randomSquares)) << view.name;
  }
}

TEST(HandEyeGuidance, BallsInOneCorner_AskForAnother)
{
  const EvaluationCamera view = evaluationCameras().front();
  Random random(2);
  Places places;
  for (int i = 0; i < 8; ++i)
  {
    places.push_back(*pointSeenAt({ view.camera }, { random.uniform(20, 120), random.uniform(20, 100) }, random.uniform(200, 500)));
  }
  const HandEyeGuidance next = suggestPlacement(places, { view.camera }, optionsOf(view));
  EXPECT_TRUE(next.isWorthwhile());
  EXPECT_GT((next.ball_Image - Eigen::Vector2d(70, 60)).norm(), 250);
  EXPECT_GT(next.gain, 0.3);
}

TEST(HandEyeGuidance, ManyPlacements_AreEnough)
{
  const EvaluationCamera view = evaluationCameras().front();
  Random random(3);
  Places places;
  for (int i = 0; i < 80; ++i)
  {
    places.push_back(randomPointInView(view.camera, { view.nearestMm, view.furthestMm, 0.05, 0, 0 }, random));
  }
  const HandEyeGuidance next = suggestPlacement(places, { view.camera }, optionsOf(view));
  EXPECT_EQ(next.status, HandEyeGuidance::Status::Enough) << next.gain;
  EXPECT_TRUE(says(next.message, { "hardly worth while", "5 %" }));
}

TEST(HandEyeGuidance, BadInput_ThrowsASentence)
{
  const Eye eye{ webcam() };
  expectInvalidArgument([&] { (void)suggestPlacement({ { 0, 0, 200 }, { 0, std::nan(""), 200 } }, eye); }, { "ball 2", "finite" });
  expectInvalidArgument([&] { (void)suggestPlacement({ { 0, 0, -200 } }, eye); }, { "ball 1", "in front" });
  HandEyeGuidanceOptions options;
  options.furthestMm = options.nearestMm;
  expectInvalidArgument([&] { (void)suggestPlacement({}, eye, options); }, { "guidance options", "depths" });
  options = {};
  options.borderShare = 0.5;
  expectInvalidArgument([&] { (void)suggestPlacement({}, eye, options); }, { "border" });
}

TEST(HandEyePrediction, MonteCarlo_AgreesInMmAndPx)
{
  const EvaluationCamera view = evaluationCameras().front();
  Random random(4);
  Places places;
  for (int i = 0; i < 15; ++i)
  {
    places.push_back(randomPointInView(view.camera, { view.nearestMm, view.furthestMm, 0.05, 0, 0 }, random));
  }
  const Eigen::Isometry3d truth = random.rigid(100);
  const Eigen::Vector2d pixels[] = { { 319, 239 }, { 10, 10 }, { 630, 470 } };
  for (const Eigen::Vector2d& pixel : pixels)
  {
    const Eigen::Vector3d target_Camera = *pointSeenAt({ view.camera }, pixel, 400);
    double mm = 0, px = 0, predictedMm = 0, predictedPx = 0;
    for (int run = 0; run < 400; ++run)
    {
      const HandEyeCalibrationResult result = calibrateHandEye(samplesAt(view, truth, places, random), { { view.camera } },
        evaluationOptions(PointLineOptions::Method::MaximumLikelihood));
      const Eigen::Isometry3d cameraToEstimate = result.markerToCamera * truth.inverse();
      const Eigen::Vector3d shown = cameraToEstimate * target_Camera;
      mm += (shown - target_Camera).squaredNorm();
      px += (view.camera.project(shown).point_Image - pixel).squaredNorm();
      predictedMm += std::pow(predictTargetErrorMm(result.covariance, target_Camera), 2);
      predictedPx += std::pow(*predictProjectionErrorPx(result.covariance, { view.camera }, pixel, 400), 2);
    }
    // 400 runs scatter by about 3 %, a little more where one axis dominates.
    EXPECT_NEAR(std::sqrt(predictedMm / mm), 1, 0.12) << pixel.transpose();
    EXPECT_NEAR(std::sqrt(predictedPx / px), 1, 0.12) << pixel.transpose();
  }
}

TEST(HandEyePrediction, WeakestFreedom_IsNamed)
{
  Eigen::Matrix<double, 6, 1> variances;
  variances << 1e-8, 1e-8, 1e-8, 0.01, 0.01, 4;
  EXPECT_TRUE(says(describeWeakestFreedom(variances.asDiagonal(), 400), { "along the line of sight", "2.0 mm at 400 mm" }));
  variances << 1e-8, 1e-8, 1e-4, 0.01, 0.01, 0.01;
  EXPECT_TRUE(says(describeWeakestFreedom(variances.asDiagonal(), 400), { "roll" }));
}

TEST(HandEyePrediction, OutsideOfTheLens_ThereIsNoError)
{
  const CameraModel camera = barrel();
  EXPECT_FALSE(predictProjectionErrorPx(Covariance6::Identity(), { camera }, { 5000, 5000 }, 300).has_value());
}
