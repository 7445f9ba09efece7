// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeCalibration.h"

#include "GeometryMatchers.h"
#include "Simulation.h"
#include "TestCameras.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Method = PointLineOptions::Method;
using Status = HandEyeCalibrationResult::Status;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Without the search for samples that disagree, which takes most of the time and has its own tests.
HandEyeCalibrationOptions trusting()
{
  HandEyeCalibrationOptions options;
  options.rejectOutliers = false;
  return options;
}

/// The noise that the options' defaults expect.
SimulatedCapture noisy(double nearestMm, double furthestMm)
{
  SimulatedCapture capture;
  capture.nearestMm = nearestMm;
  capture.furthestMm = furthestMm;
  capture.trackingSigmaMm = 0.35;
  capture.segmentationSigmaPx = 0.25;
  return capture;
}

/// What brings the truth to the estimate from the left, as the covariance is defined: estimate = (exp(w), v) * truth.
Vector6 errorOf(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth)
{
  const Eigen::Isometry3d cameraToEstimate = estimate * truth.inverse();
  const Eigen::AngleAxisd turn(cameraToEstimate.linear());
  Vector6 error;
  error << turn.angle() * turn.axis(), cameraToEstimate.translation();
  return error;
}

/// The head's two eyes: the right one 60 mm to the right, toed in by 3 degrees.
std::vector<Eye> stereoHead()
{
  return { { webcam() }, { laparoscope(), makeRigid({ 0.01, 0.052, -0.004 }, { -60, 1, 3 }) } };
}

/// Both eyes' samples of the same balls.
std::vector<HandEyeSample> simulateStereo(
  const std::vector<Eye>& eyes, const Eigen::Isometry3d& markerToCamera, int count, const SimulatedCapture& capture, Random& random)
{
  std::vector<HandEyeSample> left, right;
  while (int(left.size()) < count)
  {
    const Eigen::Vector3d ball_Camera = randomPointInView(eyes[0].camera, capture, random);
    const CameraModel::Projection seen = eyes[1].camera.project(eyes[1].cameraToEye * ball_Camera);
    const bool isInImage =
      seen.isUsable() && seen.point_Image.minCoeff() > 0 && seen.point_Image.x() < 719 && seen.point_Image.y() < 575;
    if (isInImage)
    {
      const int frame = int(left.size());
      const Eigen::Vector3d tip_Marker = markerToCamera.inverse() * ball_Camera + random.normal3(capture.trackingSigmaMm);
      left.push_back(makeSample(frame, ball_Camera, eyes[0], 0, tip_Marker, capture.segmentationSigmaPx, random));
      right.push_back(makeSample(frame, ball_Camera, eyes[1], 1, tip_Marker, capture.segmentationSigmaPx, random));
    }
  }
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

}  // namespace

TEST(HandEyeCalibration, NoiseFree_RecoversTheTruthThroughEachLens)
{
  Random random(1);
  for (const NamedCamera& named : allCameras())
  {
    for (const Eigen::Isometry3d& truth :
      { typicalMarkerToCamera(), Eigen::Isometry3d::Identity(), makeRigid({ 0, EIGEN_PI, 0 }, { 5, 60, -20 }) })
    {
      const auto samples = simulateSamples(named.camera, truth, 12, {}, random);
      const HandEyeCalibrationResult result = calibrateHandEye(samples, { { named.camera } }, trusting());
      ASSERT_EQ(result.status, Status::Ok) << named.name << ": " << result.message;
      EXPECT_TRUE(rigid3dNear(result.markerToCamera, truth, 1e-9, 1e-8)) << named.name;
      EXPECT_LT(result.reprojectionRmsPx, 1e-6);
      EXPECT_LT(result.pointToLineRmsMm, 1e-8);
      EXPECT_EQ(result.usedCount, 12);
    }
  }
}

TEST(HandEyeCalibration, KnownPoint_GoesToItsPlaceInTheCamera)
{
  // A marker that hangs upside down (turned about x by 180 degrees), 50 mm above the camera.
  Random random(2);
  const Eigen::Isometry3d truth = makeRigid({ EIGEN_PI, 0, 0 }, { 0, -50, 0 });
  const auto samples = simulateSamples(webcam(), truth, 12, {}, random);
  const HandEyeCalibrationResult result = calibrateHandEye(samples, { { webcam() } }, trusting());
  EXPECT_TRUE(pointNear(result.markerToCamera * Eigen::Vector3d(10, 20, -300), Eigen::Vector3d(10, -70, 300), 1e-8));
}

TEST(HandEyeCalibration, NoiseToleranceTable_HoldsForEachMethod)
{
  struct Row
  {
    NamedCamera named;
    double nearestMm, furthestMm;
    double rotationRmsRad, translationRmsMm;  // over 40 runs of 14 samples
  };
  const Row rows[] = { { { "webcam", webcam() }, 150, 700, 0.0022, 1.0 },
    { { "laparoscope", laparoscope() }, 60, 250, 0.0045, 0.8 }, { { "passThrough", passThrough() }, 200, 600, 0.0016, 0.9 } };
  for (const Method method : { Method::Global, Method::Procrustes })
  {
    for (const Row& row : rows)
    {
      Random random(3);
      HandEyeCalibrationOptions options = trusting();
      options.method = method;
      double turned = 0, moved = 0;
      int usable = 0;
      for (int run = 0; run < 40; ++run)
      {
        const Eigen::Isometry3d truth = random.rigid(80);
        const auto samples = simulateSamples(row.named.camera, truth, 14, noisy(row.nearestMm, row.furthestMm), random);
        const HandEyeCalibrationResult result = calibrateHandEye(samples, { { row.named.camera } }, options);
        usable += result.isUsable() ? 1 : 0;
        turned += result.isUsable() ? std::pow(rotationErrorRad(result.markerToCamera, truth), 2) : 0;
        moved += result.isUsable() ? std::pow(translationErrorMm(result.markerToCamera, truth), 2) : 0;
      }
      const double slack = method == Method::Procrustes ? 1.3 : 1;  // it knows no weights
      SCOPED_TRACE(row.named.name + ", method " + std::to_string(int(method)));
      EXPECT_GE(usable, method == Method::Procrustes ? 36 : 40);  // now and then it ends mirrored
      EXPECT_LT(std::sqrt(turned / usable), slack * row.rotationRmsRad);
      EXPECT_LT(std::sqrt(moved / usable), slack * row.translationRmsMm);
    }
  }
}

TEST(HandEyeCalibration, Weights_BeatEqualOnesWhereTheNoiseGrowsWithDistance)
{
  // A soft image and a good tracker: far balls say less in mm.
  SimulatedCapture capture;
  capture.nearestMm = 100;
  capture.furthestMm = 1200;
  capture.trackingSigmaMm = 0.1;
  capture.segmentationSigmaPx = 1.5;
  HandEyeCalibrationOptions weighted = trusting();
  weighted.trackingSigmaMm = 0.1;
  weighted.segmentationSigmaPx = 1.5;
  HandEyeCalibrationOptions equal = weighted;
  equal.method = Method::Procrustes;  // the same cost, knowing no weights
  Random random(31);
  double withWeights = 0, without = 0;
  for (int run = 0; run < 40; ++run)
  {
    const Eigen::Isometry3d truth = random.rigid(80);
    const auto samples = simulateSamples(webcam(), truth, 14, capture, random);
    const HandEyeCalibrationResult a = calibrateHandEye(samples, { { webcam() } }, weighted);
    const HandEyeCalibrationResult b = calibrateHandEye(samples, { { webcam() } }, equal);
    if (b.isUsable())
    {
      withWeights += std::pow(translationErrorMm(a.markerToCamera, truth), 2);
      without += std::pow(translationErrorMm(b.markerToCamera, truth), 2);
    }
  }
  EXPECT_LT(std::sqrt(withWeights), 0.8 * std::sqrt(without));
}

TEST(HandEyeCalibration, PreciseSamples_CountMore)
{
  Random random(32);
  SimulatedCapture capture;
  auto samples = simulateSamples(webcam(), typicalMarkerToCamera(), 12, capture, random);
  for (std::size_t i = 0; i < 4; ++i)
  {
    samples[i].ball_Image += Eigen::Vector2d(6, -5);
    samples[i].ray_Eye = webcam().unproject(samples[i].ball_Image).ray_Camera;
  }
  const double equally =
    translationErrorMm(calibrateHandEye(samples, { { webcam() } }, trusting()).markerToCamera, typicalMarkerToCamera());
  for (std::size_t i = 0; i < 4; ++i)
  {
    samples[i].sigmaPx = 200;
  }
  const double bySigma =
    translationErrorMm(calibrateHandEye(samples, { { webcam() } }, trusting()).markerToCamera, typicalMarkerToCamera());
  EXPECT_GT(equally, 1);
  EXPECT_LT(bySigma, 0.02 * equally);
}

TEST(HandEyeCalibration, Covariance_IsHonest)
{
  for (const auto& [named, nearestMm, furthestMm] : { std::tuple(NamedCamera{ "webcam", webcam() }, 150.0, 700.0),
         std::tuple(NamedCamera{ "laparoscope", laparoscope() }, 60.0, 250.0) })
  {
    Random random(4);
    constexpr int runs = 150;
    double chiSquares = 0;
    int beyond99 = 0;
    for (int run = 0; run < runs; ++run)
    {
      const Eigen::Isometry3d truth = random.rigid(80);
      const auto samples = simulateSamples(named.camera, truth, 14, noisy(nearestMm, furthestMm), random);
      const HandEyeCalibrationResult result = calibrateHandEye(samples, { { named.camera } }, trusting());
      ASSERT_EQ(result.status, Status::Ok) << result.message;
      const Vector6 error = errorOf(result.markerToCamera, truth);
      const double chiSquare = error.dot(result.covariance.inverse() * error);
      chiSquares += chiSquare;
      beyond99 += chiSquare > 16.81 ? 1 : 0;
    }
    // Six degrees of freedom: the mean of 150 is 6 with a standard deviation of 0.28; scatter above the expected widens the
    // covariance.
    EXPECT_GT(chiSquares / runs, 4.5) << named.name;
    EXPECT_LT(chiSquares / runs, 7.5) << named.name;
    EXPECT_LE(beyond99, 8) << named.name;
  }
}

TEST(HandEyeCalibration, StereoCovariance_IsHonestAboutTheSharedTip)
{
  // Both eyes see the ball where the tracker is wrong by the same: two looks, one error.
  Random random(41);
  const auto eyes = stereoHead();
  constexpr int runs = 150;
  double chiSquares = 0;
  for (int run = 0; run < runs; ++run)
  {
    const Eigen::Isometry3d truth = random.rigid(80);
    const auto samples = simulateStereo(eyes, truth, 12, noisy(150, 700), random);
    const HandEyeCalibrationResult result = calibrateHandEye(samples, eyes, trusting());
    ASSERT_EQ(result.status, Status::Ok) << result.message;
    EXPECT_EQ(result.predictedByEye.size(), 2U);
    EXPECT_EQ(result.placeCount, 12);
    const Vector6 error = errorOf(result.markerToCamera, truth);
    chiSquares += error.dot(result.covariance.inverse() * error) / runs;
  }
  EXPECT_NEAR(chiSquares, 6, 1.2) << "six freedoms, a standard deviation of 0.28";
}

TEST(HandEyeCalibration, EstimatedNoise_IsThatOfTheCapture)
{
  Random random(42);
  double px = 0;
  for (int run = 0; run < 30; ++run)
  {
    HandEyeCalibrationOptions options = trusting();
    options.estimateNoise = true;
    SimulatedCapture capture = noisy(150, 700);
    capture.trackingSigmaMm *= 3;
    capture.segmentationSigmaPx *= 3;
    const auto samples = simulateSamples(webcam(), random.rigid(80), 20, capture, random);
    const HandEyeCalibrationResult result = calibrateHandEye(samples, { { webcam() } }, options);
    ASSERT_TRUE(result.isUsable()) << result.message;
    // The two are told apart poorly, what they amount to at 400 mm is not.
    px += std::hypot(result.segmentationSigmaPx, result.trackingSigmaMm * 602 / 400) / 30;
  }
  EXPECT_NEAR(px / (3 * std::hypot(0.25, 0.35 * 602 / 400)), 1, 0.08);
}

TEST(HandEyeCalibration, PredictedError_IsWhatNewPointsShow)
{
  Random random(5);
  const CameraModel camera = webcam();
  double predicted = 0, squares = 0;
  for (int run = 0; run < 60; ++run)
  {
    const Eigen::Isometry3d truth = random.rigid(80);
    const auto samples = simulateSamples(camera, truth, 14, noisy(150, 700), random);
    const HandEyeCalibrationResult result = calibrateHandEye(samples, { { camera } }, trusting());
    ASSERT_TRUE(result.isUsable());
    predicted += result.predicted.meanPx / 60;
    EXPECT_GE(result.predicted.maximumPx, result.predicted.meanPx);
    EXPECT_GT(result.predicted.furthestMm, result.predicted.nearestMm + 200);
    for (int i = 0; i < 50; ++i)
    {
      const Eigen::Vector3d point_Camera =
        randomPointInView(camera, { result.predicted.nearestMm, result.predicted.furthestMm, 0 }, random);
      const Eigen::Vector3d point_Marker = truth.inverse() * point_Camera;
      const Eigen::Vector2d shown = camera.project(result.markerToCamera * point_Marker).point_Image;
      squares += (shown - camera.project(point_Camera).point_Image).squaredNorm() / (60 * 50);
    }
  }
  EXPECT_NEAR(predicted / std::sqrt(squares), 1, 0.25);
}

TEST(HandEyeCalibration, LargerScatterThanExpected_WidensTheCovariance)
{
  const auto calibrateWith = [](double factor)
  {
    SimulatedCapture capture = noisy(150, 700);
    capture.trackingSigmaMm *= factor;
    capture.segmentationSigmaPx *= factor;
    Random random(6);
    const auto samples = simulateSamples(webcam(), typicalMarkerToCamera(), 14, capture, random);
    return calibrateHandEye(samples, { { webcam() } }, trusting());
  };
  const HandEyeCalibrationResult expected = calibrateWith(1), shaky = calibrateWith(3);
  EXPECT_NEAR(shaky.reprojectionRmsPx / expected.reprojectionRmsPx, 3, 1);
  // What is far beyond the expected noise is systematic: it does not average out over the samples.
  EXPECT_GT(std::sqrt(shaky.covariance.trace() / expected.covariance.trace()), 3);
  EXPECT_GT(shaky.predicted.meanPx, 3 * expected.predicted.meanPx);
  // Less scatter than expected is luck, or few samples: it does not narrow the covariance.
  EXPECT_NEAR(std::sqrt(calibrateWith(0.3).covariance.trace() / calibrateWith(0.03).covariance.trace()), 1, 0.05);
}

TEST(HandEyeCalibration, Residuals_AreThoseOfTheSamples)
{
  Random random(7);
  const CameraModel camera = webcam();
  const auto samples = simulateSamples(camera, typicalMarkerToCamera(), 12, noisy(150, 700), random);
  const HandEyeCalibrationResult result = calibrateHandEye(samples, { { camera } }, trusting());
  double squaresPx = 0, squaresMm = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    const Eigen::Vector3d tip_Camera = result.markerToCamera * samples[i].tip_Marker;
    const double px = (camera.project(tip_Camera).point_Image - samples[i].ball_Image).norm();
    const double mm = tip_Camera.cross(samples[i].ray_Eye).norm();
    EXPECT_NEAR(result.samples[i].residualPx, px, 1e-9);
    EXPECT_NEAR(result.samples[i].residualMm, mm, 1e-9);
    EXPECT_TRUE(result.samples[i].used);
    squaresPx += px * px;
    squaresMm += mm * mm;
  }
  EXPECT_NEAR(result.reprojectionRmsPx, std::sqrt(squaresPx / 12), 1e-9);
  EXPECT_NEAR(result.pointToLineRmsMm, std::sqrt(squaresMm / 12), 1e-9);
}

TEST(HandEyeCalibration, NewMarkerFrame_ChangesTheResultAlike)
{
  Random random(8);
  auto samples = simulateSamples(webcam(), typicalMarkerToCamera(), 12, noisy(150, 700), random);
  const HandEyeCalibrationResult plain = calibrateHandEye(samples, { { webcam() } }, trusting());
  const Eigen::Isometry3d markerToNewMarker = random.rigid(200);
  for (HandEyeSample& sample : samples)
  {
    sample.tip_Marker = markerToNewMarker * sample.tip_Marker;
  }
  const HandEyeCalibrationResult moved = calibrateHandEye(samples, { { webcam() } }, trusting());
  EXPECT_TRUE(rigid3dNear(moved.markerToCamera * markerToNewMarker, plain.markerToCamera, 1e-8, 1e-6));
  EXPECT_NEAR(moved.reprojectionRmsPx, plain.reprojectionRmsPx, 1e-7);
}

TEST(HandEyeCalibration, StereoNoiseFree_RecoversTheTruth)
{
  Random random(9);
  const auto eyes = stereoHead();
  const auto samples = simulateStereo(eyes, typicalMarkerToCamera(), 8, {}, random);
  const HandEyeCalibrationResult result = calibrateHandEye(samples, eyes, trusting());
  ASSERT_EQ(result.status, Status::Ok) << result.message;
  EXPECT_TRUE(rigid3dNear(result.markerToCamera, typicalMarkerToCamera(), 1e-9, 1e-8));
  EXPECT_EQ(result.samples.size(), 16U);
}

TEST(HandEyeCalibration, StereoWithAKnownRelation_BeatsOneEye)
{
  // The tracker's error is the same for both eyes: what the second one brings is its own, independent segmentation.
  SimulatedCapture capture = noisy(150, 700);
  capture.trackingSigmaMm = 0.1;
  capture.segmentationSigmaPx = 1;
  HandEyeCalibrationOptions options = trusting();
  options.trackingSigmaMm = 0.1;
  options.segmentationSigmaPx = 1;
  Random random(10);
  const auto eyes = stereoHead();
  double oneRad = 0, bothRad = 0, oneMm = 0, bothMm = 0;
  for (int run = 0; run < 40; ++run)
  {
    const Eigen::Isometry3d truth = random.rigid(80);
    const auto samples = simulateStereo(eyes, truth, 12, capture, random);
    const std::vector<HandEyeSample> leftOnly(samples.begin(), samples.begin() + 12);
    const HandEyeCalibrationResult both = calibrateHandEye(samples, eyes, options);
    const HandEyeCalibrationResult one = calibrateHandEye(leftOnly, eyes, options);
    ASSERT_TRUE(both.isUsable() && one.isUsable());
    oneRad += std::pow(rotationErrorRad(one.markerToCamera, truth), 2);
    bothRad += std::pow(rotationErrorRad(both.markerToCamera, truth), 2);
    oneMm += std::pow(translationErrorMm(one.markerToCamera, truth), 2);
    bothMm += std::pow(translationErrorMm(both.markerToCamera, truth), 2);
  }
  EXPECT_LT(std::sqrt(bothRad), 0.85 * std::sqrt(oneRad));
  EXPECT_LT(std::sqrt(bothMm), 0.85 * std::sqrt(oneMm));
}
