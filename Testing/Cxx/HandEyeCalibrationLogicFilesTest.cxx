// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "IoTestSupport.h"
#include "LogicFixture.h"
#include "ResultFiles.h"

#include <nlohmann/json.hpp>
#include <vtkMatrix4x4.h>

#include <cmath>
#include <filesystem>

namespace
{

namespace fs = std::filesystem;
using namespace handeye::test;
using handeye::io::test::readBytes;
using handeye::io::test::TemporaryFolder;

class HandEyeCalibrationLogicFiles : public LogicFixture
{
};

}  // namespace

TEST_F(HandEyeCalibrationLogicFiles, TransformNames_AreTheOnesThatWereSet)
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

TEST_F(HandEyeCalibrationLogicFiles, SavedResults_AreTheSameWhenLoaded)
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

TEST_F(HandEyeCalibrationLogicFiles, BadFiles_AreRefusedAndTheResultsKept)
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

TEST_F(HandEyeCalibrationLogicFiles, ShaftOfASpunStylus_IsKnown)
{
  const TemporaryFolder folder;
  Eigen::Vector3d shaft_Stylus(7, 7, 7);
  ASSERT_TRUE(Subject->LoadStylus(folder.write("stylus.json", R"({"status": "ok", "tip_Stylus_Mm": [0, 0, -150]})").string()));
  EXPECT_FALSE(Subject->GetStylusShaft(shaft_Stylus.data()));
  EXPECT_EQ(shaft_Stylus, Eigen::Vector3d(7, 7, 7));
  const std::string spun = folder
                             .write("spun.json", R"({"status": "ok", "tip_Stylus_Mm": [0, 0, -150],
    "stylusTipToStylus": [[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, -150], [0, 0, 0, 1]]})")
                             .string();
  ASSERT_TRUE(Subject->LoadStylus(spun)) << Subject->GetLastMessage();
  ASSERT_TRUE(Subject->GetStylusShaft(shaft_Stylus.data()));
  EXPECT_EQ(shaft_Stylus, Eigen::Vector3d(0, 0, 1)) << "-Z of the tip's frame";
}

TEST_F(HandEyeCalibrationLogicFiles, OddFiguresInAFile_AreNotKnown)
{
  const TemporaryFolder folder;
  this->calibrate();
  nlohmann::json document = handeye::calibrationJson(*Subject->GetCalibrationResult());
  document["predictedErrorPx"] = { 1, 2 };
  document["reprojectionRmsPx"] = "small";
  ASSERT_TRUE(Subject->LoadCalibration(folder.write("odd.json", document.dump()).string())) << Subject->GetLastMessage();
  EXPECT_TRUE(std::isnan(Subject->GetPredictedMeanPx()));
  EXPECT_TRUE(std::isnan(Subject->GetReprojectionRmsPx()));
}

TEST_F(HandEyeCalibrationLogicFiles, Saving_FailsWithoutAResultOrAFolder)
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
