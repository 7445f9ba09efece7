// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The latency on the command line: from a recording into calibration.json, and into validate and overlay.
#include "CommandRunner.h"

#include <gtest/gtest.h>

#include <fstream>

namespace
{

using handeye::testing::CommandResult;
using handeye::testing::readText;
using nlohmann::json;
using Path = std::filesystem::path;

class LatencyCommands : public ::testing::Test
{
protected:
  void SetUp() override
  {
    folder_ = Path(HANDEYE_TEST_OUTPUT_DIR) / "LatencyCommands";
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    const Path demo = Path(HANDEYE_RESOURCES_DIR) / "Demo";
    std::filesystem::copy(demo / "validation", folder_ / "shifted", std::filesystem::copy_options::recursive);
    // The same poses, said to have been taken at a latency of -40 ms: as a session or a recording made with --latency has them.
    std::string tracking = readText(folder_ / "shifted/tracking.igs.mha");
    tracking.insert(tracking.find("Seq_Frame"), "AppliedLatencySec = -0.04\n");
    std::ofstream(folder_ / "shifted/tracking.igs.mha", std::ios::binary) << tracking;
    const json truth = json::parse(readText(demo / "truth.json"));
    std::ofstream(folder_ / "stylus.json") << json({ { "status", "ok" }, { "tip_Stylus_Mm", truth["tip_Stylus_Mm"] } });
    camera_ = (demo / "camera.yml").string();
  }

  CommandResult run(const std::vector<std::string>& arguments) const
  {
    return handeye::testing::runCommand(HANDEYE_PROGRAM, arguments, folder_);
  }

  std::string file(const char* name) const { return (folder_ / name).string(); }

  Path folder_;
  std::string camera_;
};

}  // namespace

TEST_F(LatencyCommands, LatencyOfARecording_ReachesTheCalibrationAndIsNotAppliedAgain)
{
  const CommandResult calibrate = run({ "calibrate", file("shifted"), "--camera", camera_, "--stylus", file("stylus.json"),
    "--ball-radius", "15", "--json", "-o", file("calibration.json") });
  ASSERT_EQ(calibrate.exitCode, 0) << calibrate.err;
  EXPECT_EQ(calibrate.json()["latencySec"], -0.04);
  EXPECT_NE(calibrate.err.find("-40 ms, which is not applied again"), std::string::npos) << calibrate.err;
  const CommandResult validate = run({ "validate", file("shifted"), "--calibration", file("calibration.json"), "--json" });
  EXPECT_EQ(validate.exitCode, 0) << validate.err;
  EXPECT_NE(validate.err.find("not applied again"), std::string::npos) << validate.err;
  // Another one, for this recording: the poses between its frames, which are too far apart for that. One sentence, not one a frame.
  const CommandResult other =
    run({ "validate", file("shifted"), "--calibration", file("calibration.json"), "--latency", "-60", "--json" });
  EXPECT_EQ(other.exitCode, 2) << other.err;
  EXPECT_NE(other.err.find("--latency -60.0 is taken instead of the calibration's -40.0 ms"), std::string::npos) << other.err;
  EXPECT_NE(other.err.find("s apart"), std::string::npos) << other.err;
  EXPECT_NE(run({ "overlay", "--help" }).out.find("--latency"), std::string::npos);
}

/// Who names two sources wants both.
TEST_F(LatencyCommands, SourceThatIsMissing_IsNamedAndWhatCameIsKept)
{
  const Path demo = Path(HANDEYE_RESOURCES_DIR) / "Demo";
  const CommandResult both = run({ "record", "--replay", (demo / "pivot.igs.mha").string(), "--video", "97", "--speed", "0",
    "--wait", "2", "--poses", file("poses.igs.mha"), "--json" });
  EXPECT_EQ(both.exitCode, 1) << both.err;
  EXPECT_EQ(both.json()["status"], "source_missing");
  EXPECT_NE(both.err.find("camera 97 was not there"), std::string::npos) << both.err;
  EXPECT_NE(both.err.find("plugged in"), std::string::npos) << both.err;
  EXPECT_NE(both.err.find("poses.igs.mha"), std::string::npos) << "what came is kept: " << both.err;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "poses.igs.mha"));
}

TEST_F(LatencyCommands, FilesThatCannotBeRead_AreSaidAtOnce)
{
  std::ofstream(folder_ / "text.avi") << "not a video";
  const CommandResult video = run({ "record", "--video", file("text.avi"), "-o", file("out.igs.mha") });
  EXPECT_EQ(video.exitCode, 2) << video.err;
  EXPECT_NE(video.err.find("text.avi"), std::string::npos) << video.err;
  const CommandResult replay = run({ "streams", "--replay", file("nowhere.igs.mha") });
  EXPECT_EQ(replay.exitCode, 2) << replay.err;
  EXPECT_NE(replay.err.find("nowhere.igs.mha"), std::string::npos) << replay.err;
}

TEST_F(LatencyCommands, Record_SaysWhatItWroteAndWhere)
{
  const Path demo = Path(HANDEYE_RESOURCES_DIR) / "Demo";
  const CommandResult recorded =
    run({ "record", "--replay", (demo / "validation").string(), "--speed", "0", "-o", file("again.igs.mha") });
  EXPECT_EQ(recorded.exitCode, 0) << recorded.err;
  EXPECT_NE(recorded.out.find("each with the poses of its moment, written to " + file("again.igs.mha")), std::string::npos)
    << recorded.out;
}
