// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CalibrationStep.h"

#include "CaptureSimulation.h"
#include "GeometryMatchers.h"
#include "ValidationStep.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace handeye;
using namespace handeye::test;
using handeye::io::test::TemporaryFolder;

namespace
{

using Status = HandEyeCalibrationResult::Status;

Eigen::Isometry3d leftToRight()
{
  return makeRigid({ 0.005, 0.03, -0.01 }, { -25, 0.5, 1 });
}

/// The same balls as the right eye of a stereo head sees them.
SimulatedSession rightEyeOf(const SimulatedSession& left)
{
  SimulatedSession right = left;
  right.markerToCamera = leftToRight() * left.markerToCamera;
  for (Eigen::Vector3d& ball : right.balls_Camera)
  {
    ball = leftToRight() * ball;
  }
  return right;
}

}  // namespace

TEST(CalibrationStep, RecordingWithPictures_IsCalibratedAndValidated)
{
  const TemporaryFolder folder;
  const SimulatedSession session(10);
  const io::Recording recording = io::Recording::open(session.write(folder.path() / "capture", session.trackAll()));
  const auto frames = readCapture(recording, {}, session.camera, session.tip_Stylus, session.ballRadiusMm);
  const CalibrationStepResult result = calibrateCapture({ session.camera, frames });
  ASSERT_TRUE(result.isUsable()) << result.calibration.message;
  EXPECT_EQ(result.calibration.usedCount, 10);
  // The segmentation is good to some hundredths of a pixel of 0.3 to 1 mm each.
  EXPECT_TRUE(rigid3dNear(result.calibration.markerToCamera, session.markerToCamera, 0.001, 0.3));
  EXPECT_LT(result.calibration.reprojectionRmsPx, 0.1);

  const SimulatedSession others(6, 77);
  const io::Recording heldOut = io::Recording::open(others.write(folder.path() / "validation", others.trackAll(8)));
  const auto heldOutFrames = readCapture(heldOut, {}, session.camera, session.tip_Stylus, session.ballRadiusMm);
  const ValidationStepResult validation = validateCapture(heldOutFrames, session.camera, result.calibration.markerToCamera);
  ASSERT_TRUE(validation.isUsable());
  EXPECT_EQ(validation.projectionErrorPx.count, 6);
  EXPECT_LT(validation.projectionErrorPx.maximum, 0.2);
}

TEST(CalibrationStep, FramesThatAreNoSamples_KeepTheirPlace)
{
  const SimulatedSession session(10);
  std::vector<CapturedFrame> frames = session.captured();
  frames[0].status = "not_found";
  frames[4].status = "stylus_invalid";
  frames[4].tip_Marker.reset();
  const CalibrationStepResult result = calibrateCapture({ session.camera, frames });
  ASSERT_TRUE(result.isUsable()) << result.calibration.message;
  ASSERT_EQ(result.frames.size(), 10U);
  EXPECT_EQ(result.calibration.samples.size(), 8U);
  for (std::size_t i = 0; i < 10; ++i)
  {
    const bool isSample = i != 0 && i != 4;
    EXPECT_EQ(result.frames[i].captured.frame, int(i));
    EXPECT_EQ(result.frames[i].status, isSample ? "ok" : frames[i].status);
    EXPECT_EQ(result.frames[i].used, isSample);
    EXPECT_LT(result.frames[i].residualPx, 1e-6);
  }
  EXPECT_TRUE(rigid3dNear(result.calibration.markerToCamera, session.markerToCamera, 1e-9, 1e-8));
}

TEST(CalibrationStep, SampleThatDisagrees_IsListedWithItsResidual)
{
  const SimulatedSession session(12);
  std::vector<CapturedFrame> frames = session.captured(0.2, 0.1);
  frames[1].status = "image_missing";
  frames[7].ball.ball_Image += Eigen::Vector2d(40, 25);
  frames[7].ball.ray_Camera = session.camera.unproject(frames[7].ball.ball_Image).ray_Camera;
  const CalibrationStepResult result = calibrateCapture({ session.camera, frames });
  ASSERT_TRUE(result.isUsable()) << result.calibration.message;
  EXPECT_EQ(result.frames[7].status, "disagrees");
  EXPECT_FALSE(result.frames[7].used);
  EXPECT_NEAR(result.frames[7].residualPx, std::hypot(40, 25), 4);
  EXPECT_EQ(result.frames[6].status, "ok");
  EXPECT_TRUE(result.frames[6].used);
  EXPECT_EQ(result.calibration.usedCount, 10);
}

TEST(CalibrationStep, TooFewSamples_KeepTheFramesStatus)
{
  const SimulatedSession session(4);
  const CalibrationStepResult result = calibrateCapture({ session.camera, session.captured() });
  EXPECT_FALSE(result.isUsable());
  EXPECT_EQ(result.decisive().status, Status::TooFewSamples);
  for (const CalibratedFrame& frame : result.frames)
  {
    EXPECT_EQ(frame.status, "ok");
    EXPECT_FALSE(frame.used);
  }
}

/// A video of balls that are held still has many frames of each place: they are one place for the plan as for the verdict.
TEST(CalibrationStep, PlanForTheNextPlacement_CountsAPlaceOnce)
{
  const TemporaryFolder folder;
  const SimulatedSession session(6);
  const io::Recording recording = io::Recording::open(session.write(folder.path() / "capture", session.trackAll()));
  const auto once = readCapture(recording, {}, session.camera, session.tip_Stylus, session.ballRadiusMm);
  auto often = once;
  for (int repeat = 0; repeat < 9; ++repeat)
  {
    often.insert(often.end(), once.begin(), once.end());
  }
  CalibrationStepResult single = calibrateCapture({ session.camera, once }), repeated = calibrateCapture({ session.camera, often });
  ASSERT_TRUE(single.isUsable() && repeated.isUsable()) << single.calibration.message << repeated.calibration.message;
  // The same noise for both, so that only the count of places could make a difference.
  repeated.calibration.trackingSigmaMm = single.calibration.trackingSigmaMm;
  repeated.calibration.segmentationSigmaPx = single.calibration.segmentationSigmaPx;
  addGuidance(single, {}, {});
  addGuidance(repeated, {}, {});
  ASSERT_TRUE(single.guidance && repeated.guidance);
  EXPECT_NEAR(repeated.guidance->maximumPx, single.guidance->maximumPx, 0.02 * single.guidance->maximumPx);
}

TEST(CalibrationStep, SamplesThatContradictEachOther_AreNotPlannedFor)
{
  const TemporaryFolder folder;
  const SimulatedSession session(10);
  const io::Recording recording = io::Recording::open(session.write(folder.path() / "capture", session.trackAll()));
  auto frames = readCapture(recording, {}, session.camera, session.tip_Stylus, session.ballRadiusMm);
  std::vector<Eigen::Vector3d> tips_Marker;
  for (const CapturedFrame& captured : frames)
  {
    tips_Marker.push_back(captured.tip_Marker.value());
  }
  for (std::size_t i = 0; i < frames.size(); ++i)
  {
    frames[i].tip_Marker = tips_Marker[(3 * i + 1) % tips_Marker.size()];  // poses of other frames
  }
  CalibrationStepResult result = calibrateCapture({ session.camera, frames });
  ASSERT_FALSE(result.isUsable());
  ASSERT_EQ(result.calibration.status, Status::NoConsensus) << result.calibration.message;
  addGuidance(result, {}, {});
  EXPECT_FALSE(result.guidance);
}

TEST(CalibrationStep, StereoWithAKnownRelation_IsOneRegistration)
{
  const SimulatedSession left(8), right = rightEyeOf(left);
  std::vector<CapturedFrame> leftFrames = left.captured(), rightFrames = right.captured();
  leftFrames[2].status = "not_found";
  rightFrames[5].status = "several_balls";
  const CalibrationStepResult result =
    calibrateStereoCapture({ left.camera, leftFrames }, { right.camera, rightFrames }, leftToRight());
  ASSERT_TRUE(result.isUsable()) << result.calibration.message;
  EXPECT_EQ(result.calibration.samples.size(), 14U);
  EXPECT_EQ(result.calibration.usedCount, 14);
  ASSERT_TRUE(result.right.has_value());
  EXPECT_FALSE(result.right->calibration.has_value());
  EXPECT_TRUE(rigid3dNear(result.calibration.markerToCamera, left.markerToCamera, 1e-9, 1e-8));
  EXPECT_TRUE(rigid3dNear(result.right->markerToRightCamera, right.markerToCamera, 1e-9, 1e-8));
  ASSERT_EQ(result.right->frames.size(), 8U);
  EXPECT_EQ(result.frames[2].status, "not_found");
  EXPECT_EQ(result.right->frames[5].status, "several_balls");
  EXPECT_TRUE(result.right->frames[2].used);
  EXPECT_LT(result.right->frames[7].residualPx, 1e-6);
}

TEST(CalibrationStep, StereoWithAWrongRelation_IsNotUsedInSilence)
{
  const SimulatedSession left(8), right = rightEyeOf(left);
  const Eigen::Isometry3d wrong = makeRigid({ 0, 0.4, 0 }, { -60, 0, 0 });
  const CalibrationStepResult result =
    calibrateStereoCapture({ left.camera, left.captured() }, { right.camera, right.captured() }, wrong);
  const bool oneEyeIsOut = result.calibration.usedCount <= 8;
  EXPECT_TRUE(!result.isUsable() || oneEyeIsOut) << result.calibration.message;
}

TEST(CalibrationStep, StereoWithoutARelation_CalibratesEachEye)
{
  const SimulatedSession left(8), right = rightEyeOf(left);
  const CalibrationStepResult result =
    calibrateStereoCapture({ left.camera, left.captured() }, { right.camera, right.captured() }, std::nullopt);
  ASSERT_TRUE(result.isUsable());
  ASSERT_TRUE(result.right && result.right->calibration);
  EXPECT_TRUE(rigid3dNear(result.calibration.markerToCamera, left.markerToCamera, 1e-9, 1e-8));
  EXPECT_TRUE(rigid3dNear(result.right->markerToRightCamera, right.markerToCamera, 1e-9, 1e-8));
  EXPECT_TRUE(rigid3dNear(result.right->calibration->markerToCamera, right.markerToCamera, 1e-9, 1e-8));
}

TEST(CalibrationStep, StereoWithOneBadEye_IsNotUsableAndSaysWhy)
{
  const SimulatedSession left(8), right = rightEyeOf(left);
  std::vector<CapturedFrame> rightFrames = right.captured();
  rightFrames.resize(3);
  const CalibrationStepResult result =
    calibrateStereoCapture({ left.camera, left.captured() }, { right.camera, rightFrames }, std::nullopt);
  EXPECT_FALSE(result.isUsable());
  EXPECT_TRUE(result.calibration.isUsable());
  EXPECT_EQ(result.decisive().status, Status::TooFewSamples);
  EXPECT_TRUE(says(result.decisive().message, { "only 3" }));
}

TEST(ValidationStep, OnlySamplesCount)
{
  const SimulatedSession session(6);
  std::vector<CapturedFrame> frames = session.captured();
  frames[1].status = "not_found";
  frames[3].tip_Marker = session.markerToCamera.inverse() * Eigen::Vector3d(0, 0, -200);
  frames[4].ball.ball_Image += Eigen::Vector2d(3, -4);
  const ValidationStepResult result = validateCapture(frames, session.camera, session.markerToCamera);
  ASSERT_EQ(result.frames.size(), 6U);
  EXPECT_EQ(result.projectionErrorPx.count, 4);
  EXPECT_EQ(result.frames[1].status, "not_found");
  EXPECT_FALSE(result.frames[1].validated.has_value());
  EXPECT_EQ(result.frames[3].status, "behind_camera");
  EXPECT_EQ(result.frames[4].status, "ok");
  EXPECT_NEAR(result.frames[4].validated->errorPx, 5, 1e-6);
  EXPECT_NEAR(result.projectionErrorPx.maximum, 5, 1e-6);
  EXPECT_NEAR(result.projectionErrorPx.mean, 5.0 / 4, 1e-6);
  EXPECT_NEAR(result.projectionErrorPx.rms, 2.5, 1e-6);
  EXPECT_TRUE(says(result.message, { "1.25 px mean", "2.50 px RMS", "5.00 px at most", "4 of 6 frames" }));
}

TEST(ValidationStep, NothingToValidate_IsNotUsable)
{
  const SimulatedSession session(3);
  std::vector<CapturedFrame> frames = session.captured();
  for (CapturedFrame& frame : frames)
  {
    frame.status = "not_found";
  }
  const ValidationStepResult result = validateCapture(frames, session.camera, session.markerToCamera);
  EXPECT_FALSE(result.isUsable());
  EXPECT_TRUE(says(result.message, { "none of the 3 frames" }));
}
