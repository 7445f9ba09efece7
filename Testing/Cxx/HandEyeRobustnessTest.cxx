// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GeometryMatchers.h"
#include "HandEyeCalibration.h"
#include "Simulation.h"
#include "TestCameras.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Samples = std::vector<HandEyeSample>;
using Status = HandEyeCalibrationResult::Status;

SimulatedCapture typicalCapture()
{
  return { 150, 700, 0.08, 0.35, 0.25 };
}

/// What goes wrong in an operating room: a red glove was taken for the ball, or the stylus' marker was half hidden.
void spoil(HandEyeSample& sample, const CameraModel& camera, Random& random)
{
  if (random.uniform(0, 1) < 0.5)
  {
    const double side = random.uniform(0, 1) < 0.5 ? -1 : 1;
    sample.ball_Image += side * Eigen::Vector2d(random.uniform(40, 150), random.uniform(-100, 100));
    sample.ray_Eye = camera.unproject(sample.ball_Image).ray_Camera;
  }
  else
  {
    // Across the line of sight: what is along it, a camera does not see.
    const Eigen::Vector3d ray_Marker = typicalMarkerToCamera().linear().transpose() * sample.ray_Eye;
    sample.tip_Marker += random.uniform(25, 80) * ray_Marker.cross(random.direction()).normalized();
  }
}

std::set<int> rejectedOf(const HandEyeCalibrationResult& result)
{
  std::set<int> rejected;
  for (std::size_t i = 0; i < result.samples.size(); ++i)
  {
    if (!result.samples[i].used)
    {
      rejected.insert(int(i));
    }
  }
  return rejected;
}

/// A sample of a ball at this place of the camera, with the usual noise.
HandEyeSample sampleAt(const Eigen::Vector3d& ball_Camera, Random& random)
{
  const Eigen::Vector3d tip_Marker = typicalMarkerToCamera().inverse() * ball_Camera + random.normal3(0.35);
  return makeSample(0, ball_Camera, { webcam() }, 0, tip_Marker, 0.25, random);
}

}  // namespace

/// The camera file of another camera, or of another zoom, is what a poor calibration most often rests on: it must not be a puzzle.
TEST(HandEyeRobustness, CameraFileOfAnotherZoom_IsNamed)
{
  for (const double factor : { 0.85, 0.93, 1.08, 1.15 })
  {
    Random random(11);
    const auto samples = simulateSamples(webcam(), typicalMarkerToCamera(), 15, typicalCapture(), random);
    const CameraModel right = webcam();
    Eigen::Matrix3d cameraMatrix = right.cameraMatrix();
    cameraMatrix.topLeftCorner<2, 2>() *= factor;
    const CameraModel wrong(right.width(), right.height(), cameraMatrix, right.distortionCoefficients());
    Samples seen = samples;
    for (HandEyeSample& sample : seen)
    {
      sample.ray_Eye = wrong.unproject(sample.ball_Image).ray_Camera;
    }
    const HandEyeCalibrationResult result = calibrateHandEye(seen, { { wrong } });
    EXPECT_TRUE(result.isLensSuspect) << factor << ": " << result.message;
    EXPECT_NE(result.message.find("focal length"), std::string::npos) << factor << ": " << result.message;
    EXPECT_FALSE(calibrateHandEye(samples, { { right } }).isLensSuspect);
  }
}

TEST(HandEyeRobustness, CleanSamples_AreAllUsed)
{
  for (unsigned seed = 0; seed < 8; ++seed)
  {
    Random random(100 + seed);
    const auto samples = simulateSamples(webcam(), typicalMarkerToCamera(), 14, typicalCapture(), random);
    const HandEyeCalibrationResult result = calibrateHandEye(samples, { { webcam() } });
    ASSERT_EQ(result.status, Status::Ok) << result.message;
    EXPECT_EQ(result.usedCount, 14) << "seed " << seed;
    EXPECT_TRUE(rigid3dNear(result.markerToCamera, typicalMarkerToCamera(), 0.006, 3));
    EXPECT_TRUE(says(result.message, { "px predicted", "14 of 14 samples used" }));
  }
}

TEST(HandEyeRobustness, ThirtyPercentGrossOutliers_AreRejectedAndListed)
{
  for (unsigned seed = 0; seed < 12; ++seed)
  {
    Random random(200 + seed);
    Samples samples = simulateSamples(webcam(), typicalMarkerToCamera(), 15, typicalCapture(), random);
    std::set<int> wrong;
    while (wrong.size() < 5)
    {
      const int i = random.integer(0, 14);
      if (wrong.insert(i).second)
      {
        spoil(samples[std::size_t(i)], webcam(), random);
      }
    }
    Samples good;
    for (int i = 0; i < 15; ++i)
    {
      if (!wrong.count(i))
      {
        good.push_back(samples[std::size_t(i)]);
      }
    }
    const HandEyeCalibrationResult result = calibrateHandEye(samples, { { webcam() } });
    ASSERT_EQ(result.status, Status::Ok) << "seed " << seed << ": " << result.message;
    EXPECT_EQ(rejectedOf(result), wrong) << "seed " << seed;
    EXPECT_EQ(result.usedCount, 10);
    const HandEyeCalibrationResult without = calibrateHandEye(good, { { webcam() } });
    EXPECT_TRUE(rigid3dNear(result.markerToCamera, without.markerToCamera, 1e-9, 1e-6)) << "they have no say";
    for (int i : wrong)
    {
      EXPECT_GT(result.samples[std::size_t(i)].residualPx, 5) << "a person can see why";
    }
  }
}

TEST(HandEyeRobustness, StylusBumpedByFourMillimetres_IsRejected)
{
  for (unsigned seed = 0; seed < 8; ++seed)
  {
    Random random(400 + seed);
    Samples samples = simulateSamples(webcam(), typicalMarkerToCamera(), 14, typicalCapture(), random);
    const Eigen::Vector3d ray_Marker = typicalMarkerToCamera().linear().transpose() * samples[5].ray_Eye;
    samples[5].tip_Marker += 4 * ray_Marker.unitOrthogonal();
    const HandEyeCalibrationResult result = calibrateHandEye(samples, { { webcam() } });
    ASSERT_EQ(result.status, Status::Ok) << result.message;
    EXPECT_EQ(rejectedOf(result), (std::set<int>{ 5 })) << "seed " << seed;
  }
}

TEST(HandEyeRobustness, RejectionTurnedOff_KeepsEverySample)
{
  Random random(3);
  Samples samples = simulateSamples(webcam(), typicalMarkerToCamera(), 15, typicalCapture(), random);
  samples[4].tip_Marker += Eigen::Vector3d(60, 0, 0);
  HandEyeCalibrationOptions options;
  options.rejectOutliers = false;
  const HandEyeCalibrationResult result = calibrateHandEye(samples, { { webcam() } }, options);
  EXPECT_EQ(result.usedCount, 15);
  EXPECT_GT(result.reprojectionRmsPx, 3);
}

TEST(HandEyeRobustness, SamplesThatDoNotBelongTogether_AreNotUsable)
{
  Random random(4);
  Samples samples = simulateSamples(webcam(), typicalMarkerToCamera(), 14, typicalCapture(), random);
  for (HandEyeSample& sample : samples)
  {
    sample.tip_Marker = random.uniform3(300);
  }
  const HandEyeCalibrationResult result = calibrateHandEye(samples, { { webcam() } });
  EXPECT_TRUE(result.status == Status::NoConsensus || result.status == Status::PoorFit) << toString(result.status);
  EXPECT_TRUE(says(result.message, { "samples", "stylus" }));
}

TEST(HandEyeRobustness, HalfOfTheSamplesAfterTheMarkerSlipped_AreNotUsable)
{
  Random random(41);
  const Eigen::Isometry3d slip = makeRigid({ 0.1, -0.15, 0.2 }, { 25, 10, -5 });
  Samples samples = simulateSamples(webcam(), typicalMarkerToCamera(), 14, typicalCapture(), random);
  for (std::size_t i = 6; i < samples.size(); ++i)
  {
    samples[i].tip_Marker = (i % 2 ? slip : slip.inverse()) * samples[i].tip_Marker;
  }
  const HandEyeCalibrationResult result = calibrateHandEye(samples, { { webcam() } });
  EXPECT_FALSE(result.isUsable()) << result.message;
  EXPECT_TRUE(says(result.message, {}));
}

TEST(HandEyeRobustness, GrossErrorsInARowAtTheStart_AreLeftOutAndNoSlip)
{
  Random random(43);
  Samples samples = simulateSamples(webcam(), typicalMarkerToCamera(), 15, typicalCapture(), random);
  const Eigen::Vector3d errors[] = { { 60, -20, 10 }, { -35, 50, 40 }, { 15, 70, -60 }, { -80, -10, 25 } };
  for (std::size_t i = 0; i < 4; ++i)
  {
    samples[i].tip_Marker += errors[i];
  }
  const HandEyeCalibrationResult result = calibrateHandEye(samples, { { webcam() } });
  ASSERT_TRUE(result.isUsable()) << toString(result.status) << ": " << result.message;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    EXPECT_EQ(result.samples[i].used, i >= 4) << i;
  }
}

TEST(HandEyeRobustness, MarkerThatSlippedNearTheEnd_IsReported)
{
  Random random(42);
  Samples samples = simulateSamples(webcam(), typicalMarkerToCamera(), 15, typicalCapture(), random);
  for (std::size_t i = 10; i < samples.size(); ++i)
  {
    samples[i].tip_Marker = makeRigid({ 0.05, -0.1, 0.08 }, { 9, -6, 4 }) * samples[i].tip_Marker;
  }
  const HandEyeCalibrationResult result = calibrateHandEye(samples, { { webcam() } });
  EXPECT_EQ(result.status, Status::MarkerMoved) << toString(result.status) << ": " << result.message;
  EXPECT_TRUE(says(result.message, { "5 samples in a row", "slipped" }));
}

TEST(HandEyeRobustness, ApparentSizeThatDoesNotFit_IsReported)
{
  for (const double scale : { 1.3, 1.0, 0.75 })
  {
    Random random(43);
    Samples samples = simulateSamples(webcam(), typicalMarkerToCamera(), 12, typicalCapture(), random);
    for (HandEyeSample& sample : samples)
    {
      const Eigen::Vector3d tip_Camera = typicalMarkerToCamera() * sample.tip_Marker;
      sample.apparentDistanceMm = scale * tip_Camera.norm();
    }
    const HandEyeCalibrationResult result = calibrateHandEye(samples, { { webcam() } });
    EXPECT_EQ(result.status, scale == 1 ? Status::Ok : Status::WrongScale) << scale << ": " << result.message;
    EXPECT_TRUE(scale == 1 || says(result.message, { "apparent size", "radius" }));
  }
}

TEST(HandEyeRobustness, BallHeldStillForManyFrames_CountsAsOnePlace)
{
  Random random(44);
  const auto places = simulateSamples(webcam(), typicalMarkerToCamera(), 12, typicalCapture(), random);
  Samples few, many;
  for (int repeat = 0; repeat < 5; ++repeat)
  {
    few.insert(few.end(), places.begin(), places.begin() + 4);
    many.insert(many.end(), places.begin(), places.end());
  }
  const HandEyeCalibrationResult fewPlaces = calibrateHandEye(few, { { webcam() } });
  EXPECT_EQ(fewPlaces.status, Status::TooFewSamples) << fewPlaces.message;
  EXPECT_TRUE(says(fewPlaces.message, { "4 places", "at least 6" }));
  const HandEyeCalibrationResult once = calibrateHandEye(places, { { webcam() } });
  const HandEyeCalibrationResult often = calibrateHandEye(many, { { webcam() } });
  ASSERT_TRUE(often.isUsable()) << often.message;
  EXPECT_EQ(often.placeCount, 12);
  EXPECT_EQ(often.usedCount, 60);
  EXPECT_NEAR(often.covariance.trace() / once.covariance.trace(), 1, 0.01) << "looking five times at the same tells no more";
}

TEST(HandEyeRobustness, TooFewSamples_AreReported)
{
  Random random(5);
  for (const int count : { 0, 3, 5 })
  {
    const auto samples = simulateSamples(webcam(), typicalMarkerToCamera(), count, typicalCapture(), random);
    const HandEyeCalibrationResult result = calibrateHandEye(samples, { { webcam() } });
    EXPECT_EQ(result.status, Status::TooFewSamples);
    EXPECT_TRUE(says(result.message, { "only " + std::to_string(count), "at least 6" }));
    EXPECT_EQ(int(result.samples.size()), count);
  }
}

TEST(HandEyeRobustness, BallsInOneCorner_AreTooUncertainOrSaidToBePoor)
{
  for (const double extentPx : { 50.0, 15.0 })
  {
    Random random(6);
    Samples samples;
    for (int i = 0; i < 12; ++i)
    {
      const double u = random.uniform(20, 20 + extentPx), v = random.uniform(20, 20 + extentPx);
      const Eigen::Vector3d ray_Camera = webcam().unproject({ u, v }).ray_Camera;
      samples.push_back(sampleAt(random.uniform(380, 420) * ray_Camera, random));
    }
    const HandEyeCalibrationResult result = calibrateHandEye(samples, { { webcam() } });
    if (extentPx > 20)
    {
      EXPECT_TRUE(says(result.message, { "poor", "px predicted" }));
      EXPECT_GT(result.predicted.meanPx, 5);
      EXPECT_FALSE(result.isUsable());
      EXPECT_TRUE(says(result.message, { "upper left of the image", "determine least", "pitch" }));
    }
    else
    {
      EXPECT_EQ(result.status, Status::TooUncertain) << toString(result.status) << ": " << result.message;
      EXPECT_TRUE(says(result.message, { "px of predicted error", "spread them" }));
    }
  }
}

TEST(HandEyeRobustness, BallsOnALine_AreNotUsable)
{
  Random random(7);
  Samples samples;
  for (int i = 0; i < 12; ++i)
  {
    samples.push_back(sampleAt(Eigen::Vector3d(-100, -60, 300) + random.uniform(0, 1) * Eigen::Vector3d(220, 130, 250), random));
  }
  const HandEyeCalibrationResult result = calibrateHandEye(samples, { { webcam() } });
  EXPECT_FALSE(result.isUsable()) << toString(result.status) << ": " << result.message;
  EXPECT_TRUE(says(result.message, {}));
}

TEST(HandEyeRobustness, BallAlwaysInTheSamePlace_IsNotUsable)
{
  Random random(8);
  Samples samples;
  for (int i = 0; i < 12; ++i)
  {
    samples.push_back(sampleAt({ 20, -10, 400 }, random));
  }
  const HandEyeCalibrationResult result = calibrateHandEye(samples, { { webcam() } });
  EXPECT_FALSE(result.isUsable()) << toString(result.status) << ": " << result.message;
  EXPECT_TRUE(says(result.message, {}));
}

TEST(HandEyeRobustness, NoiseFreeBallsOnALineOfSight_AreNotObservable)
{
  Random random(9);
  HandEyeCalibrationOptions options;
  options.rejectOutliers = false;
  Samples samples;
  for (int i = 0; i < 8; ++i)
  {
    const Eigen::Vector3d ball_Camera = (150 + 60 * i) * Eigen::Vector3d(0.1, -0.1, 1);
    const Eigen::Vector3d tip_Marker = typicalMarkerToCamera().inverse() * ball_Camera;
    samples.push_back(makeSample(i, ball_Camera, { webcam() }, 0, tip_Marker, 0, random));
  }
  const HandEyeCalibrationResult result = calibrateHandEye(samples, { { webcam() } }, options);
  EXPECT_EQ(result.status, Status::NotObservable) << result.message;
  EXPECT_TRUE(says(result.message, { "parallel" }));
}

TEST(HandEyeRobustness, ProcrustesAtItsCap_IsNotUsable)
{
  // The narrower the view, the slower the paper's iteration: 2 degrees take more than its 20,000 rounds.
  Random random(10);
  const CameraModel tele = makeCamera(640, 480, 18000, 18000, 319.5, 239.5, {});
  const auto samples = simulateSamples(tele, typicalMarkerToCamera(), 12, { 900, 1100, 0.08, 0, 0 }, random);
  HandEyeCalibrationOptions options;
  options.rejectOutliers = false;
  options.method = PointLineOptions::Method::Procrustes;
  const HandEyeCalibrationResult result = calibrateHandEye(samples, { { tele } }, options);
  EXPECT_FALSE(result.isUsable()) << result.iterations;
  EXPECT_TRUE(says(result.message, {}));
}

TEST(HandEyeRobustness, SameSamples_GiveTheSameResult)
{
  Random random(11);
  const auto samples = simulateSamples(webcam(), typicalMarkerToCamera(), 13, typicalCapture(), random);
  const HandEyeCalibrationResult first = calibrateHandEye(samples, { { webcam() } });
  const HandEyeCalibrationResult second = calibrateHandEye(samples, { { webcam() } });
  EXPECT_EQ(first.markerToCamera.matrix(), second.markerToCamera.matrix());
  EXPECT_EQ(first.covariance, second.covariance);
}

TEST(HandEyeRobustness, BadSamples_ThrowASentenceWithTheFrame)
{
  Random random(12);
  const auto good = simulateSamples(webcam(), typicalMarkerToCamera(), 8, {}, random);
  const auto expectRefused = [&](const std::function<void(HandEyeSample&)>& damage)
  {
    Samples samples = good;
    damage(samples[3]);
    samples[3].frame = 77;
    expectInvalidArgument([&] { (void)calibrateHandEye(samples, { { webcam() } }); }, { "frame 77", "finite", "eye" });
  };
  expectRefused([](HandEyeSample& sample) { sample.tip_Marker.z() = std::nan(""); });
  expectRefused([](HandEyeSample& sample) { sample.ball_Image.x() = INFINITY; });
  expectRefused([](HandEyeSample& sample) { sample.ray_Eye.setZero(); });
  expectRefused([](HandEyeSample& sample) { sample.eye = 1; });
  expectRefused([](HandEyeSample& sample) { sample.eye = -1; });
  expectInvalidArgument([&] { (void)calibrateHandEye(good, {}); }, { "no camera" });
}

TEST(HandEyeRobustness, BadOptions_ThrowASentence)
{
  const auto expectRefused = [&](const std::function<void(HandEyeCalibrationOptions&)>& damage)
  {
    HandEyeCalibrationOptions options;
    damage(options);
    expectInvalidArgument([&] { (void)calibrateHandEye({}, { { webcam() } }, options); }, { "hand-eye calibration options" });
  };
  expectRefused([](HandEyeCalibrationOptions& options) { options.trackingSigmaMm = -1; });
  expectRefused([](HandEyeCalibrationOptions& options) { options.segmentationSigmaPx = std::nan(""); });
  expectRefused([](HandEyeCalibrationOptions& options) { options.trackingSigmaMm = options.segmentationSigmaPx = 0; });
  expectRefused([](HandEyeCalibrationOptions& options) { options.minimumSamples = 3; });
  expectRefused([](HandEyeCalibrationOptions& options) { options.rejectionFactor = 1; });
  expectRefused([](HandEyeCalibrationOptions& options) { options.maximumRejectedShare = 1; });
  expectRefused([](HandEyeCalibrationOptions& options) { options.maximumMisfit = 0; });
  expectRefused([](HandEyeCalibrationOptions& options) { options.maximumScaleError = 0; });
  expectRefused([](HandEyeCalibrationOptions& options) { options.maximumPredictedErrorPx = 0; });
}

TEST(HandEyeRobustness, ToString_NamesEachStatusDifferently)
{
  std::set<std::string> names;
  for (const Status status :
    { Status::Ok, Status::TooFewSamples, Status::NoConsensus, Status::NotObservable, Status::NotConverged, Status::Mirrored,
      Status::Ambiguous, Status::PoorFit, Status::TooUncertain, Status::WrongScale, Status::MarkerMoved, Status::NotApplicable })
  {
    names.insert(toString(status));
  }
  EXPECT_EQ(names.size(), 12U);
  EXPECT_EQ(names.count("unknown"), 0U);
}
