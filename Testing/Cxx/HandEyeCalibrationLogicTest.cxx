// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSlicerHandEyeCalibrationLogic.h"

#include "CalibrationStep.h"
#include "EigenVtk.h"
#include "GeometryMatchers.h"
#include "IoTestSupport.h"
#include "PivotStep.h"
#include "ResultFiles.h"
#include "SyntheticCapture.h"

#include <gtest/gtest.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPoints.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace
{

namespace fs = std::filesystem;
using namespace handeye::test;
using handeye::io::test::readBytes;
using handeye::io::test::TemporaryFolder;
using Logic = vtkSlicerHandEyeCalibrationLogic;

constexpr int WithoutBall = 4;
constexpr int StylusLost = 6;
constexpr int Displaced = 9;

/// Counts the events of a logic, and lets a test do something at some of them.
class Observer
{
public:
  explicit Observer(Logic* logic)
    : Subject(logic)
  {
    for (const unsigned long event : { unsigned(Logic::StylusCalibratedEvent), unsigned(Logic::CameraCalibratedEvent),
           unsigned(Logic::ValidatedEvent), unsigned(Logic::PhantomRegisteredEvent), unsigned(Logic::StepFailedEvent),
           unsigned(Logic::ProgressEvent), unsigned(vtkCommand::ModifiedEvent) })
    {
      this->Tags.push_back(logic->AddObserver(event, this, &Observer::count));
    }
  }
  ~Observer()
  {
    for (const unsigned long tag : this->Tags)
    {
      this->Subject->RemoveObserver(tag);
    }
  }
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;

  /// How often since the last question.
  int take(unsigned long event)
  {
    const int counted = this->Counts[event];
    this->Counts[event] = 0;
    return counted;
  }

  /// Since the last question one step has ended, with this event.
  testing::AssertionResult sawOnly(unsigned long event)
  {
    this->take(Logic::ProgressEvent);
    this->take(vtkCommand::ModifiedEvent);
    const std::map<unsigned long, int> counts = std::exchange(this->Counts, {});
    for (const auto& [id, count] : counts)
    {
      if (count != (id == event ? 1 : 0))
      {
        return testing::AssertionFailure() << "event " << id - vtkCommand::UserEvent << " came " << count << " times";
      }
    }
    return counts.count(event) > 0 || event == vtkCommand::NoEvent
      ? testing::AssertionSuccess()
      : testing::AssertionFailure() << "event " << event - vtkCommand::UserEvent << " did not come";
  }

  std::vector<double> Shares;  ///< what ProgressEvent brought
  std::map<unsigned long, std::function<void()>> Actions;

private:
  void count(vtkObject*, unsigned long event, void* data)
  {
    ++this->Counts[event];
    if (event == Logic::ProgressEvent)
    {
      this->Shares.push_back(*static_cast<double*>(data));
    }
    if (this->Actions.count(event) > 0)
    {
      this->Actions[event]();
    }
  }

  Logic* Subject;
  std::vector<unsigned long> Tags;
  std::map<unsigned long, int> Counts;
};

/// Recordings that all tests share, written once.
struct Recordings
{
  fs::path folder = fs::path(HANDEYE_TEST_OUTPUT_DIR) / "HandEyeCalibrationLogic";
  SyntheticCapture capture;
  std::string camera = (folder / "camera.yml").string();
  std::string pivot = (folder / "pivot.igs.mha").string();
  std::string balls = (folder / "calibration.igs.mha").string();
  std::string fewBalls = (folder / "few.igs.mha").string();
  std::string otherBalls = (folder / "validation.igs.mha").string();
  std::string untracked = (folder / "untracked.igs.mha").string();

  Recordings()
  {
    fs::remove_all(folder);
    fs::create_directories(folder);
    capture.writeCamera(camera);
    capture.writePivot(pivot, 1);
    capture.writeBalls(otherBalls, 2);
    SyntheticCapture flawed = capture;
    flawed.withoutBall = { WithoutBall };
    flawed.stylusInvalid = { StylusLost };
    flawed.displaced[Displaced] = { 25, -15, 10 };
    flawed.writeBalls(balls, 3);
    SyntheticCapture few = capture;
    few.frameCount = 4;
    few.writeBalls(fewBalls, 4);
    few.isTracked = false;
    few.writeBalls(untracked, 5);
  }
};

vtkSmartPointer<vtkPoints> toPoints(const std::vector<Eigen::Vector3d>& coordinates)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  for (const Eigen::Vector3d& coordinate : coordinates)
  {
    points->InsertNextPoint(coordinate.data());
  }
  return points;
}

const std::vector<Eigen::Vector3d> LandmarksOnModel = { { 0, 0, 0 }, { 40, 3, -2 }, { 5, 35, 1 }, { 12, 14, 28 } };

Eigen::Isometry3d trueModelToPhantom()
{
  return makeRigid({ 0.4, -0.2, 1.3 }, { 70, 12, -33 });
}

class HandEyeCalibrationLogic : public testing::Test
{
public:
  static void SetUpTestSuite() { recordings() = std::make_unique<Recordings>(); }
  static void TearDownTestSuite() { recordings().reset(); }

protected:
  HandEyeCalibrationLogic() { this->setInputs(this->Subject); }

  static const Recordings& shared() { return *recordings(); }

  void setInputs(Logic* logic) const
  {
    logic->SetCameraFile(shared().camera);
    logic->SetBallRadiusMm(shared().capture.ballRadiusMm);
  }

  void calibrate()
  {
    ASSERT_TRUE(this->Subject->CalibrateStylus(shared().pivot)) << this->Subject->GetLastMessage();
    ASSERT_TRUE(this->Subject->CalibrateCamera(shared().balls)) << this->Subject->GetLastMessage();
    this->Events.sawOnly(vtkCommand::NoEvent);
  }

  bool registerPhantom(const Eigen::Isometry3d& modelToPhantom = trueModelToPhantom())
  {
    std::vector<Eigen::Vector3d> touched;
    for (const Eigen::Vector3d& landmark : LandmarksOnModel)
    {
      touched.push_back(modelToPhantom * landmark);
    }
    return this->Subject->RegisterPhantom(toPoints(LandmarksOnModel), toPoints(touched));
  }

  /// The step failed, said so once and for a person, in these words.
  testing::AssertionResult hasFailed(bool result, const std::vector<std::string>& words)
  {
    if (result)
    {
      return testing::AssertionFailure() << "the step succeeded: " << this->Subject->GetLastMessage();
    }
    const testing::AssertionResult events = this->Events.sawOnly(Logic::StepFailedEvent);
    return events ? says(this->Subject->GetLastMessage(), words) : events;
  }

  std::string statusOf(int frame) { return this->Subject->GetSampleTable()->GetValueByName(frame, "status").ToString(); }
  double sample(int frame, const char* column) { return this->Subject->GetSampleTable()->GetValueByName(frame, column).ToDouble(); }

  vtkNew<Logic> Subject;
  Observer Events{ this->Subject };

private:
  static std::unique_ptr<Recordings>& recordings()
  {
    static std::unique_ptr<Recordings> instance;
    return instance;
  }
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
  EXPECT_TRUE(this->hasFailed(Subject->CalibrateCamera(shared().pivot), { "MarkerToTracker" }));
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

TEST_F(HandEyeCalibrationLogic, UnusableCapture_IsShownBesideTheResultBefore)
{
  this->calibrate();
  ASSERT_FALSE(Subject->CalibrateCamera(shared().fewBalls));
  EXPECT_EQ(Subject->GetSampleTable()->GetNumberOfRows(), 4);
  EXPECT_TRUE(std::isnan(this->sample(0, "residualPx"))) << "no calibration, no residual";
  ASSERT_NE(Subject->GetLastCalibrationAttempt(), nullptr);
  EXPECT_FALSE(Subject->GetLastCalibrationAttempt()->isUsable());
  EXPECT_TRUE(Subject->GetCalibrationResult()->isUsable());
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

TEST_F(HandEyeCalibrationLogic, ExcludedSample_ComesBackToTheIdenticalResult)
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

TEST_F(HandEyeCalibrationLogic, Exclusion_IsForSamplesOfThisCapture)
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

TEST_F(HandEyeCalibrationLogic, TooManyExcluded_FailsAndIsRepairedByBringingThemBack)
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

TEST_F(HandEyeCalibrationLogic, NewCalibration_TakesTheValidationAway)
{
  this->calibrate();
  ASSERT_TRUE(Subject->Validate(shared().otherBalls));
  ASSERT_TRUE(Subject->Recalibrate());
  EXPECT_EQ(Subject->GetValidationResult(), nullptr);
  EXPECT_TRUE(std::isnan(Subject->GetValidationMeanPx()));
  EXPECT_EQ(Subject->GetValidationTable()->GetNumberOfRows(), 0);
}

TEST_F(HandEyeCalibrationLogic, Methods_AreTheOnesThatWereAskedFor)
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

TEST_F(HandEyeCalibrationLogic, TransformNames_AreTheOnesThatWereSet)
{
  const TemporaryFolder folder;
  SyntheticCapture renamed;
  renamed.stylusTransform = "ProbeToReference";
  renamed.markerTransform = "HeadToReference";
  const std::string balls = (folder.path() / "balls.mha").string(), pivot = (folder.path() / "pivot.mha").string();
  renamed.writeBalls(balls, 3);
  renamed.writePivot(pivot, 1);
  EXPECT_TRUE(this->hasFailed(Subject->CalibrateStylus(pivot), { "StylusToTracker", "ProbeToReference" }));
  Subject->SetStylusTransform("ProbeToReference");
  Subject->SetMarkerTransform("HeadToReference");
  EXPECT_TRUE(Subject->CalibrateStylus(pivot));
  EXPECT_TRUE(Subject->CalibrateCamera(balls));
  const std::string file = (folder.path() / "calibration.json").string();
  ASSERT_TRUE(Subject->SaveCalibration(file));
  vtkNew<Logic> other;
  ASSERT_TRUE(other->LoadCalibration(file));
  EXPECT_EQ(other->GetStylusTransform(), "ProbeToReference");
  EXPECT_EQ(other->GetMarkerTransform(), "HeadToReference");
  EXPECT_TRUE(other->Validate(balls)) << other->GetLastMessage();
}

TEST_F(HandEyeCalibrationLogic, SavedResults_AreTheSameWhenLoaded)
{
  const TemporaryFolder folder;
  const auto in = [&](const char* name) { return (folder.path() / name).string(); };
  this->calibrate();
  ASSERT_TRUE(Subject->Validate(shared().otherBalls));
  ASSERT_TRUE(this->registerPhantom());
  Events.sawOnly(vtkCommand::NoEvent);
  EXPECT_TRUE(Subject->SaveStylus(in("stylus.json")));
  EXPECT_TRUE(Subject->SaveCalibration(in("calibration.json")));
  EXPECT_TRUE(Subject->SaveValidation(in("validation.json")));
  EXPECT_TRUE(Subject->SavePhantomRegistration(in("phantom.json")));
  EXPECT_TRUE(Subject->SaveValidationReport(in("report")));
  EXPECT_TRUE(fs::exists(in("report/report.html")));
  EXPECT_TRUE(Events.sawOnly(vtkCommand::NoEvent)) << "saving changes no result";
  EXPECT_NE(readBytes(in("validation.json")).find("projectionErrorPx"), std::string::npos);

  vtkNew<Logic> other;
  Observer events(other);
  ASSERT_TRUE(other->LoadStylus(in("stylus.json"))) << other->GetLastMessage();
  EXPECT_TRUE(events.sawOnly(Logic::StylusCalibratedEvent));
  ASSERT_TRUE(other->LoadCalibration(in("calibration.json"))) << other->GetLastMessage();
  EXPECT_TRUE(events.sawOnly(Logic::CameraCalibratedEvent));
  ASSERT_TRUE(other->LoadPhantomRegistration(in("phantom.json"))) << other->GetLastMessage();
  EXPECT_TRUE(events.sawOnly(Logic::PhantomRegisteredEvent));

  Eigen::Vector3d tip_Before, tip_After;
  Subject->GetStylusTip(tip_Before.data());
  ASSERT_TRUE(other->GetStylusTip(tip_After.data()));
  EXPECT_EQ(tip_Before, tip_After);
  const auto isSame = [](vtkMatrix4x4* a, vtkMatrix4x4* b)
  { return rigid3dNear(handeye::toIsometry(a), handeye::toIsometry(b), 1e-12, 1e-12); };
  EXPECT_TRUE(isSame(other->GetMarkerToCamera(), Subject->GetMarkerToCamera()));
  EXPECT_TRUE(isSame(other->GetModelToPhantom(), Subject->GetModelToPhantom()));
  EXPECT_EQ(other->GetStylusRmsMm(), Subject->GetStylusRmsMm());
  EXPECT_EQ(other->GetPredictedMeanPx(), Subject->GetPredictedMeanPx());
  EXPECT_EQ(other->GetPredictedMaximumPx(), Subject->GetPredictedMaximumPx());
  EXPECT_EQ(other->GetReprojectionRmsPx(), Subject->GetReprojectionRmsPx());
  EXPECT_EQ(other->GetPhantomRmsMm(), Subject->GetPhantomRmsMm());
  EXPECT_EQ(other->GetCalibrationResult(), nullptr) << "the file does not hold all of it";

  ASSERT_TRUE(other->Validate(shared().otherBalls)) << other->GetLastMessage();
  EXPECT_NEAR(other->GetValidationMeanPx(), Subject->GetValidationMeanPx(), 1e-9);

  for (const char* name : { "stylus.json", "calibration.json", "phantom.json" })
  {
    const std::string again = in("again_") + name;
    EXPECT_TRUE(name[0] == 's' ? other->SaveStylus(again)
        : name[0] == 'c'       ? other->SaveCalibration(again)
                               : other->SavePhantomRegistration(again));
    EXPECT_EQ(readBytes(again), readBytes(in(name)));
  }
}

TEST_F(HandEyeCalibrationLogic, BadFiles_AreRefusedAndTheResultsKept)
{
  const TemporaryFolder folder;
  this->calibrate();
  ASSERT_TRUE(this->registerPhantom());
  Events.sawOnly(vtkCommand::NoEvent);
  vtkMatrix4x4* const markerToCamera = Subject->GetMarkerToCamera();
  const std::string prose = folder.write("prose.json", "This is a text.").string();
  const std::string failed =
    folder.write("failed.json", R"({"status": "too_few_samples", "message": "5 samples", "markerToCamera": 0})").string();
  const std::string empty = folder.write("empty.json", "{}").string();
  const std::string missing = (folder.path() / "missing.json").string();
  for (const std::string& file : { prose, failed, empty, missing, folder.path().string() })
  {
    EXPECT_TRUE(this->hasFailed(Subject->LoadStylus(file), { file }));
    EXPECT_TRUE(this->hasFailed(Subject->LoadCalibration(file), { file }));
    EXPECT_TRUE(this->hasFailed(Subject->LoadPhantomRegistration(file), { file }));
  }
  EXPECT_EQ(Subject->GetMarkerToCamera(), markerToCamera);
  EXPECT_NE(Subject->GetModelToPhantom(), nullptr);
  EXPECT_NE(Subject->GetStylusResult(), nullptr);
  EXPECT_TRUE(Subject->Recalibrate()) << "the capture is still there, too";
}

TEST_F(HandEyeCalibrationLogic, OddFiguresInAFile_AreNotKnown)
{
  const TemporaryFolder folder;
  const std::string file =
    folder.write("stylus.json", R"({"tip_Stylus_Mm": [1, 2, 3], "rmsMm": ["none"], "predictedErrorPx": [1, 2]})").string();
  ASSERT_TRUE(Subject->LoadStylus(file)) << Subject->GetLastMessage();
  EXPECT_TRUE(std::isnan(Subject->GetStylusRmsMm()));
}

TEST_F(HandEyeCalibrationLogic, Saving_FailsWithoutAResultOrAFolder)
{
  EXPECT_TRUE(this->hasFailed(Subject->SaveStylus("/tmp/never.json"), { "no calibration of the stylus" }));
  EXPECT_TRUE(this->hasFailed(Subject->SaveCalibration("/tmp/never.json"), { "no calibration" }));
  EXPECT_TRUE(this->hasFailed(Subject->SaveValidation("/tmp/never.json"), { "no validation" }));
  EXPECT_TRUE(this->hasFailed(Subject->SaveValidationReport("/tmp/never"), { "no validation" }));
  EXPECT_TRUE(this->hasFailed(Subject->SavePhantomRegistration("/tmp/never.json"), { "no registration" }));
  EXPECT_FALSE(fs::exists("/tmp/never.json"));
  ASSERT_TRUE(this->registerPhantom());
  Events.sawOnly(vtkCommand::NoEvent);
  EXPECT_TRUE(this->hasFailed(Subject->SavePhantomRegistration("/nowhere/phantom.json"), { "/nowhere" }));
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

namespace
{

/// What a module's logic gets to see of a scene.
class SceneWitness : public vtkSlicerModuleLogic
{
public:
  static SceneWitness* New();
  vtkTypeMacro(SceneWitness, vtkSlicerModuleLogic)

  std::string Calls;

protected:
  void SetMRMLSceneInternal(vtkMRMLScene* newScene) override
  {
    this->Superclass::SetMRMLSceneInternal(newScene);
    this->Calls += "set ";
  }
  void UnobserveMRMLScene() override { this->Calls += "leave "; }
  void RegisterNodes() override { this->Calls += "register "; }
  void UpdateFromMRMLScene() override { this->Calls += "update "; }
};

vtkStandardNewMacro(SceneWitness);

}  // namespace

TEST(SlicerBase, Scene_ComesInTheOrderOfSlicer)
{
  int somewhere = 0;
  auto* const scene = reinterpret_cast<vtkMRMLScene*>(&somewhere);  // never looked into
  vtkNew<SceneWitness> witness;
  witness->SetMRMLScene(nullptr);
  EXPECT_EQ(witness->Calls, "");
  witness->SetMRMLScene(scene);
  witness->SetMRMLScene(scene);
  EXPECT_EQ(witness->GetMRMLScene(), scene);
  EXPECT_EQ(witness->Calls, "set register update ");
  witness->Calls.clear();
  witness->SetMRMLScene(nullptr);
  EXPECT_EQ(witness->Calls, "leave set ");
  EXPECT_EQ(witness->GetMRMLScene(), nullptr);

  vtkNew<Logic> logic;
  logic->SetMRMLScene(scene);
  EXPECT_EQ(logic->GetMRMLScene(), scene);
  EXPECT_TRUE(logic->IsA("vtkSlicerModuleLogic"));
  EXPECT_TRUE(logic->IsA("vtkMRMLAbstractLogic"));
}
