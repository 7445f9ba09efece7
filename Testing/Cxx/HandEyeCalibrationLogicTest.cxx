// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CalibrationStep.h"
#include "LogicFixture.h"
#include "PivotStep.h"
#include "ResultFiles.h"

#include <vtkMatrix4x4.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace
{

using namespace handeye::test;

class HandEyeCalibrationLogic : public LogicFixture
{
};

}  // namespace

TEST_F(HandEyeCalibrationLogic, BeforeAnyStep_ThereAreNoResults)
{
  double tip_Stylus[3] = { 1, 2, 3 };
  EXPECT_FALSE(Subject->GetStylusTip(tip_Stylus));
  EXPECT_EQ(tip_Stylus[0], 1);
  EXPECT_EQ(Subject->GetMarkerToCamera(), nullptr);
  EXPECT_EQ(Subject->GetModelToPhantom(), nullptr);
  EXPECT_EQ(Subject->GetStylusResult(), nullptr);
  EXPECT_EQ(Subject->GetCalibrationResult(), nullptr);
  EXPECT_EQ(Subject->GetLastCalibrationAttempt(), nullptr);
  EXPECT_EQ(Subject->GetCalibration(), nullptr);
  EXPECT_EQ(Subject->GetValidationResult(), nullptr);
  EXPECT_EQ(Subject->GetPhantomResult(), nullptr);
  for (const double number :
    { Subject->GetStylusRmsMm(), Subject->GetPredictedMeanPx(), Subject->GetPredictedMaximumPx(), Subject->GetReprojectionRmsPx(),
      Subject->GetValidationMeanPx(), Subject->GetValidationStandardDeviationPx(), Subject->GetValidationMinimumPx(),
      Subject->GetValidationMaximumPx(), Subject->GetValidationRmsPx(), Subject->GetPhantomRmsMm() })
  {
    EXPECT_TRUE(std::isnan(number));
  }
  EXPECT_EQ(Subject->GetValidationCount(), 0);
  EXPECT_EQ(Subject->GetSampleTable()->GetNumberOfRows(), 0);
  EXPECT_EQ(Subject->GetValidationTable()->GetNumberOfRows(), 0);
  EXPECT_NE(Subject->GetSampleTable()->GetColumnByName("residualPx"), nullptr);
  EXPECT_EQ(Subject->GetCalibrationRecording(), "");
  EXPECT_FALSE(Subject->SetSampleExcluded(0, true));
}

TEST_F(HandEyeCalibrationLogic, Inputs_AreModifiedOnlyByOtherValues)
{
  Events.take(vtkCommand::ModifiedEvent);
  const auto setAll = [this]
  {
    Subject->SetCameraFile("lens.yml");
    Subject->SetBallRadiusMm(7);
    Subject->SetSegmentationMethod(Logic::HoughSegmentation);
    Subject->SetSolverMethod(Logic::ProcrustesSolver);
    Subject->SetStylusTransform("ProbeToTracker");
    Subject->SetMarkerTransform("CameraToTracker");
    Subject->SetStylusTip(1, 2, 3);
  };
  setAll();
  EXPECT_EQ(Events.take(vtkCommand::ModifiedEvent), 7);
  EXPECT_TRUE(Events.sawOnly(Logic::StylusCalibratedEvent));
  setAll();
  EXPECT_EQ(Events.take(vtkCommand::ModifiedEvent), 0);
  EXPECT_TRUE(Events.sawOnly(vtkCommand::NoEvent));
  EXPECT_EQ(Subject->GetCameraFile(), "lens.yml");
  EXPECT_EQ(Subject->GetSolverMethod(), Logic::ProcrustesSolver);
  std::ostringstream printed;
  Subject->Print(printed);
  for (const char* word : { "lens.yml", "hough", "procrustes", "ProbeToTracker", "Stylus: known", "Calibration: none" })
  {
    EXPECT_NE(printed.str().find(word), std::string::npos) << word;
  }
}

TEST_F(HandEyeCalibrationLogic, AllSteps_FindWhatWasSimulated)
{
  ASSERT_TRUE(Subject->CalibrateStylus(shared().pivot)) << Subject->GetLastMessage();
  EXPECT_TRUE(Events.sawOnly(Logic::StylusCalibratedEvent));
  Eigen::Vector3d tip_Stylus;
  ASSERT_TRUE(Subject->GetStylusTip(tip_Stylus.data()));
  EXPECT_TRUE(pointNear(tip_Stylus, shared().capture.stylus.tip_Stylus, 0.2));
  EXPECT_GT(Subject->GetStylusRmsMm(), 0);
  EXPECT_EQ(Subject->GetStylusResult()->usedFrames.size(), 80);
  EXPECT_EQ(Subject->GetStylusRecording(), shared().pivot);

  ASSERT_TRUE(Subject->CalibrateCamera(shared().balls)) << Subject->GetLastMessage();
  EXPECT_EQ(Events.take(Logic::ProgressEvent), shared().capture.frameCount);
  EXPECT_TRUE(std::is_sorted(Events.Shares.begin(), Events.Shares.end()));
  EXPECT_EQ(Events.Shares.back(), 1);
  EXPECT_TRUE(Events.sawOnly(Logic::CameraCalibratedEvent));
  EXPECT_TRUE(rigid3dNear(handeye::toIsometry(Subject->GetMarkerToCamera()), shared().capture.markerToCamera, 0.003, 0.5));
  EXPECT_LT(Subject->GetPredictedMeanPx(), 1);
  EXPECT_GT(Subject->GetPredictedMaximumPx(), Subject->GetPredictedMeanPx());
  EXPECT_LT(Subject->GetReprojectionRmsPx(), 0.5);
  EXPECT_EQ(Subject->GetCalibrationRecording(), shared().balls);
  EXPECT_EQ(Subject->GetCalibration()->camera.width(), 320);
  EXPECT_EQ(Subject->GetLastMessage(), Subject->GetCalibrationResult()->calibration.message);

  ASSERT_TRUE(Subject->Validate(shared().otherBalls)) << Subject->GetLastMessage();
  EXPECT_TRUE(Events.sawOnly(Logic::ValidatedEvent));
  EXPECT_EQ(Subject->GetValidationCount(), shared().capture.frameCount);
  EXPECT_LT(Subject->GetValidationMeanPx(), 0.6);
  EXPECT_GE(Subject->GetValidationRmsPx(), Subject->GetValidationMeanPx());
  EXPECT_GE(Subject->GetValidationMaximumPx(), Subject->GetValidationRmsPx());
  EXPECT_LE(Subject->GetValidationMinimumPx(), Subject->GetValidationMeanPx());
  EXPECT_GT(Subject->GetValidationStandardDeviationPx(), 0);
  EXPECT_TRUE(Subject->GetLastWarnings().empty());
  EXPECT_EQ(Subject->GetValidationRecording(), shared().otherBalls);

  ASSERT_TRUE(this->registerPhantom());
  EXPECT_TRUE(Events.sawOnly(Logic::PhantomRegisteredEvent));
  EXPECT_TRUE(rigid3dNear(handeye::toIsometry(Subject->GetModelToPhantom()), trueModelToPhantom(), 1e-9, 1e-9));
  EXPECT_NEAR(Subject->GetPhantomRmsMm(), 0, 1e-9);
}

TEST_F(HandEyeCalibrationLogic, SampleTable_TellsWhatBecameOfEachFrame)
{
  this->calibrate();
  vtkTable* table = Subject->GetSampleTable();
  ASSERT_EQ(table->GetNumberOfRows(), shared().capture.frameCount);
  const handeye::CalibrationStepResult& result = *Subject->GetCalibrationResult();
  for (int row = 0; row < table->GetNumberOfRows(); ++row)
  {
    const handeye::CalibratedFrame& frame = result.frames[std::size_t(row)];
    EXPECT_EQ(this->sample(row, "frame"), frame.captured.frame);
    EXPECT_EQ(this->statusOf(row), frame.status);
    EXPECT_EQ(this->sample(row, "used"), frame.used ? 1 : 0);
    EXPECT_EQ(this->sample(row, "excluded"), 0);
  }
  EXPECT_EQ(this->statusOf(WithoutBall), "not_found");
  EXPECT_TRUE(std::isnan(this->sample(WithoutBall, "residualPx")));
  EXPECT_TRUE(std::isnan(this->sample(WithoutBall, "ballXPx")));
  EXPECT_EQ(this->statusOf(StylusLost), "stylus_invalid");
  EXPECT_TRUE(std::isnan(this->sample(StylusLost, "residualMm")));
  EXPECT_FALSE(std::isnan(this->sample(StylusLost, "ballXPx"))) << "the ball was seen there";
  EXPECT_FALSE(table->GetValueByName(StylusLost, "message").ToString().empty());
  EXPECT_EQ(this->statusOf(Displaced), "disagrees");
  EXPECT_TRUE(says(table->GetValueByName(Displaced, "message").ToString(), { "disagrees" }));
  EXPECT_GT(this->sample(Displaced, "residualMm"), 5);
  EXPECT_LT(this->sample(0, "residualPx"), 2);
  EXPECT_NEAR(this->sample(0, "distanceMm"), result.frames[0].captured.ball.distanceMm, 1e-12);
}

TEST_F(HandEyeCalibrationLogic, ValidationTable_HoldsTheErrors)
{
  this->calibrate();
  ASSERT_TRUE(Subject->Validate(shared().balls));
  ASSERT_EQ(Subject->GetLastWarnings().size(), 1) << "it is the capture that was calibrated from";
  vtkTable* table = Subject->GetValidationTable();
  ASSERT_EQ(table->GetNumberOfRows(), shared().capture.frameCount);
  EXPECT_EQ(table->GetValueByName(WithoutBall, "status").ToString(), "not_found");
  EXPECT_TRUE(std::isnan(table->GetValueByName(WithoutBall, "errorPx").ToDouble()));
  const Eigen::Vector2d ball_Image(table->GetValueByName(0, "ballXPx").ToDouble(), table->GetValueByName(0, "ballYPx").ToDouble());
  const Eigen::Vector2d projected_Image(
    table->GetValueByName(0, "projectedXPx").ToDouble(), table->GetValueByName(0, "projectedYPx").ToDouble());
  EXPECT_NEAR(table->GetValueByName(0, "errorPx").ToDouble(), (ball_Image - projected_Image).norm(), 1e-9);
  EXPECT_NEAR(table->GetValueByName(Displaced, "errorPx").ToDouble(), Subject->GetValidationMaximumPx(), 1e-12);
  EXPECT_GT(table->GetValueByName(0, "distanceMm").ToDouble(), 100);
}

TEST_F(HandEyeCalibrationLogic, StepsOutOfOrder_SayWhatIsMissing)
{
  EXPECT_TRUE(this->hasFailed(Subject->CalibrateCamera(shared().balls), { "stylus" }));
  EXPECT_TRUE(this->hasFailed(Subject->Recalibrate(), { "no capture" }));
  EXPECT_TRUE(this->hasFailed(Subject->Validate(shared().balls), { "no calibration" }));
  Subject->SetStylusTip(1, 2, 3);
  Events.sawOnly(vtkCommand::NoEvent);
  Subject->SetBallRadiusMm(0);
  EXPECT_TRUE(this->hasFailed(Subject->CalibrateCamera(shared().balls), { "radius" }));
  Subject->SetBallRadiusMm(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(this->hasFailed(Subject->CalibrateCamera(shared().balls), { "radius" }));
  Subject->SetBallRadiusMm(12);
  Subject->SetCameraFile("");
  EXPECT_TRUE(this->hasFailed(Subject->CalibrateCamera(shared().balls), { "camera file" }));
  EXPECT_EQ(Subject->GetMarkerToCamera(), nullptr);
}

TEST_F(HandEyeCalibrationLogic, FailedSteps_KeepTheResultsBefore)
{
  this->calibrate();
  ASSERT_TRUE(Subject->Validate(shared().otherBalls));
  ASSERT_TRUE(this->registerPhantom());
  Events.take(Logic::ValidatedEvent);
  Events.take(Logic::PhantomRegisteredEvent);
  Eigen::Vector3d tip_Before, tip_After;
  Subject->GetStylusTip(tip_Before.data());
  vtkMatrix4x4* const markerToCamera = Subject->GetMarkerToCamera();
  vtkMatrix4x4* const modelToPhantom = Subject->GetModelToPhantom();
  const double validationMeanPx = Subject->GetValidationMeanPx();

  EXPECT_TRUE(this->hasFailed(Subject->CalibrateStylus("/nowhere/pivot.igs.mha"), { "/nowhere/pivot.igs.mha" }));
  EXPECT_TRUE(this->hasFailed(Subject->CalibrateStylus(shared().fewBalls), { "4" }));
  EXPECT_TRUE(this->hasFailed(Subject->CalibrateStylus(shared().untracked), { "StylusToTracker" }));
  EXPECT_TRUE(this->hasFailed(Subject->CalibrateCamera("/nowhere"), { "/nowhere" }));
  EXPECT_TRUE(this->hasFailed(Subject->CalibrateCamera(shared().pivot), { "no images" }));
  EXPECT_TRUE(this->hasFailed(Subject->CalibrateCamera(shared().untracked), { "MarkerToTracker" }));
  EXPECT_EQ(Subject->GetSampleTable()->GetNumberOfRows(), shared().capture.frameCount) << "of the capture before";
  EXPECT_TRUE(this->hasFailed(Subject->CalibrateCamera(shared().fewBalls), { "4" }));
  EXPECT_TRUE(this->hasFailed(Subject->Validate("/nowhere"), { "/nowhere" }));
  EXPECT_TRUE(this->hasFailed(Subject->Validate(shared().untracked), { "MarkerToTracker" }));
  EXPECT_TRUE(this->hasFailed(Subject->RegisterPhantom(nullptr, nullptr), { "no points" }));
  EXPECT_TRUE(this->hasFailed(
    Subject->RegisterPhantom(toPoints({ { 0, 0, 0 }, { 1, 0, 0 } }), toPoints({ { 0, 0, 0 }, { 1, 0, 0 } })), { "2" }));
  EXPECT_TRUE(this->hasFailed(Subject->RegisterPhantom(toPoints(LandmarksOnModel), toPoints({ { 0, 0, 0 } })), { "1" }));
  Subject->SetCameraFile("/nowhere/camera.yml");
  EXPECT_TRUE(this->hasFailed(Subject->CalibrateCamera(shared().balls), { "/nowhere/camera.yml" }));

  Subject->GetStylusTip(tip_After.data());
  EXPECT_EQ(tip_Before, tip_After);
  EXPECT_EQ(Subject->GetMarkerToCamera(), markerToCamera);
  EXPECT_EQ(Subject->GetModelToPhantom(), modelToPhantom);
  EXPECT_EQ(Subject->GetValidationMeanPx(), validationMeanPx);
  EXPECT_EQ(Subject->GetCalibrationRecording(), shared().balls);
}

TEST_F(HandEyeCalibrationLogic, Cancel_KeepsTheResultsBefore)
{
  this->calibrate();
  vtkMatrix4x4* const markerToCamera = Subject->GetMarkerToCamera();
  Events.Shares.clear();
  Events.Actions[Logic::ProgressEvent] = [this]
  {
    if (Events.Shares.size() == 3)
    {
      Subject->RequestCancel();
    }
  };
  const bool isCalibrated = Subject->CalibrateCamera(shared().otherBalls);
  EXPECT_EQ(Events.take(Logic::ProgressEvent), 3);
  EXPECT_TRUE(this->hasFailed(isCalibrated, { "stopped", "3 of 14" }));
  Events.Shares.clear();
  EXPECT_TRUE(this->hasFailed(Subject->Validate(shared().otherBalls), { "stopped", "3 of 14" }));
  EXPECT_EQ(Subject->GetMarkerToCamera(), markerToCamera);
  EXPECT_EQ(this->statusOf(WithoutBall), "not_found") << "the capture before is still shown";
  EXPECT_EQ(Subject->GetValidationResult(), nullptr);

  Events.Actions.clear();
  Subject->RequestCancel();
  EXPECT_TRUE(Subject->Validate(shared().otherBalls)) << "a request while nothing runs stops nothing";
}

TEST_F(HandEyeCalibrationLogic, CancelAtTheLastFrame_StillCancels)
{
  this->calibrate();
  Events.Actions[Logic::ProgressEvent] = [this]
  {
    if (Events.Shares.back() == 1)
    {
      Subject->RequestCancel();
    }
  };
  EXPECT_TRUE(this->hasFailed(Subject->Validate(shared().otherBalls), { "stopped", "14 of 14" }));
}

TEST_F(HandEyeCalibrationLogic, StepDuringAStep_IsRefused)
{
  this->calibrate();
  bool inner = true;
  Events.Actions[Logic::ProgressEvent] = [&]
  {
    if (Events.Shares.back() == 1)
    {
      inner = Subject->Validate(shared().otherBalls);
    }
  };
  EXPECT_TRUE(Subject->CalibrateCamera(shared().otherBalls));
  EXPECT_FALSE(inner);
  EXPECT_EQ(Events.take(Logic::StepFailedEvent), 1);
  EXPECT_TRUE(Events.sawOnly(Logic::CameraCalibratedEvent));
}

TEST_F(HandEyeCalibrationLogic, StepInAnObserverOfTheOneBefore_IsRun)
{
  this->calibrate();
  Events.Actions[Logic::CameraCalibratedEvent] = [&] { EXPECT_TRUE(Subject->Validate(shared().otherBalls)); };
  EXPECT_TRUE(Subject->Recalibrate());
  EXPECT_EQ(Subject->GetValidationCount(), shared().capture.frameCount);
}

TEST_F(HandEyeCalibrationLogic, TipThatIsSet_ReplacesTheCalibratedOne)
{
  this->calibrate();
  vtkMatrix4x4* const markerToCamera = Subject->GetMarkerToCamera();
  Subject->SetStylusTip(1, 2, 3);
  EXPECT_TRUE(Events.sawOnly(Logic::StylusCalibratedEvent));
  double tip_Stylus[3];
  ASSERT_TRUE(Subject->GetStylusTip(tip_Stylus));
  EXPECT_EQ(tip_Stylus[2], 3);
  EXPECT_EQ(Subject->GetStylusResult(), nullptr);
  EXPECT_TRUE(std::isnan(Subject->GetStylusRmsMm()));
  EXPECT_EQ(Subject->GetMarkerToCamera(), markerToCamera);
  EXPECT_TRUE(this->hasFailed(Subject->SaveStylus("/tmp/never.json"), { "no calibration of the stylus" }));
  expectInvalidArgument([&] { Subject->SetStylusTip(1, NAN, 3); }, { "tip", "finite" });
}

TEST_F(HandEyeCalibrationLogic, ModelToCamera_TakesAKnownPointWhereItBelongs)
{
  Random random(7);
  const Eigen::Isometry3d markerToTracker = random.rigid(500), phantomToTracker = random.rigid(500);
  const auto marker = handeye::toVtk(markerToTracker), phantom = handeye::toVtk(phantomToTracker);
  vtkNew<vtkMatrix4x4> modelToCamera;
  modelToCamera->SetElement(0, 3, 42);
  std::string reason;
  EXPECT_FALSE(Subject->ComputeModelToCamera(marker, phantom, modelToCamera, &reason));
  EXPECT_TRUE(says(reason, { "no calibration" }));
  this->calibrate();
  EXPECT_FALSE(Subject->ComputeModelToCamera(marker, phantom, modelToCamera, &reason));
  EXPECT_TRUE(says(reason, { "phantom" }));
  EXPECT_EQ(modelToCamera->GetElement(0, 3), 42);
  ASSERT_TRUE(this->registerPhantom());
  Events.sawOnly(vtkCommand::NoEvent);
  ASSERT_TRUE(Subject->ComputeModelToCamera(marker, phantom, modelToCamera, &reason));
  EXPECT_EQ(reason, "");

  const Eigen::Vector3d point_Model(12, 14, 28);
  const Eigen::Vector3d point_Phantom = trueModelToPhantom() * point_Model;
  const Eigen::Vector3d point_Tracker = phantomToTracker * point_Phantom;
  const Eigen::Vector3d point_Marker = markerToTracker.inverse() * point_Tracker;
  const Eigen::Vector3d point_Camera = handeye::toIsometry(Subject->GetMarkerToCamera()) * point_Marker;
  EXPECT_TRUE(pointNear(handeye::toIsometry(modelToCamera) * point_Model, point_Camera, 1e-9));

  vtkNew<vtkMatrix4x4> scaled;
  scaled->SetElement(1, 1, 2);
  EXPECT_FALSE(Subject->ComputeModelToCamera(scaled, phantom, modelToCamera, &reason));
  EXPECT_TRUE(says(reason, { "rigid" }));
  EXPECT_FALSE(Subject->ComputeModelToCamera(nullptr, phantom, modelToCamera, &reason));
  EXPECT_FALSE(Subject->ComputeModelToCamera(marker, phantom, nullptr));
  EXPECT_TRUE(Events.sawOnly(vtkCommand::NoEvent)) << "asked for every frame of the video, it fires nothing";
}
