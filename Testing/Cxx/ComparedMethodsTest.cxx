// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComparedMethods.h"

#include "CaptureSimulation.h"
#include "GeometryMatchers.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace handeye;
using namespace handeye::test;

namespace
{

const SimulatedSession Calibration(15, 1), Validation(12, 2);

std::vector<HandEyeSample> samplesOf(const SimulatedSession& session, double sigmaMm, double sigmaPx, unsigned seed)
{
  return toSamples(session.captured(sigmaMm, sigmaPx, seed));
}

const ComparedMethod& methodOf(const std::vector<ComparedMethod>& methods, const std::string& name)
{
  return *std::find_if(methods.begin(), methods.end(), [&](const ComparedMethod& method) { return method.name == name; });
}

}  // namespace

TEST(ComparedMethods, NoiseFree_AllRecoverTheTruth)
{
  const std::vector<HandEyeSample> samples = samplesOf(Calibration, 0, 0, 1);
  const std::vector<ComparedMethod> methods = ballMethods({ { samples, samples } }, Calibration.camera);
  ASSERT_EQ(methods.size(), 9U);
  for (const ComparedMethod& method : methods)
  {
    const MethodAnswer answer = method.calibrate(0);
    ASSERT_TRUE(answer.isUsable()) << method.name << ": " << answer.message;
    EXPECT_EQ(answer.sampleCount, 15);
    // EPnP of OpenCV 4.6 stops its own iteration before that.
    const double tolerance = method.name == "epnp" ? 1e-3 : method.name == "iterative" ? 1e-4 : 1e-6;
    EXPECT_TRUE(rigid3dNear(*answer.markerToCamera, Calibration.markerToCamera, tolerance, 300 * tolerance)) << method.name;
  }
}

TEST(ComparedMethods, NoiseFree_ErrorsAreNone)
{
  const std::vector<HandEyeSample> samples = samplesOf(Calibration, 0, 0, 1);
  ComparisonOptions options;
  options.subsetRepetitions = 2;
  const ComparisonResult result = compareMethods(
    ballMethods({ { samples, {} } }, Calibration.camera), samplesOf(Validation, 0, 0, 1), Calibration.camera, options);
  ASSERT_EQ(result.methods.size(), 8U) << "nothing by the paper's segmentation, no row for it";
  for (const MethodResult& method : result.methods)
  {
    ASSERT_TRUE(method.isUsable()) << method.name << ": " << method.message;
    EXPECT_LT(method.errorPx.maximum, 1e-2) << method.name;
    EXPECT_EQ(method.subsets.front().sampleCount, 3);
    EXPECT_EQ(method.subsets.front().usable, 0) << "three points have several answers: " << method.name;
    EXPECT_EQ(method.subsets.back().usable, 2) << method.name;
  }
}

TEST(ComparedMethods, Noise_MoreSamplesAreBetter)
{
  const SimulatedSession many(30, 8);
  const ComparisonResult result =
    compareMethods(ballMethods({ { samplesOf(many, 0.3, 0.3, 3), {} } }, many.camera), samplesOf(Validation, 0, 0, 1), many.camera);
  const MethodResult& ml = result.methods.front();
  ASSERT_EQ(ml.name, "ml");
  ASSERT_EQ(ml.subsets.back().sampleCount, 30);
  EXPECT_GT(ml.subsets[2].medianPx, 1.5 * ml.subsets.back().medianPx) << "5 samples against 30";
  EXPECT_LE(ml.subsets[2].lowestPx, ml.subsets[2].medianPx);
  EXPECT_GE(ml.subsets[2].highestPx, ml.subsets[2].medianPx);
  EXPECT_EQ(ml.repeatability.calibrations, 10) << "five times two halves";
  EXPECT_TRUE(ml.repeatability.areHalves);
}

TEST(ComparedMethods, WrongSample_IsLeftOutByOursAndKeptByThePaper)
{
  std::vector<HandEyeSample> samples = samplesOf(Calibration, 0.1, 0.1, 1);
  samples[4].ball_Image += Eigen::Vector2d(60, -40);
  samples[4].ray_Eye = Calibration.camera.unproject(samples[4].ball_Image).ray_Camera;
  const std::vector<ComparedMethod> methods = ballMethods({ { samples, samples } }, Calibration.camera);
  const MethodAnswer ours = methodOf(methods, "ml").calibrate(0), paper = methodOf(methods, "as-published").calibrate(0);
  EXPECT_EQ(ours.usedCount, 14);
  EXPECT_EQ(paper.usedCount, 15);
  EXPECT_EQ(methodOf(methods, "ml").subsetPool, 14) << "small subsets are not decided by the wrong sample";
  EXPECT_EQ(methodOf(methods, "as-published").subsetPool, 15);
}

TEST(ComparedMethods, TooFew_IsARefusalWithItsReason)
{
  std::vector<HandEyeSample> samples = samplesOf(Calibration, 0, 0, 1);
  samples.resize(5);
  const ComparisonResult result =
    compareMethods(ballMethods({ { samples, {} } }, Calibration.camera), samplesOf(Validation, 0, 0, 1), Calibration.camera);
  for (const MethodResult& method : result.methods)
  {
    EXPECT_EQ(method.status, "too_few_samples") << method.name;
    EXPECT_FALSE(method.message.empty());
  }
  EXPECT_EQ(result.status, "no_method");
}

TEST(ComparedMethods, NoCapture_NoMethods)
{
  EXPECT_TRUE(ballMethods({}, Calibration.camera).empty());
}
