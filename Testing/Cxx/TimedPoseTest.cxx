// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TimedPose.h"
#include "IoTestSupport.h"
#include "OverlayPose.h"
#include "SequenceMetafileWriter.h"
#include "Simulation.h"

namespace
{

using namespace handeye;
using io::TransformSample;
using io::test::TemporaryFolder;

/// Ten frames, 40 ms apart: the tool moves by 100 mm/s; hidden in frame 7.
io::Recording recordingIn(const TemporaryFolder& folder, const std::string& appliedSec = "0")
{
  io::SequenceMetafileWriterOptions options;
  options.fields[io::AppliedLatencyField] = appliedSec;
  io::SequenceMetafileWriter writer(folder.path() / "r.igs.mha", options);
  for (int i = 0; i < 10; ++i)
  {
    io::SequenceFrame frame;
    frame.timestampSec = 5 + 0.04 * i;
    frame.transforms["MarkerToTracker"] = { test::makeRigid({ 0, 0, 0.01 * i }, { 4.0 * i, 0, 0 }).matrix(),
      i == 7 ? "INVALID" : "OK" };
    frame.transforms["PhantomToTracker"] = { Eigen::Matrix4d::Identity(), "OK" };
    writer.append(frame);
  }
  writer.close();
  return io::Recording::open(folder.path() / "r.igs.mha");
}

TEST(TimedPose, Latency_InterpolatesBetweenFrames)
{
  const TemporaryFolder folder;
  const io::Recording recording = recordingIn(folder);
  for (double latencySec : { 0.0, 0.01, -0.03, 0.04, -0.1 })
  {
    const TransformSample pose = poseOfFrame(recording, 4, "MarkerToTracker", latencySec);
    ASSERT_TRUE(pose.isUsable()) << latencySec << ": " << pose.reason;
    EXPECT_NEAR(pose.transform.translation().x(), 16 + 100 * latencySec, 1e-9) << latencySec;
  }
}

/// 5 and 10 frames a second are recordings, too; placements that are seconds apart are not.
TEST(TimedPose, SlowRecordings_AreInterpolatedAndPlacementsAreNot)
{
  for (double spacingSec : { 0.1, 0.2, 3.0 })
  {
    const TemporaryFolder folder;
    io::SequenceMetafileWriter writer(folder.path() / "slow.igs.mha");
    for (int i = 0; i < 10; ++i)
    {
      io::SequenceFrame frame;
      frame.timestampSec = 1700000000 + spacingSec * i;
      frame.transforms["MarkerToTracker"] = { test::makeRigid({ 0, 0, 0 }, { 100 * spacingSec * i, 0, 0 }).matrix(), "OK" };
      writer.append(frame);
    }
    writer.close();
    const io::Recording recording = io::Recording::open(folder.path() / "slow.igs.mha");
    const TransformSample pose = poseOfFrame(recording, 4, "MarkerToTracker", -0.04);
    ASSERT_EQ(pose.isUsable(), spacingSec < 1) << spacingSec << ": " << pose.reason;
    if (spacingSec > 1)
    {
      io::test::expectFileError([&] { (void)latencyNotes(recording, -0.04); }, { "slow.igs.mha", "3.0 s apart", "capture" });
      EXPECT_TRUE(latencyNotes(recording, 0).empty()) << "without a latency there is nothing wrong with it";
    }
    EXPECT_NEAR(pose.transform.translation().x(), pose.isUsable() ? 400 * spacingSec - 4 : 0, 1e-4) << spacingSec;
  }
}

TEST(TimedPose, OutsideOrHidden_HasNoPose)
{
  const TemporaryFolder folder;
  const io::Recording recording = recordingIn(folder);
  EXPECT_EQ(poseOfFrame(recording, 1, "MarkerToTracker", -0.1).status, TransformSample::Status::Invalid);
  EXPECT_EQ(poseOfFrame(recording, 9, "MarkerToTracker", 0.01).status, TransformSample::Status::Invalid);
  EXPECT_EQ(poseOfFrame(recording, 6, "MarkerToTracker", 0.02).status, TransformSample::Status::Invalid);
  EXPECT_EQ(poseOfFrame(recording, 4, "StylusToTracker", 0.02).status, TransformSample::Status::Missing);
}

TEST(TimedPose, LatencyThatWasApplied_IsNotAppliedAgain)
{
  const TemporaryFolder folder;
  const io::Recording recording = recordingIn(folder, "-0.04");
  EXPECT_EQ(recording.appliedLatencySec(), -0.04);
  EXPECT_NEAR(poseOfFrame(recording, 4, "MarkerToTracker", -0.04).transform.translation().x(), 16, 1e-9);
  EXPECT_NEAR(poseOfFrame(recording, 4, "MarkerToTracker", 0).transform.translation().x(), 16, 1e-9) << "as recorded";
  EXPECT_NEAR(poseOfFrame(recording, 4, "MarkerToTracker", -0.06).transform.translation().x(), 14, 1e-9) << "what is missing";
  ASSERT_EQ(latencyNotes(recording, -0.04).size(), 1U);
  EXPECT_NE(latencyNotes(recording, -0.04)[0].find("-40 ms, which is not applied again"), std::string::npos);
  EXPECT_NE(latencyNotes(recording, -0.06)[0].find("-20 ms are added"), std::string::npos);
  EXPECT_TRUE(latencyNotes(recordingIn(folder), -0.06).empty());
  io::test::expectFileError([&] { (void)recordingIn(folder, "forty"); }, { "AppliedLatencySec", "forty" });
}

TEST(TimedPose, Overlay_AppliesTheLatency)
{
  const TemporaryFolder folder;
  const io::Recording recording = recordingIn(folder);
  const OverlayPose now = overlayPose(recording, 4, "MarkerToTracker", "PhantomToTracker", {});
  const OverlayPose earlier = overlayPose(recording, 4, "MarkerToTracker", "PhantomToTracker", {}, -0.04);
  const OverlayPose before = overlayPose(recording, 3, "MarkerToTracker", "PhantomToTracker", {});
  ASSERT_TRUE(now.isUsable() && earlier.isUsable() && before.isUsable());
  EXPECT_LT((earlier.modelToCamera->matrix() - before.modelToCamera->matrix()).norm(), 1e-9);
  EXPECT_GT((now.modelToCamera->matrix() - before.modelToCamera->matrix()).norm(), 1);
}

}  // namespace
