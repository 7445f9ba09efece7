// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SpinStep.h"

#include "CaptureSimulation.h"
#include "GeometryMatchers.h"
#include "PivotSimulation.h"

#include <gtest/gtest.h>

using namespace handeye;
using namespace handeye::test;
using handeye::io::test::expectFileError;
using handeye::io::test::TemporaryFolder;
using nlohmann::json;

namespace
{

/// A recording of a stylus that is spun about its own z axis, or swung.
io::Recording record(const TemporaryFolder& folder, const Eigen::Vector3d& axis)
{
  Random random(1);
  const auto poses = PivotSimulation().record(
    120, [&] { return rotationFromVector(random.uniform(-1.5, 1.5) * axis); }, random);
  std::vector<io::SequenceFrame> frames(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
  {
    frames[i].transforms["StylusToTracker"] = { poses[i].matrix(), i == 3 ? "INVALID" : "OK" };
  }
  frames[50] = frames[49];
  const auto path = folder.path() / "spin.igs.mha";
  SimulatedSession::writeTracking(path, frames);
  return io::Recording::open(path);
}

const json Stylus = { { "schema", "handeye-stylus/1" }, { "status", "ok" }, { "tip_Stylus_Mm", { 2.4, -3.1, -158 } },
  { "rmsMm", 0.2 } };

}  // namespace

TEST(SpinStep, Recording_AddsTheTipsFrameToTheStylusFile)
{
  const TemporaryFolder folder;
  const SpinStepResult step = spinFromRecording(record(folder, { 0, 0, 1 }), "StylusToTracker", PivotSimulation().tip_Stylus);
  ASSERT_TRUE(step.calibration.isUsable()) << step.calibration.message;
  EXPECT_EQ(step.invalidFrames, (std::vector<int>{ 3 }));
  EXPECT_TRUE(std::binary_search(step.rejectedFrames.begin(), step.rejectedFrames.end(), 50)) << "a frame, not an index";
  const json object = spinJson(step, Stylus);
  EXPECT_EQ(object["status"], "ok");
  EXPECT_EQ(object["rmsMm"], 0.2) << "what was in the file stays";
  EXPECT_EQ(object["tip_Stylus_Mm"], Stylus["tip_Stylus_Mm"]);
  ASSERT_EQ(object["stylusTipToStylus"].size(), 4U);
  EXPECT_NEAR(object["stylusTipToStylus"][2][2].get<double>(), -1, 1e-4) << "-Z from the tip along the shaft";
  EXPECT_NEAR(object["stylusTipToStylus"][2][3].get<double>(), -158, 1e-12);
  EXPECT_NEAR(object["shaft_Stylus"][2].get<double>(), 1, 1e-4);
}

TEST(SpinStep, UnusableOne_HasAReasonAndNoFrame)
{
  const TemporaryFolder folder;
  const json object =
    spinJson(spinFromRecording(record(folder, { 1, 0, 0 }), "StylusToTracker", PivotSimulation().tip_Stylus), Stylus);
  EXPECT_EQ(object["status"], "unclear_direction");
  EXPECT_FALSE(object["message"].get<std::string>().empty());
  EXPECT_FALSE(object.contains("stylusTipToStylus"));
  EXPECT_FALSE(object.contains("tip_Stylus_Mm"));
}

TEST(SpinStep, OtherTransformName_ListsThoseThatExist)
{
  const TemporaryFolder folder;
  const io::Recording recording = record(folder, { 0, 0, 1 });
  expectFileError(
    [&] {
      (void)spinFromRecording(recording, "PointerToTracker", { 0, 0, -1 });
    },
    { "PointerToTracker", "StylusToTracker" });
}
