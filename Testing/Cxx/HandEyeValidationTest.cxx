// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeValidation.h"

#include "GeometryMatchers.h"
#include "Simulation.h"
#include "TestCameras.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace handeye;
using namespace handeye::test;

TEST(HandEyeValidation, Truth_HasNoError)
{
  Random random(1);
  const auto samples = simulateSamples(laparoscope(), typicalMarkerToCamera(), 10, {}, random);
  const HandEyeValidationResult result = validateHandEye(samples, laparoscope(), typicalMarkerToCamera());
  EXPECT_EQ(result.projectionErrorPx.count, 10);
  EXPECT_LT(result.projectionErrorPx.maximum, 1e-6);
}

TEST(HandEyeValidation, KnownShift_IsMeasuredInPixels)
{
  // Camera 2 mm off to the side: at 100 mm that is 13 px, at 400 mm a quarter of it.
  const Eigen::Isometry3d markerToCamera = makeRigid({ 0, 0, 0 }, { 2, 0, 0 });
  std::vector<HandEyeSample> samples(2);
  samples[0].frame = 4;
  samples[0].tip_Marker = { 0, 0, 100 };
  samples[1].frame = 9;
  samples[1].tip_Marker = { 0, 0, 400 };
  samples[0].ball_Image = samples[1].ball_Image = { 319.5, 239.5 };
  const HandEyeValidationResult result = validateHandEye(samples, pinhole(), markerToCamera);
  ASSERT_EQ(result.samples.size(), 2U);
  EXPECT_EQ(result.samples[0].frame, 4);
  EXPECT_TRUE(pointNear(result.samples[0].projected_Image, Eigen::Vector2d(332.5, 239.5), 1e-9));
  EXPECT_NEAR(result.samples[0].errorPx, 13, 1e-9);
  EXPECT_NEAR(result.samples[0].distanceMm, std::hypot(2, 100), 1e-9);
  EXPECT_NEAR(result.samples[1].errorPx, 3.25, 1e-9);
  EXPECT_NEAR(result.projectionErrorPx.mean, (13 + 3.25) / 2, 1e-9);
  EXPECT_NEAR(result.projectionErrorPx.rms, std::sqrt((169 + 3.25 * 3.25) / 2), 1e-9);
}

TEST(HandEyeValidation, BallThatDoesNotProject_IsListedAndNotCounted)
{
  std::vector<HandEyeSample> samples(3);
  samples[0].tip_Marker = { 0, 0, 300 };
  samples[1].tip_Marker = { 0, 0, -300 };
  samples[2].tip_Marker = { 900, 0, 300 };
  samples[0].ball_Image = samples[1].ball_Image = samples[2].ball_Image = { 320, 240 };
  const HandEyeValidationResult result = validateHandEye(samples, barrel(), Eigen::Isometry3d::Identity());
  ASSERT_EQ(result.samples.size(), 3U);
  EXPECT_EQ(result.samples[0].status, CameraModel::Status::Ok);
  EXPECT_EQ(result.samples[1].status, CameraModel::Status::BehindCamera);
  EXPECT_EQ(result.samples[2].status, CameraModel::Status::OutsideLensModel);
  EXPECT_EQ(result.projectionErrorPx.count, 1);
  EXPECT_LT(result.projectionErrorPx.maximum, 1);
}

TEST(HandEyeValidation, NoSamples_GiveNoNumbers)
{
  const HandEyeValidationResult result = validateHandEye({}, webcam(), typicalMarkerToCamera());
  EXPECT_TRUE(result.samples.empty());
  EXPECT_EQ(result.projectionErrorPx.count, 0);
}

TEST(HandEyeValidation, HeldOutSamples_HaveAboutTheErrorOfTheirNoise)
{
  Random random(5);
  SimulatedCapture capture;
  capture.segmentationSigmaPx = 0.5;
  const auto samples = simulateSamples(webcam(), typicalMarkerToCamera(), 400, capture, random);
  const Summary error = validateHandEye(samples, webcam(), typicalMarkerToCamera()).projectionErrorPx;
  EXPECT_NEAR(error.rms, 0.5 * std::sqrt(2.0), 0.05);
  EXPECT_NEAR(error.mean, 0.5 * std::sqrt(EIGEN_PI / 2), 0.05);
}
