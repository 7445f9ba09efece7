// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CalibrationStep.h"
#include "LogicFixture.h"
#include "ResultFiles.h"

#include <vtkMatrix4x4.h>

#include <cmath>

namespace
{

using namespace handeye::test;

class HandEyeRecalibration : public LogicFixture
{
};

}  // namespace

TEST_F(HandEyeRecalibration, ExcludedSample_ComesBackToTheIdenticalResult)
{
  this->calibrate();
  const Eigen::Matrix4d before = handeye::toEigen(Subject->GetMarkerToCamera());
  const std::string documentBefore = handeye::calibrationJson(*Subject->GetCalibrationResult()).dump();
  Events.take(vtkCommand::ModifiedEvent);

  EXPECT_TRUE(Subject->SetSampleExcluded(2, true));
  EXPECT_TRUE(Subject->SetSampleExcluded(2, true));
  EXPECT_EQ(Events.take(vtkCommand::ModifiedEvent), 1);
  EXPECT_TRUE(Subject->GetSampleExcluded(2));
  EXPECT_EQ(this->sample(2, "excluded"), 1);
  EXPECT_EQ(this->sample(2, "used"), 1) << "until Recalibrate()";
  EXPECT_EQ(handeye::toEigen(Subject->GetMarkerToCamera()), before);

  ASSERT_TRUE(Subject->Recalibrate()) << Subject->GetLastMessage();
  EXPECT_EQ(Events.take(Logic::ProgressEvent), 0) << "the ball was looked for again";
  EXPECT_TRUE(Events.sawOnly(Logic::CameraCalibratedEvent));
  EXPECT_NE(handeye::toEigen(Subject->GetMarkerToCamera()), before);
  EXPECT_EQ(this->statusOf(2), "excluded");
  EXPECT_EQ(this->sample(2, "used"), 0);
  EXPECT_EQ(Subject->GetSampleTable()->GetNumberOfRows(), shared().capture.frameCount) << "excluded samples stay to be seen";

  EXPECT_TRUE(Subject->SetSampleExcluded(2, false));
  ASSERT_TRUE(Subject->Recalibrate());
  EXPECT_EQ(handeye::toEigen(Subject->GetMarkerToCamera()), before);
  EXPECT_EQ(handeye::calibrationJson(*Subject->GetCalibrationResult()).dump(), documentBefore);
}

TEST_F(HandEyeRecalibration, Exclusion_IsForSamplesOfThisCapture)
{
  this->calibrate();
  EXPECT_FALSE(Subject->SetSampleExcluded(WithoutBall, true));
  EXPECT_FALSE(Subject->SetSampleExcluded(StylusLost, true));
  EXPECT_FALSE(Subject->SetSampleExcluded(99, true));
  EXPECT_FALSE(Subject->GetSampleExcluded(99));
  EXPECT_TRUE(Subject->SetSampleExcluded(Displaced, true)) << "samples that disagree may be excluded, too";
  ASSERT_TRUE(Subject->CalibrateCamera(shared().balls));
  EXPECT_FALSE(Subject->GetSampleExcluded(Displaced)) << "a new capture begins anew";
}

TEST_F(HandEyeRecalibration, TooManyExcluded_FailsAndIsRepairedByBringingThemBack)
{
  this->calibrate();
  vtkMatrix4x4* const markerToCamera = Subject->GetMarkerToCamera();
  for (int frame = 0; frame < shared().capture.frameCount; ++frame)
  {
    Subject->SetSampleExcluded(frame, true);
  }
  EXPECT_TRUE(this->hasFailed(Subject->Recalibrate(), { "0" }));
  EXPECT_EQ(Subject->GetMarkerToCamera(), markerToCamera);
  for (int frame = 0; frame < shared().capture.frameCount; ++frame)
  {
    Subject->SetSampleExcluded(frame, false);
  }
  const Eigen::Matrix4d before = handeye::toEigen(markerToCamera);
  ASSERT_TRUE(Subject->Recalibrate());
  EXPECT_EQ(handeye::toEigen(Subject->GetMarkerToCamera()), before);
}

TEST_F(HandEyeRecalibration, UnusableCapture_IsShownBesideTheResultBefore)
{
  this->calibrate();
  ASSERT_FALSE(Subject->CalibrateCamera(shared().fewBalls));
  EXPECT_EQ(Subject->GetSampleTable()->GetNumberOfRows(), 4);
  EXPECT_TRUE(std::isnan(this->sample(0, "residualPx"))) << "no calibration, no residual";
  ASSERT_NE(Subject->GetLastCalibrationAttempt(), nullptr);
  EXPECT_FALSE(Subject->GetLastCalibrationAttempt()->isUsable());
  EXPECT_TRUE(Subject->GetCalibrationResult()->isUsable());
}

TEST_F(HandEyeRecalibration, NewCalibration_TakesTheValidationAway)
{
  this->calibrate();
  ASSERT_TRUE(Subject->Validate(shared().otherBalls));
  ASSERT_TRUE(Subject->Recalibrate());
  EXPECT_EQ(Subject->GetValidationResult(), nullptr);
  EXPECT_TRUE(std::isnan(Subject->GetValidationMeanPx()));
  EXPECT_EQ(Subject->GetValidationTable()->GetNumberOfRows(), 0);
}

TEST_F(HandEyeRecalibration, Methods_AreTheOnesThatWereAskedFor)
{
  this->calibrate();
  const Eigen::Isometry3d global = handeye::toIsometry(Subject->GetMarkerToCamera());
  Subject->SetSolverMethod(Logic::ProcrustesSolver);
  ASSERT_TRUE(Subject->Recalibrate());
  const Eigen::Isometry3d procrustes = handeye::toIsometry(Subject->GetMarkerToCamera());
  EXPECT_FALSE(rigid3dNear(procrustes, global, 0, 0));
  EXPECT_TRUE(rigid3dNear(procrustes, global, 0.01, 1));
  const double exactX = this->sample(0, "ballXPx");
  Subject->SetSegmentationMethod(Logic::HoughSegmentation);
  static_cast<void>(Subject->CalibrateCamera(shared().balls));
  EXPECT_NE(this->sample(0, "ballXPx"), exactX);
}
