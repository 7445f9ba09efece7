// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ResultFiles.h"

#include "CalibratedEye.h"
#include "CaptureSimulation.h"
#include "FileError.h"
#include "GeometryMatchers.h"
#include "HandEyePrediction.h"
#include "PivotSimulation.h"

#include <gtest/gtest.h>

#include <set>

using namespace handeye;
using namespace handeye::test;
using handeye::io::test::TemporaryFolder;
using nlohmann::json;

namespace
{

/// The object has these keys, among others.
void expectKeys(const json& object, const std::set<std::string>& keys)
{
  for (const std::string& key : keys)
  {
    EXPECT_TRUE(object.contains(key)) << "the key \"" << key << "\" is missing in " << object.dump().substr(0, 300);
  }
}

void expectShape(const json& matrix, std::size_t rows, std::size_t columns)
{
  ASSERT_EQ(matrix.size(), rows);
  for (const json& row : matrix)
  {
    ASSERT_EQ(row.size(), columns);
  }
}

CalibrationStepResult calibrate(const SimulatedSession& session, const std::vector<CapturedFrame>& frames)
{
  CalibrationStepResult result = calibrateCapture({ session.camera, frames });
  result.tip_Stylus = session.tip_Stylus;
  result.ballRadiusMm = session.ballRadiusMm;
  return result;
}

PivotStepResult pivot(double largestTilt)
{
  Random random(1);
  PivotStepResult step;
  step.calibration = calibratePivot(PivotSimulation().recordPivoting(60, largestTilt, random));
  step.usedFrames = step.calibration.used;
  step.rejectedFrames = { 7, 9 };
  step.invalidFrames = { 4 };
  return step;
}

}  // namespace

TEST(ResultFiles, Stylus_HasTheKeysOfTheContract)
{
  const json object = stylusJson(pivot(35 * Degree));
  expectKeys(object,
    { "schema", "status", "message", "tip_Stylus_Mm", "rmsMm", "maxMm", "usedFrames", "rejectedFrames", "tipCovariance_Mm2" });
  EXPECT_EQ(object["status"], "ok");
  EXPECT_EQ(object["tip_Stylus_Mm"].size(), 3U);
  EXPECT_NEAR(object["tip_Stylus_Mm"][2].get<double>(), -158, 0.3);
  expectShape(object["tipCovariance_Mm2"], 3, 3);
  EXPECT_EQ(object["rejectedFrames"], json({ 7, 9 }));
}

TEST(ResultFiles, StylusSamples_SayOfEachFrameWhyItWasNotUsed)
{
  Random random(3);
  std::vector<Eigen::Isometry3d> poses = PivotSimulation().recordPivoting(60, 35 * Degree, random);
  poses[10].translation().x() += 30;
  poses[20] = poses[19];
  PivotStepResult step;
  step.calibration = calibratePivot(poses);
  step.invalidFrames = { 0, 31, 61 };
  for (int pose = 0; pose < 60; ++pose)
  {
    step.poseFrames.push_back(pose < 30 ? pose + 1 : pose + 2);
  }
  step.poseFrames.back() = 62;
  const json object = stylusJson(step);
  expectKeys(object, { "method", "meanMm", "angularRange_Rad", "noiseFactor", "repeatedFrames", "samples" });
  EXPECT_EQ(object["method"], "robust");
  EXPECT_LT(object["meanMm"].get<double>(), object["rmsMm"].get<double>());
  ASSERT_EQ(object["samples"].size(), 63U);
  const auto status = [&](std::size_t row) { return object["samples"][row]["status"]; };
  for (std::size_t row = 0; row < 63; ++row)
  {
    EXPECT_EQ(object["samples"][row]["frame"], row);
    EXPECT_EQ(object["samples"][row]["used"], status(row) == "ok");
    EXPECT_EQ(object["samples"][row].contains("residualMm"), status(row) != "not_tracked");
  }
  EXPECT_EQ(status(0), "not_tracked");
  EXPECT_EQ(status(31), "not_tracked");
  EXPECT_EQ(status(61), "not_tracked");
  EXPECT_EQ(status(11), "disagrees");
  EXPECT_EQ(status(21), "repeated");
  EXPECT_GT(object["samples"][11]["residualMm"].get<double>(), 20);
}

TEST(ResultFiles, StylusThatIsNotUsable_HasNoTip)
{
  const json object = stylusJson(pivot(0.5 * Degree));
  EXPECT_NE(object["status"], "ok");
  EXPECT_FALSE(object["message"].get<std::string>().empty());
  for (const char* key : { "tip_Stylus_Mm", "tipCovariance_Mm2", "rmsMm", "maxMm" })
  {
    EXPECT_FALSE(object.contains(key)) << key;
  }
}

TEST(ResultFiles, Calibration_HasTheKeysOfTheContract)
{
  const SimulatedSession session(10);
  std::vector<CapturedFrame> frames = session.captured(0.2, 0.1);
  frames[2].status = "not_found";
  frames[2].message = "no ball is seen";
  frames[2].ball = {};
  const json object = calibrationJson(calibrate(session, frames));
  expectKeys(object,
    { "schema", "status", "message", "markerToCamera", "camera", "tip_Stylus_Mm", "ballRadiusMm", "reprojectionRmsPx", "covariance",
      "samples" });
  EXPECT_EQ(object["status"], "ok");
  expectShape(object["markerToCamera"], 4, 4);
  EXPECT_EQ(object["markerToCamera"][3], json({ 0.0, 0.0, 0.0, 1.0 }));
  EXPECT_NEAR(object["markerToCamera"][0][3].get<double>(), session.markerToCamera.translation().x(), 5) << "rows, not columns";
  expectShape(object["covariance"], 6, 6);
  expectKeys(object["camera"], { "width", "height", "cameraMatrix", "distortionCoefficients" });
  expectShape(object["camera"]["cameraMatrix"], 3, 3);
  EXPECT_EQ(object["camera"]["distortionCoefficients"], json(session.camera.distortionCoefficients()));
  ASSERT_EQ(object["samples"].size(), 10U);
  expectKeys(object["samples"][0], { "frame", "status", "used", "ball_Image_Px", "tip_Marker_Mm", "residualPx", "residualMm" });
  EXPECT_EQ(object["samples"][0]["ball_Image_Px"].size(), 2U);
  EXPECT_EQ(object["samples"][0]["tip_Marker_Mm"].size(), 3U);
  EXPECT_EQ(object["samples"][2]["status"], "not_found");
  EXPECT_EQ(object["samples"][2]["used"], false);
  EXPECT_EQ(object["samples"][2]["message"], "no ball is seen");
  EXPECT_FALSE(object["samples"][2].contains("ball_Image_Px"));
  EXPECT_FALSE(object["samples"][2].contains("residualPx"));
}

TEST(ResultFiles, CalibrationThatIsNotUsable_HasNoTransform)
{
  const SimulatedSession session(4);
  const json object = calibrationJson(calibrate(session, session.captured()));
  EXPECT_EQ(object["status"], "too_few_samples");
  EXPECT_FALSE(object["message"].get<std::string>().empty());
  EXPECT_EQ(object["samples"].size(), 4U);
  for (const char* key : { "markerToCamera", "markerToRightCamera", "covariance", "reprojectionRmsPx" })
  {
    EXPECT_FALSE(object.contains(key)) << key;
  }
  EXPECT_FALSE(object["samples"][0].contains("residualPx"));
}

TEST(ResultFiles, StereoCalibration_HasBothTransformsOrNone)
{
  const SimulatedSession left(8);
  SimulatedSession right = left;
  const Eigen::Isometry3d leftToRight = makeRigid({ 0, 0.02, 0 }, { -20, 0, 0 });
  for (Eigen::Vector3d& ball : right.balls_Camera)
  {
    ball = leftToRight * ball;
  }
  right.markerToCamera = leftToRight * left.markerToCamera;
  for (const auto& relation : { std::optional<Eigen::Isometry3d>(leftToRight), std::optional<Eigen::Isometry3d>() })
  {
    const json object =
      calibrationJson(calibrateStereoCapture({ left.camera, left.captured() }, { right.camera, right.captured() }, relation));
    expectKeys(object, { "markerToCamera", "markerToRightCamera", "rightCamera", "rightSamples" });
    EXPECT_NEAR(object["markerToRightCamera"][0][3].get<double>(), right.markerToCamera.translation().x(), 1e-6);
    EXPECT_EQ(object["rightSamples"].size(), 8U);
    EXPECT_EQ(object.contains("right"), !relation.has_value());
  }
  std::vector<CapturedFrame> few = right.captured();
  few.resize(2);
  const json object =
    calibrationJson(calibrateStereoCapture({ left.camera, left.captured() }, { right.camera, few }, std::nullopt));
  EXPECT_EQ(object["status"], "too_few_samples");
  EXPECT_FALSE(object.contains("markerToCamera")) << "half a stereo head is no result";
  EXPECT_FALSE(object.contains("markerToRightCamera"));
}

TEST(ResultFiles, RightEyesCovariance_IsItsOwn)
{
  const TemporaryFolder folder;
  const SimulatedSession left(10);
  SimulatedSession right = left;
  const Eigen::Isometry3d leftToRight = makeRigid({ 0, 0.3, 0 }, { -60, 0, 5 });
  for (Eigen::Vector3d& ball : right.balls_Camera)
  {
    ball = leftToRight * ball;
  }
  right.markerToCamera = leftToRight * left.markerToCamera;
  const EyeCapture leftCapture{ left.camera, left.captured(0.2, 0.1) }, rightCapture{ right.camera, right.captured(0.2, 0.1, 4) };

  // One registration: a point's error is the same whichever eye it is seen from.
  CalibrationStepResult together = calibrateStereoCapture(leftCapture, rightCapture, leftToRight);
  together.ballRadiusMm = left.ballRadiusMm;
  ASSERT_TRUE(together.isUsable());
  writeJson(folder.path() / "together.json", calibrationJson(together));
  const auto covariance = readRightCalibrationCovariance(folder.path() / "together.json");
  ASSERT_TRUE(covariance.has_value());
  const Eigen::Vector3d point_Left(20, -10, 250);
  const Eigen::Matrix3d seen_Left = predictTargetCovariance(together.calibration.covariance, point_Left);
  const Eigen::Matrix3d seen_Right = predictTargetCovariance(*covariance, leftToRight * point_Left);
  const Eigen::Matrix3d turned = leftToRight.linear() * seen_Left;
  EXPECT_LT((seen_Right - turned * leftToRight.linear().transpose()).norm(), 1e-9 * seen_Left.norm());
  EXPECT_GT((*covariance - together.calibration.covariance).norm(), 0.05 * covariance->norm());

  // Two: the right eye's own.
  CalibrationStepResult apart = calibrateStereoCapture(leftCapture, rightCapture, std::nullopt);
  ASSERT_TRUE(apart.isUsable());
  json object = calibrationJson(apart);
  writeJson(folder.path() / "apart.json", object);
  EXPECT_EQ(readRightCalibrationCovariance(folder.path() / "apart.json"), apart.right->calibration->covariance);
  object["right"].erase("covariance");
  writeJson(folder.path() / "unknown.json", object);
  EXPECT_FALSE(readRightCalibrationCovariance(folder.path() / "unknown.json").has_value()) << "not the left one's instead";
  const std::optional<CalibratedEye> eye = readRightEye(folder.path() / "apart.json");
  ASSERT_TRUE(eye.has_value());
  EXPECT_EQ(eye->camera.cameraMatrix(), right.camera.cameraMatrix());
  EXPECT_EQ(eye->covariance, apart.right->calibration->covariance);
  EXPECT_TRUE(rigid3dNear(eye->markerToCamera, apart.right->markerToRightCamera, 1e-14, 1e-12));

  CalibrationStepResult alone = calibrate(left, left.captured(0.2, 0.1));
  writeJson(folder.path() / "alone.json", calibrationJson(alone));
  EXPECT_THROW(static_cast<void>(readRightCalibrationCovariance(folder.path() / "alone.json")), io::FileError);
  EXPECT_FALSE(readRightEye(folder.path() / "alone.json").has_value());
}

TEST(ResultFiles, Validation_HasTheKeysOfTheContract)
{
  const SimulatedSession session(5);
  std::vector<CapturedFrame> frames = session.captured(0.2, 0.1);
  frames[1].status = "stylus_invalid";
  const json object = validationJson(validateCapture(frames, session.camera, session.markerToCamera));
  expectKeys(object, { "schema", "status", "projectionErrorPx", "samples" });
  expectKeys(object["projectionErrorPx"], { "mean", "std", "min", "max", "rms", "count" });
  EXPECT_EQ(object["projectionErrorPx"]["count"], 4);
  expectKeys(object["samples"][0], { "frame", "status", "ball_Image_Px", "projected_Image_Px", "errorPx", "distanceMm" });
  EXPECT_EQ(object["samples"][1]["status"], "stylus_invalid");
  EXPECT_FALSE(object["samples"][1].contains("errorPx"));
  EXPECT_FALSE(validationJson(validateCapture({}, session.camera, session.markerToCamera)).contains("projectionErrorPx"));
}

TEST(ResultFiles, Phantom_HasTheKeysOfTheContract)
{
  const std::vector<Eigen::Vector3d> model = { { 0, 0, 0 }, { 40, 0, 0 }, { 0, 30, 5 }, { 10, 20, 30 } };
  const json object = phantomJson(registerLandmarks(model, model));
  expectKeys(object, { "schema", "status", "modelToPhantom", "rmsMm", "residualsMm" });
  expectShape(object["modelToPhantom"], 4, 4);
  EXPECT_EQ(object["residualsMm"].size(), 4U);
  const json unusable = phantomJson(registerLandmarks({ model[0], model[1] }, { model[0], model[1] }));
  EXPECT_EQ(unusable["status"], "too_few_points");
  EXPECT_FALSE(unusable.contains("modelToPhantom"));
}

TEST(ResultFiles, Detection_HasTheKeysOfTheContract)
{
  const SimulatedSession session(3);
  std::vector<CapturedFrame> frames = session.captured();
  frames[1].status = "several_balls";
  frames[1].ball = {};
  const json object = detectionJson(frames);
  ASSERT_EQ(object["frames"].size(), 3U);
  expectKeys(object["frames"][0], { "frame", "status", "ball_Image_Px", "radiusPx", "distanceMm" });
  EXPECT_EQ(object["frames"][1]["status"], "several_balls");
  EXPECT_FALSE(object["frames"][1].contains("ball_Image_Px"));
  EXPECT_EQ(object["status"], "ok");
  EXPECT_EQ(detectionJson({ frames[1] })["status"], "not_found");
}

TEST(ResultFiles, Registration_HasNoTransformUnlessUsable)
{
  Random random(3);
  std::vector<PointLinePair> pairs;
  for (int i = 0; i < 8; ++i)
  {
    const Eigen::Vector3d point = random.uniform3(100), direction = random.direction();
    pairs.push_back({ point, point - 20 * direction, direction, 1 });
  }
  expectKeys(registrationJson(registerPointsToLines(pairs)), { "status", "pointsToLines", "rmsMm", "residualsMm" });
  pairs.resize(3);
  const json unusable = registrationJson(registerPointsToLines(pairs));
  EXPECT_EQ(unusable["status"], "too_few_pairs");
  EXPECT_FALSE(unusable.contains("pointsToLines"));
}

TEST(ResultFiles, WrittenFiles_ReadBackBitForBit)
{
  const TemporaryFolder folder;
  const SimulatedSession session(10);
  CalibrationStepResult calibration = calibrate(session, session.captured(0.2, 0.1));
  calibration.tools = { "PointerToTracker", "HeadToTracker" };
  writeJson(folder.path() / "calibration.json", calibrationJson(calibration));
  const StoredCalibration stored = readCalibration(folder.path() / "calibration.json");
  EXPECT_TRUE(rigid3dNear(stored.markerToCamera, calibration.calibration.markerToCamera, 1e-15, 0));
  EXPECT_EQ(stored.camera.cameraMatrix(), session.camera.cameraMatrix());
  EXPECT_EQ(stored.camera.distortionCoefficients(), session.camera.distortionCoefficients());
  EXPECT_EQ(stored.camera.width(), 320);
  EXPECT_EQ(stored.tip_Stylus, session.tip_Stylus);
  EXPECT_EQ(stored.ballRadiusMm, session.ballRadiusMm);
  EXPECT_EQ(stored.tools.stylusToTracker, "PointerToTracker");
  EXPECT_EQ(stored.tools.markerToTracker, "HeadToTracker");

  const PivotStepResult stylus = pivot(35 * Degree);
  writeJson(folder.path() / "stylus.json", stylusJson(stylus));
  EXPECT_EQ(readStylusTip(folder.path() / "stylus.json"), stylus.calibration.tip_Stylus);

  const std::vector<Eigen::Vector3d> model = { { 0, 0, 0 }, { 40, 0, 0 }, { 0, 30, 5 }, { 10, 20, 30 } };
  std::vector<Eigen::Vector3d> touched;
  const Eigen::Isometry3d modelToPhantom = makeRigid({ 0.3, 0.2, -0.5 }, { 1, 2, 3 });
  for (const Eigen::Vector3d& point : model)
  {
    touched.push_back(modelToPhantom * point);
  }
  writeJson(folder.path() / "phantom.json", phantomJson(registerLandmarks(model, touched)));
  EXPECT_TRUE(rigid3dNear(readPhantomRegistration(folder.path() / "phantom.json"), modelToPhantom, 1e-9, 1e-9));
}
