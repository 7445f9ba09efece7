// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "EigenVtk.h"
#include "GeometryMatchers.h"
#include "SyntheticCapture.h"
#include "vtkSlicerHandEyeCalibrationLogic.h"

#include <gtest/gtest.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace handeye::test
{

using Logic = vtkSlicerHandEyeCalibrationLogic;

/// Frames of the calibration capture in which something is wrong.
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

/// The recordings that all tests of a program share, written once.
struct Recordings
{
  std::filesystem::path folder =
    std::filesystem::path(HANDEYE_TEST_OUTPUT_DIR) / testing::UnitTest::GetInstance()->current_test_suite()->name();
  SyntheticCapture capture;
  std::string camera = (folder / "camera.yml").string();
  std::string pivot = (folder / "pivot.igs.mha").string();
  std::string balls = (folder / "calibration.igs.mha").string();
  std::string fewBalls = (folder / "few.igs.mha").string();
  std::string otherBalls = (folder / "validation.igs.mha").string();
  std::string untracked = (folder / "untracked.igs.mha").string();

  Recordings()
  {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
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

inline vtkSmartPointer<vtkPoints> toPoints(const std::vector<Eigen::Vector3d>& coordinates)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  for (const Eigen::Vector3d& coordinate : coordinates)
  {
    points->InsertNextPoint(coordinate.data());
  }
  return points;
}

inline const std::vector<Eigen::Vector3d> LandmarksOnModel = { { 0, 0, 0 }, { 40, 3, -2 }, { 5, 35, 1 }, { 12, 14, 28 } };

inline Eigen::Isometry3d trueModelToPhantom()
{
  return makeRigid({ 0.4, -0.2, 1.3 }, { 70, 12, -33 });
}

/// A logic whose inputs are set, and an observer of it.
class LogicFixture : public testing::Test
{
public:
  static void SetUpTestSuite() { recordings() = std::make_unique<Recordings>(); }
  static void TearDownTestSuite() { recordings().reset(); }

protected:
  LogicFixture() { this->setInputs(this->Subject); }

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

}  // namespace handeye::test
