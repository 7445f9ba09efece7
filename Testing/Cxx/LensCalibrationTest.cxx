// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LensCalibration.h"

#include "BoardPattern.h"
#include "BoardPicture.h"
#include "BoardSimulation.h"
#include "GeometryMatchers.h"
#include "LensRepeatability.h"
#include "LensStereo.h"
#include "TestCameras.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace
{

using namespace handeye;
using namespace handeye::test;
using Status = LensCalibrationResult::Status;

CameraModel laparoscope4()
{
  return makeCamera(720, 576, 812.3, 826, 366.9, 281.4, { -0.251, 0.094, 0.0008, -0.001 });
}

CameraModel narrow8()
{
  return makeCamera(960, 720, 900, 902, 482, 355, { 0.1, -0.05, 0.0006, -0.0009, 0.01, 0.5, -0.02, 0.01 });
}

/// Wide: up to 60 degrees off the axis, where polynomials no longer follow a rational function.
CameraModel rational8()
{
  return makeCamera(960, 720, 640, 642, 482, 355, { 0.35, 0.02, 0.0006, -0.0009, 0, 0.7, 0.1, 0 });
}

/// Tilted to all sides and all over the image; ChArUco and simulated points may leave it.
BoardViews allAround(double nearestMm, double furthestMm)
{
  BoardViews views;
  views.nearestMm = nearestMm;
  views.furthestMm = furthestMm;
  views.tiltRad = 0.75;
  views.turnRad = 0.6;
  views.borderShare = 0.12;
  return views;
}

std::vector<LensView> simulate(const CameraModel& camera, const BoardDescription& board, int count, double sigmaPx, Random& random)
{
  std::vector<LensView> views;
  while (int(views.size()) < count)
  {
    const Eigen::Isometry3d boardToCamera = allAround(220, 420).pose(board, camera, random);
    LensView view = seenBoard(int(views.size()), board, camera, boardToCamera, sigmaPx, random);
    if (view.ids.size() >= 20)
    {
      views.push_back(std::move(view));
    }
  }
  return views;
}

LensCalibrationOptions with(int coefficients)
{
  LensCalibrationOptions options;
  options.coefficients = coefficients;
  return options;
}

double focalErrorPercent(const CameraModel& actual, const CameraModel& expected)
{
  return 100 * std::max(std::abs(actual.fx() / expected.fx() - 1), std::abs(actual.fy() / expected.fy() - 1));
}

const BoardDescription Chess = parseBoard("chessboard:9x6:20");

}  // namespace

TEST(LensCalibration, NoiseFree_FindsEachModel)
{
  for (const CameraModel& camera : { laparoscope4(), webcam(), narrow8() })
  {
    Random random(1);
    const int coefficients = int(camera.distortionCoefficients().size());
    const std::vector<LensView> views = simulate(camera, Chess, 20, 0, random);
    const LensCalibrationResult result = calibrateLens(views, camera.width(), camera.height(), with(coefficients));
    ASSERT_TRUE(result.isUsable()) << coefficients << ": " << result.message;
    // OpenCV keeps image points in single precision: 3e-5 px.
    EXPECT_LT(focalErrorPercent(*result.camera, camera), 1e-4) << coefficients;
    EXPECT_NEAR(result.camera->cx(), camera.cx(), 1e-3);
    EXPECT_NEAR(result.camera->cy(), camera.cy(), 1e-3);
    EXPECT_LT(result.rmsPx, 1e-4);
    EXPECT_EQ(result.supportedCoefficients, coefficients) << result.modelHint;
    // Whatever the coefficients are: a known ray is seen at the same place.
    const Eigen::Vector3d point_Camera(60, -40, 300);
    EXPECT_TRUE(pointNear(result.camera->project(point_Camera).point_Image, camera.project(point_Camera).point_Image, 1e-3));
  }
}

/// Standard deviations are those of the errors, for each parameter, over 40 calibrations from 0.2 px of noise.
TEST(LensCalibration, StandardDeviations_AreThoseOfTheErrors)
{
  const CameraModel camera = webcam();
  Random random(2);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(9);
  constexpr int Trials = 40;
  LensCalibrationOptions options;
  options.compareModels = false;
  for (int i = 0; i < Trials; ++i)
  {
    const LensCalibrationResult result = calibrateLens(simulate(camera, Chess, 15, 0.2, random), 640, 480, options);
    ASSERT_TRUE(result.isUsable()) << result.message;
    const CameraModel& found = *result.camera;
    const double errors[] = { found.fx() - camera.fx(), found.fy() - camera.fy(), found.cx() - camera.cx(),
      found.cy() - camera.cy() };
    for (int k = 0; k < 9; ++k)
    {
      const double error = k < 4
        ? errors[k]
        : found.distortionCoefficients()[std::size_t(k - 4)] - camera.distortionCoefficients()[std::size_t(k - 4)];
      const double sigma = k < 4 ? result.cameraMatrixSigmas(k) : result.coefficientSigmas[std::size_t(k - 4)];
      ASSERT_GT(sigma, 0);
      squares(k) += error * error / (sigma * sigma) / Trials;
    }
  }
  for (int k = 0; k < 9; ++k)
  {
    EXPECT_NEAR(std::sqrt(squares(k)), 1, 0.35) << "parameter " << k << ", 40 trials know it to 11 %";
  }
}

/// The hint asks for as many coefficients as the lens has, whatever was asked for.
TEST(LensCalibration, Hint_NamesTheModelThatTheDataSupport)
{
  struct Case
  {
    CameraModel camera;
    int supported;
  };
  for (const Case& each : { Case{ laparoscope4(), 4 }, Case{ rational8(), 8 } })
  {
    Random random(3);
    const std::vector<LensView> views = simulate(each.camera, Chess, 16, 0.1, random);
    for (const int asked : { 4, 5, 8 })
    {
      const LensCalibrationResult result = calibrateLens(views, each.camera.width(), each.camera.height(), with(asked));
      ASSERT_EQ(result.models.size(), 3U) << result.message;
      EXPECT_EQ(result.supportedCoefficients, each.supported) << asked;
      EXPECT_TRUE(says(result.modelHint, { std::to_string(each.supported) + " coefficients" }).operator bool() ||
        says(result.modelHint, { "with " + std::to_string(each.supported) }).operator bool())
        << result.modelHint;
    }
  }
}

/// Rendered boards of each kind, found by the detector: the focal length to a thousandth.
TEST(LensCalibration, RenderedBoards_GiveTheFocalLengthToAThousandth)
{
  const CameraModel camera = webcam();
  for (const char* text : { "chessboard:9x6:20", "charuco:9x6:24:18:DICT_5X5_50", "acircles:4x11:13", "circles:9x7:20" })
  {
    const BoardDescription board = parseBoard(text);
    const simulation::BoardPicture picture(board, camera);
    const bool isCharuco = board.kind == BoardDescription::Kind::Charuco;
    BoardViews how = allAround(260, 420);
    how.borderShare = isCharuco ? 0.05 : 0.3;  // half of it may be outside
    Random random(4);
    std::vector<LensView> views;
    int partial = 0;
    for (int frame = 0; frame < 60 && views.size() < 18; ++frame)
    {
      Photograph photograph;
      photograph.noise = 1.5;
      photograph.seed = unsigned(frame);
      const BoardDetection detection = detectBoard(picture.take(how.pose(board, camera, random), photograph), board);
      if (detection.isUsable())
      {
        partial += int(detection.ids.size()) < board.pointCount() ? 1 : 0;
        views.push_back(toLensView(frame, detection));
      }
    }
    ASSERT_GE(views.size(), 15U) << text;
    EXPECT_TRUE(!isCharuco || partial >= 5) << partial;
    LensCalibrationOptions options;
    options.circleDiameterMm = printedCircleDiameterMm(board);
    const LensCalibrationResult result = calibrateLens(views, camera.width(), camera.height(), options);
    ASSERT_TRUE(result.isUsable()) << text << ": " << result.message;
    std::cout << text << ": focal length off by " << focalErrorPercent(*result.camera, camera) << " %, " << result.rmsPx
              << " px RMS, " << views.size() << " views, " << partial << " of them partly outside\n";
    EXPECT_LT(focalErrorPercent(*result.camera, camera), 0.1) << text;
    EXPECT_LT(result.rmsPx, 0.2) << text;
  }
}

TEST(LensCalibration, OutlierViews_AreLeftOutAndNamed)
{
  const CameraModel camera = webcam();
  Random random(5);
  std::vector<LensView> views = simulate(camera, Chess, 16, 0.1, random);
  for (const std::size_t bad : { 4U, 11U })
  {
    for (Eigen::Vector2d& point : views[bad].points_Image)
    {
      point += Eigen::Vector2d(random.normal(1.5), random.normal(1.5));
    }
  }
  const LensCalibrationResult result = calibrateLens(views, 640, 480);
  ASSERT_TRUE(result.isUsable()) << result.message;
  EXPECT_EQ(result.usedCount, 14);
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    EXPECT_EQ(result.views[i].used, i != 4 && i != 11) << i;
  }
  EXPECT_TRUE(says(result.views[4].message, { "disagrees", "px" }));
  EXPECT_TRUE(says(result.message, { "left out: frame", "4", "11" }));
  EXPECT_LT(focalErrorPercent(*result.camera, camera), 0.2);
  LensCalibrationOptions all;
  all.rejectOutlierViews = false;
  EXPECT_EQ(calibrateLens(views, 640, 480, all).usedCount, 16);
}

TEST(LensCalibration, UselessViews_HaveTheirReason)
{
  const CameraModel camera = webcam();
  Random random(6);
  const std::vector<LensView> good = simulate(camera, Chess, 16, 0.1, random);
  const LensCalibrationResult few = calibrateLens({ good.begin(), good.begin() + 3 }, 640, 480);
  EXPECT_EQ(few.status, Status::TooFewViews);
  EXPECT_TRUE(says(few.message, { "3 views", "at least 6" }));
  EXPECT_FALSE(few.camera.has_value());

  for (const double tilt : { 0.0, 0.4 })
  {
    std::vector<LensView> parallel;
    for (int i = 0; i < 12; ++i)
    {
      const Eigen::Matrix3d attitude = rotationFromVector({ tilt, 0, 0 }) * rotationFromVector({ 0, 0, random.uniform(-0.5, 0.5) });
      Eigen::Isometry3d boardToCamera =
        makeRigid({ 0, 0, 0 }, { random.uniform(-120, -40), random.uniform(-80, -20), random.uniform(250, 400) });
      boardToCamera.linear() = attitude;
      parallel.push_back(seenBoard(i, Chess, camera, boardToCamera, 0.1, random));
    }
    const LensCalibrationResult result = calibrateLens(parallel, 640, 480);
    EXPECT_TRUE(result.status == Status::ParallelViews) << toString(result.status) << ": " << result.message;
    EXPECT_TRUE(says(result.message, { "same way" }));
  }

  // Half of the views with another zoom.
  const CameraModel zoomed = makeCamera(640, 480, 700, 701, 316, 245, { 0.041, -0.112, -0.0007, 0.0011, 0.02 });
  std::vector<LensView> mixed = good;
  const std::vector<LensView> others = simulate(zoomed, Chess, 16, 0.1, random);
  std::copy(others.begin(), others.begin() + 8, mixed.begin() + 8);
  const LensCalibrationResult zoom = calibrateLens(mixed, 640, 480);
  EXPECT_FALSE(zoom.isUsable()) << zoom.message;

  // Squares that are no squares: the board is not the one described.
  std::vector<LensView> oblong = good;
  for (LensView& view : oblong)
  {
    for (Eigen::Vector3d& point : view.points_Board)
    {
      point.x() += 0.004 * point.y() * point.y();
    }
  }
  const LensCalibrationResult wrong = calibrateLens(oblong, 640, 480);
  EXPECT_FALSE(wrong.isUsable()) << wrong.message;
}

TEST(LensCalibration, CallersMistakes_AreNamed)
{
  Random random(7);
  std::vector<LensView> views = simulate(webcam(), Chess, 8, 0.1, random);
  views[3].points_Image[2].x() = std::nan("");
  expectInvalidArgument([&] { (void)calibrateLens(views, 640, 480); }, { "view 3", "(2)" });
  views[3].points_Image.pop_back();
  expectInvalidArgument([&] { (void)calibrateLens(views, 640, 480); }, { "view 3", "ids" });
  expectInvalidArgument([&] { (void)calibrateLens({}, 0, 480); }, { "width" });
  expectInvalidArgument([&] { (void)calibrateLens({}, 640, 480, with(6)); }, { "4, 5 or 8" });
}

TEST(LensRepeatability, Spread_IsThatOfTheStandardDeviations)
{
  const CameraModel camera = webcam();
  Random random(8);
  const std::vector<LensView> views = simulate(camera, Chess, 30, 0.2, random);
  LensRepetitionOptions repetition;
  repetition.repetitions = 12;
  const LensRepetition result = repeatLensCalibration(views, 640, 480, {}, repetition);
  ASSERT_EQ(result.results.size(), 12U);
  EXPECT_EQ(result.failedCount, 0);
  EXPECT_NEAR(result.fx.mean, camera.fx(), 1);
  EXPECT_GT(result.fx.standardDeviation, 0.02);
  EXPECT_LT(result.fx.standardDeviation, 1);
  EXPECT_GT(result.maximumShiftPx, result.meanShiftPx);
  EXPECT_GT(result.meanShiftPx, 0.005);
  EXPECT_LT(result.meanShiftPx, 0.5);
  EXPECT_EQ(result.coefficients.size(), 5U);
  int calls = 0;
  const LensRepetition stopped = repeatLensCalibration(views, 640, 480, {}, repetition, [&](int, int) { return ++calls < 3; });
  EXPECT_EQ(stopped.results.size(), 3U);
}

TEST(LensStereo, BothEyes_GiveTheirRelation)
{
  const CameraModel left = laparoscope4(), right = makeCamera(720, 576, 808, 822, 351, 290, { -0.247, 0.09, -0.0005, 0.0007 });
  const Eigen::Isometry3d leftToRight = makeRigid({ 0.004, -0.05, 0.002 }, { -4.6, 0.1, 0.2 });
  const BoardDescription board = parseBoard("charuco:9x6:8:6:DICT_4X4_50");
  const auto simulateStereo = [&](double sigmaPx, int shift, Random& random)
  {
    std::vector<LensView> views[2];
    for (int frame = 0; frame < 18; ++frame)
    {
      const Eigen::Isometry3d boardToLeft = allAround(80, 130).pose(board, left, random);
      views[0].push_back(seenBoard(frame, board, left, boardToLeft, sigmaPx, random));
      views[1].push_back(seenBoard((frame + shift) % 18, board, right, leftToRight * boardToLeft, sigmaPx, random));
    }
    return calibrateStereoLens(views[0], 720, 576, views[1], 720, 576, with(4));
  };
  Random random(9);
  const StereoLensResult exact = simulateStereo(0, 0, random);
  ASSERT_TRUE(exact.isUsable()) << exact.message;
  EXPECT_TRUE(rigid3dNear(exact.leftToRight, leftToRight, 1e-6, 1e-4)) << "OpenCV's points are in single precision";
  const StereoLensResult noisy = simulateStereo(0.2, 0, random);
  ASSERT_TRUE(noisy.isUsable()) << noisy.message;
  EXPECT_TRUE(rigid3dNear(noisy.leftToRight, leftToRight, 0.003, 0.5)) << "a focal length that is off by 0.3 % is 0.3 mm at 100 mm";
  const double sigmaMm = std::sqrt(noisy.covariance.bottomRightCorner<3, 3>().trace());
  EXPECT_GT(sigmaMm, 0.001);
  EXPECT_LT(sigmaMm, 0.2);
  const StereoLensResult unpaired = simulateStereo(0.2, 1, random);
  EXPECT_EQ(unpaired.status, StereoLensResult::Status::Disagreement) << unpaired.message;
  EXPECT_TRUE(says(unpaired.message, { "same moments" }));
}
