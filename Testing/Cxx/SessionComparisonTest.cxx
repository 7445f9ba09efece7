// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SessionComparison.h"

#include "CaptureSimulation.h"
#include "DistinctCaptures.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace handeye;
using namespace handeye::test;
using handeye::io::test::TemporaryFolder;

namespace
{

/// A capture and a validation by one camera without noise, as a session has them.
class SessionComparisonOfBalls : public testing::Test
{
protected:
  SessionComparisonOfBalls()
    : input{ capture.camera, "made up", capture.tip_Stylus, Eigen::Matrix3d::Zero(), capture.ballRadiusMm, {}, {}, {}, {}, {}, {},
      {}, {}, {}, 0, {} }
  {
    input.captureFolder = write(capture, "capture", 5);
    input.validationFolder = write(validation, "validation", 6);
    input.capture = read(input.captureFolder);
    input.validation = read(input.validationFolder);
    input.comparison.subsetRepetitions = 0;
  }

  std::filesystem::path write(const SimulatedSession& session, const char* name, unsigned seed, double spacingSec = 0.05) const
  {
    std::vector<io::SequenceFrame> tracking = session.trackAll(seed);
    for (std::size_t i = 0; i < tracking.size(); ++i)
    {
      tracking[i].timestampSec = spacingSec * double(i);
    }
    return session.write(folder.path() / name, tracking);
  }

  std::vector<CapturedFrame> read(const std::filesystem::path& path) const
  {
    return readCapture(io::Recording::open(path), {}, capture.camera, capture.tip_Stylus, capture.ballRadiusMm);
  }

  void expectRefused(const std::filesystem::path& other, const std::vector<std::string>& words)
  {
    input.otherCaptures = { other };
    io::test::expectFileError([&] { (void)compareSession(input); }, words);
  }

  const TemporaryFolder folder;
  const SimulatedSession capture{ 8, 1 }, validation{ 5, 2 }, further{ 7, 3 };
  SessionComparisonInput input;
};

}  // namespace

TEST_F(SessionComparisonOfBalls, CapturesThatShareNothing_AreCompared)
{
  input.otherCaptures = { write(further, "further", 7) };
  const SessionComparison comparison = compareSession(input);
  ASSERT_TRUE(comparison.result.isUsable()) << comparison.result.message;
  EXPECT_EQ(comparison.result.methods.front().captures.size(), 2U);
  EXPECT_LT(comparison.result.methods.front().errorPx.maximum, 0.2);
  ASSERT_EQ(comparison.facts.size(), 3U);
  EXPECT_NE(comparison.facts[1].find("8 samples, "), std::string::npos) << comparison.facts[1];
  EXPECT_NE(comparison.facts[2].find(" by the paper's segmentation."), std::string::npos) << comparison.facts[2];
}

TEST_F(SessionComparisonOfBalls, WhatIsThereAlready_IsRefusedByItsPath)
{
  expectRefused(folder.path() / "validation", { "validation", "this is the validation set already" });
  expectRefused(folder.path() / "further" / ".." / "capture" / "", { "this is the session's own capture already" });
  const std::filesystem::path other = write(further, "further", 7);
  input.otherCaptures = { other, other };
  io::test::expectFileError([&] { (void)compareSession(input); }, { "this is a further capture already" });
  input.otherCaptures.clear();
  input.captureFolder = input.validationFolder;
  io::test::expectFileError([&] { (void)compareSession(input); }, { "this is the validation set already" });
}

TEST_F(SessionComparisonOfBalls, CopiesOfSamples_AreRefused)
{
  // The same placements, recorded in other poses of the camera, elsewhere on the disk.
  expectRefused(write(validation, "copy", 6), { "5 of its 5 samples are those of the validation set" });
  expectRefused(write(capture, "again", 9), { "8 of its 8 samples are those of the session's own capture" });
  input.otherCaptures.clear();
  input.capture.push_back(input.validation.front());
  io::test::expectFileError(
    [&] { (void)compareSession(input); }, { "capture", "1 of its 9 samples are those of the validation set" });
}

TEST_F(SessionComparisonOfBalls, LatencyOfSinglePlacements_IsRefusedAndNotIgnored)
{
  input.tools.latencySec = -0.04;
  expectRefused(write(further, "stills", 7, 3), { "stills", "3.0 s apart", "latency" });
}

TEST_F(SessionComparisonOfBalls, Stopped_SaysSo)
{
  int told = 0;
  const SessionComparison comparison = compareSession(input, [&](const std::string&, int, int) { return ++told < 3; });
  EXPECT_TRUE(comparison.result.wasStopped);
  EXPECT_EQ(comparison.result.status, "stopped");
  EXPECT_EQ(told, 3) << "nothing more is asked";
  const SessionComparison late =
    compareSession(input, [](const std::string& what, int, int) { return what.rfind("comparing", 0) != 0; });
  EXPECT_EQ(late.result.status, "stopped");
}
