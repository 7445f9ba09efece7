// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GeometryMatchers.h"
#include "HandEyePrediction.h"
#include "RegistrationProblems.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Samples = std::vector<HandEyeSample>;

const Eigen::Vector3d WrongBy_Stylus(0.8, -0.5, 1.1);

/// Samples whose tip is wrong by an offset that turns with the stylus.
Samples withWrongTip(const EvaluationCamera& view, const Eigen::Isometry3d& truth, int count, bool turning,
  const Eigen::Vector3d& wrongBy_Stylus, Random& random)
{
  Samples samples = simulateSamples(view.camera, truth, count, { view.nearestMm, view.furthestMm, 0.08, 0.1, 0.1 }, random);
  const Eigen::Matrix3d fixed = random.rotation();
  for (HandEyeSample& sample : samples)
  {
    sample.stylusToMarker = turning ? random.rotation() : fixed;
    sample.tip_Marker += sample.stylusToMarker * wrongBy_Stylus;
  }
  return samples;
}

HandEyeCalibrationOptions refining(double tipSigmaMm)
{
  HandEyeCalibrationOptions options = evaluationOptions(PointLineOptions::Method::MaximumLikelihood);
  options.trackingSigmaMm = options.segmentationSigmaPx = 0.1;
  options.tipCovariance_Stylus = tipSigmaMm * tipSigmaMm * Eigen::Matrix3d::Identity();
  options.refineTip = true;
  return options;
}

}  // namespace

TEST(HandEyeTip, WrongTipOfATurningStylus_IsFound)
{
  const EvaluationCamera view = evaluationCameras().front();
  Random random(1);
  const Eigen::Isometry3d truth = random.rigid(80);
  const Samples samples = withWrongTip(view, truth, 20, true, WrongBy_Stylus, random);
  HandEyeCalibrationOptions options = refining(1);
  const HandEyeCalibrationResult refined = calibrateHandEye(samples, { { view.camera } }, options);
  ASSERT_TRUE(refined.isUsable()) << refined.message;
  ASSERT_TRUE(refined.tipCorrection_Stylus.has_value()) << refined.tipMessage;
  EXPECT_TRUE(pointNear(*refined.tipCorrection_Stylus, -WrongBy_Stylus, 0.3));
  EXPECT_TRUE(says(refined.tipMessage, { "refined by", "standard error" }));
  options.refineTip = false;
  const HandEyeCalibrationResult plain = calibrateHandEye(samples, { { view.camera } }, options);
  EXPECT_FALSE(plain.tipCorrection_Stylus.has_value()) << "off by default";
  EXPECT_LT(refined.reprojectionRmsPx, 0.5 * plain.reprojectionRmsPx);
  EXPECT_LT(translationErrorMm(refined.markerToCamera, truth), translationErrorMm(plain.markerToCamera, truth));
}

TEST(HandEyeTip, StylusThatIsNeverTurned_DoesNotDetermineTheTip)
{
  const EvaluationCamera view = evaluationCameras().front();
  Random random(2);
  const Samples samples = withWrongTip(view, random.rigid(80), 15, false, WrongBy_Stylus, random);
  const HandEyeCalibrationResult result = calibrateHandEye(samples, { { view.camera } }, refining(1));
  EXPECT_FALSE(result.tipCorrection_Stylus.has_value());
  EXPECT_TRUE(says(result.tipMessage, { "not refined", "pivot calibration" }));
}

TEST(HandEyeTip, GoodPivotCalibration_IsNotReplaced)
{
  const EvaluationCamera view = evaluationCameras().front();
  Random random(3);
  const Samples samples = withWrongTip(view, random.rigid(80), 12, true, { 0, 0, 0 }, random);
  const HandEyeCalibrationResult result = calibrateHandEye(samples, { { view.camera } }, refining(0.01));
  EXPECT_FALSE(result.tipCorrection_Stylus.has_value());
}

TEST(HandEyeTip, UnknownTurns_AreSaidToBeMissing)
{
  const EvaluationCamera view = evaluationCameras().front();
  Random random(4);
  Samples samples = withWrongTip(view, random.rigid(80), 12, true, { 0, 0, 0 }, random);
  samples[3].stylusToMarker.setZero();
  const HandEyeCalibrationResult result = calibrateHandEye(samples, { { view.camera } }, refining(1));
  EXPECT_TRUE(says(result.tipMessage, { "not refined", "how the stylus was turned" }));
}

TEST(HandEyeTip, UncertainTip_IsInThePrediction)
{
  // One error of the tip in all samples: Monte Carlo over tips, against what the covariance says of it.
  const EvaluationCamera view = evaluationCameras().front();
  constexpr double tipSigmaMm = 1;
  HandEyeCalibrationOptions options = refining(tipSigmaMm);
  options.refineTip = false;
  options.maximumMisfit = 1e9;
  Random random(5);
  const Eigen::Vector3d target_Camera(20, -30, 400);
  for (const bool turning : { false, true })
  {
    double squares = 0, predicted = 0;
    int counted = 0;
    for (int run = 0; run < 300; ++run)
    {
      const Eigen::Isometry3d truth = random.rigid(80);
      const Samples samples = withWrongTip(view, truth, 12, turning, random.normal3(tipSigmaMm), random);
      HandEyeCalibrationOptions expecting = options;
      // A turning stylus scatters the samples: that must be expected, for otherwise it counts as misfit.
      expecting.trackingSigmaMm = turning ? 1.2 : 0.1;
      if (turning)
      {
        expecting.tipCovariance_Stylus.setZero();
      }
      const HandEyeCalibrationResult result = calibrateHandEye(samples, { { view.camera } }, expecting);
      ASSERT_TRUE(result.isUsable()) << result.message;
      const Eigen::Isometry3d cameraToEstimate = result.markerToCamera * truth.inverse();
      squares += (cameraToEstimate * target_Camera - target_Camera).squaredNorm();
      predicted += std::pow(predictTargetErrorMm(result.covariance, target_Camera), 2);
      ++counted;
    }
    EXPECT_NEAR(std::sqrt(predicted / squares), 1, turning ? 0.35 : 0.12) << "turning " << turning;
    if (!turning)
    {
      EXPECT_GT(std::sqrt(squares / counted), 0.9) << "it shifts everything with the tip";
    }
  }
}
