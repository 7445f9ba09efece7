// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PivotStep.h"

#include "CaptureSimulation.h"
#include "GeometryMatchers.h"
#include "PivotSimulation.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace handeye;
using namespace handeye::test;
using handeye::io::test::expectFileError;
using handeye::io::test::TemporaryFolder;

namespace
{

std::vector<io::SequenceFrame> toFrames(const std::vector<Eigen::Isometry3d>& poses)
{
  std::vector<io::SequenceFrame> frames(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
  {
    frames[i].transforms["StylusToTracker"] = { poses[i].matrix(), "OK" };
  }
  return frames;
}

}  // namespace

TEST(PivotStep, Recording_GivesTipAndTheFramesItRestsOn)
{
  Random random(1);
  const PivotSimulation stylus;
  auto frames = toFrames(stylus.recordPivoting(120, 35 * Degree, random));
  frames[3].transforms["StylusToTracker"].status = "INVALID";
  frames[50].transforms.clear();
  frames[80].transforms["StylusToTracker"].matrix->col(3).head<3>() += Eigen::Vector3d(20, 0, 0);
  frames[101] = frames[100];
  const TemporaryFolder folder;
  const auto path = folder.path() / "pivot.igs.mha";
  SimulatedSession::writeTracking(path, frames);
  const PivotStepResult result = pivotFromRecording(io::Recording::open(path), "StylusToTracker");
  ASSERT_TRUE(result.calibration.isUsable()) << result.calibration.message;
  EXPECT_TRUE(pointNear(result.calibration.tip_Stylus, stylus.tip_Stylus, 0.1));
  EXPECT_EQ(result.invalidFrames, (std::vector<int>{ 3, 50 }));
  EXPECT_EQ(std::count(result.rejectedFrames.begin(), result.rejectedFrames.end(), 80), 1)
    << "a frame, not an index of valid poses";
  EXPECT_EQ(result.repeatedFrames, (std::vector<int>{ 101 }));
  EXPECT_EQ(result.poseFrames.size(), 118U);
  EXPECT_EQ(result.usedFrames.size() + result.rejectedFrames.size() + result.invalidFrames.size(), 119U);
  EXPECT_EQ(result.usedFrames.back(), 119);
}

TEST(PivotStep, HiddenStylusAllAlong_IsTooFewPoses)
{
  auto frames = toFrames(std::vector<Eigen::Isometry3d>(30, Eigen::Isometry3d::Identity()));
  for (io::SequenceFrame& frame : frames)
  {
    frame.transforms["StylusToTracker"].status = "INVALID";
  }
  const TemporaryFolder folder;
  const auto path = folder.path() / "pivot.igs.mha";
  SimulatedSession::writeTracking(path, frames);
  const PivotStepResult result = pivotFromRecording(io::Recording::open(path), "StylusToTracker");
  EXPECT_EQ(result.calibration.status, PivotCalibrationResult::Status::TooFewPoses);
  EXPECT_EQ(result.invalidFrames.size(), 30U);
  EXPECT_TRUE(result.usedFrames.empty());
}

TEST(PivotStep, OtherTransformName_ListsThoseThatExist)
{
  const TemporaryFolder folder;
  const auto path = folder.path() / "pivot.igs.mha";
  SimulatedSession::writeTracking(path, toFrames({ Eigen::Isometry3d::Identity() }));
  const io::Recording recording = io::Recording::open(path);
  expectFileError(
    [&] { (void)pivotFromRecording(recording, "PointerToTracker"); }, { "pivot.igs.mha", "PointerToTracker", "StylusToTracker" });
}
