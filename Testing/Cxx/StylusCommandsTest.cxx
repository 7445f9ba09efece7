// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The stylus and the phantom on the command line: pivot by each method, spin, landmarks from a recording.
#include "CaptureSimulation.h"
#include "CommandRunner.h"
#include "NamedTransform.h"
#include "PivotSimulation.h"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <fstream>

namespace
{

using handeye::testing::CommandResult;
using nlohmann::json;
using Path = std::filesystem::path;

/// The landmarks of the published description of the phantom that the PLUS recording touches.
constexpr const char* FcalLandmarks =
  "104.3 5 20\n104.3 45 20\n104.3 45 0\n104.3 -5 0\n-34.3 45 15\n-34.3 -5 20\n-34.3 -5 0\n-34.3 45 0\n";

class StylusCommands : public ::testing::Test
{
protected:
  void SetUp() override
  {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = Path(HANDEYE_TEST_OUTPUT_DIR) / "StylusCommands" / info->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    write("stylus.json", R"({ "status": "ok", "tip_Stylus_Mm": [109.6, 6.8, 2.8] })");
    write("model.txt", FcalLandmarks);
  }

  CommandResult run(const std::vector<std::string>& arguments) const
  {
    return handeye::testing::runCommand(HANDEYE_PROGRAM, arguments, folder_);
  }

  std::string file(const char* name) const { return (folder_ / name).string(); }
  std::string demo(const char* name) const { return (Path(HANDEYE_RESOURCES_DIR) / "Demo" / name).string(); }
  static std::string plus() { return (Path(HANDEYE_TEST_DATA_DIR) / "plus_landmarks.igs.mha").string(); }
  void write(const char* name, const std::string& text) const { std::ofstream(folder_ / name) << text; }

  Path folder_;
};

}  // namespace

TEST_F(StylusCommands, PivotByEachMethod_GivesTheTip)
{
  const json truth = json::parse(handeye::testing::readText(demo("truth.json")));
  for (const std::string& method :
    { std::string("robust"), std::string("algebraic-one-step"), std::string("algebraic-two-step"), std::string("sphere-fit") })
  {
    const CommandResult result = run({ "pivot", demo("pivot.igs.mha"), "--method", method, "--json", "-o", file("tip.json") });
    ASSERT_EQ(result.exitCode, 0) << method << result.err;
    const json object = result.json();
    EXPECT_EQ(object["method"], method);
    double squares = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      squares += std::pow(object["tip_Stylus_Mm"][axis].get<double>() - truth["tip_Stylus_Mm"][axis].get<double>(), 2);
    }
    // The demo has 2.5 % of wrong poses, of which the classical methods know nothing.
    EXPECT_LT(std::sqrt(squares), method == "robust" ? 0.1 : 0.8) << method;
    EXPECT_EQ(object["samples"].size(), 320U);
  }
  const CommandResult unknown = run({ "pivot", demo("pivot.igs.mha"), "--method", "magic" });
  EXPECT_EQ(unknown.exitCode, 2);
  EXPECT_NE(unknown.err.find("sphere-fit"), std::string::npos) << "those that there are";
}

TEST_F(StylusCommands, Spin_AddsTheTipsFrameToTheStylus)
{
  using namespace handeye::test;
  Random random(1);
  std::vector<handeye::io::SequenceFrame> frames;
  for (const Eigen::Isometry3d& pose : PivotSimulation().record(
         200,
         [&] {
           return handeye::rotationFromVector({ 0, 0, random.uniform(-1.5, 1.5) });
         },
         random))
  {
    frames.emplace_back();
    frames.back().transforms["StylusToTracker"] = { pose.matrix(), "OK" };
  }
  SimulatedSession::writeTracking(file("spin.igs.mha"), frames);
  write("stylus.json", R"({ "status": "ok", "tip_Stylus_Mm": [2.4, -3.1, -158], "rmsMm": 0.2 })");
  const CommandResult spin =
    run({ "spin", file("spin.igs.mha"), "--stylus", file("stylus.json"), "--json", "-o", file("full.json") });
  ASSERT_EQ(spin.exitCode, 0) << spin.err;
  const json written = json::parse(handeye::testing::readText(file("full.json")));
  EXPECT_EQ(written, spin.json());
  EXPECT_EQ(written["rmsMm"], 0.2);
  EXPECT_NEAR(written["stylusTipToStylus"][2][2].get<double>(), -1, 1e-3);
  // To pivot it needs turning about two axes, and the reason says about which one it was turned.
  const CommandResult pivot = run({ "pivot", file("spin.igs.mha"), "--json", "-o", file("tip.json") });
  EXPECT_EQ(pivot.exitCode, 1);
  EXPECT_EQ(pivot.json()["status"], "rotation_about_one_axis");
  EXPECT_NE(pivot.err.find("its z axis"), std::string::npos) << pivot.err;
  EXPECT_FALSE(std::filesystem::exists(file("tip.json")));
}

/// What spin adds to the stylus is exported, and what a stereo calibration has of the right eye.
TEST_F(StylusCommands, Export_HasTheShaftAndBothEyes)
{
  const json ones = { { 1, 0, 0, 0 }, { 0, 1, 0, 0 }, { 0, 0, 1, 0 }, { 0, 0, 0, 1 } };
  json right = ones, tip = { { 1, 0, 0, 2.4 }, { 0, -1, 0, -3.1 }, { 0, 0, -1, -158 }, { 0, 0, 0, 1 } };
  right[0][3] = -65;
  write("spun.json", json({ { "status", "ok" }, { "tip_Stylus_Mm", { 2.4, -3.1, -158 } }, { "stylusTipToStylus", tip } }).dump());
  json calibration = { { "status", "ok" }, { "markerToCamera", ones }, { "markerToRightCamera", right } };
  calibration["camera"] = { { "width", 640 }, { "height", 480 }, { "distortionCoefficients", { 0, 0, 0, 0, 0 } },
    { "cameraMatrix", { { 500, 0, 320 }, { 0, 500, 240 }, { 0, 0, 1 } } } };
  write("calibration.json", calibration.dump());
  for (const std::string format : { "plus", "mrml" })
  {
    const CommandResult both =
      run({ "export", file("calibration.json"), "--format", format, "--stylus", file("spun.json"), "-o", file("out") });
    ASSERT_EQ(both.exitCode, 0) << both.err;
    EXPECT_EQ(both.err.find("shaft"), std::string::npos) << both.err;
    EXPECT_NEAR(handeye::io::readTransform(file("out"), "StylusTipToStylus")(2, 2), -1, 1e-9) << format;
    EXPECT_NEAR(handeye::io::readTransform(file("out"), "StylusTipToStylus")(2, 3), -158, 1e-9) << format;
    EXPECT_NEAR(handeye::io::readTransform(file("out"), "MarkerToRightCamera")(0, 3), -65, 1e-9) << format;
    const CommandResult tipOnly =
      run({ "export", file("calibration.json"), "--format", format, "--stylus", file("stylus.json"), "-o", file("out") });
    EXPECT_NE(tipOnly.err.find("shaft"), std::string::npos) << tipOnly.err;
  }
  for (const std::string format : { "tfm", "opencv" })
  {
    const CommandResult left = run({ "export", file("calibration.json"), "--format", format, "-o", file("left.yml") });
    EXPECT_EQ(left.exitCode, 0) << left.err;
    EXPECT_NE(left.err.find("the right one is left out"), std::string::npos) << left.err;
  }
}

TEST_F(StylusCommands, LandmarksFromRecording_AreEightInOrderWithNothingButFileNames)
{
  for (const char* name : { "touched.txt", "touched.json" })
  {
    const CommandResult touched =
      run({ "landmarks", "--from-recording", plus(), "--stylus", file("stylus.json"), "--json", "-o", file(name) });
    ASSERT_EQ(touched.exitCode, 0) << touched.err;
    const json object = touched.json();
    ASSERT_EQ(object["landmarks"].size(), 8U);
    EXPECT_EQ(object["points_Phantom_Mm"].size(), 8U);
    EXPECT_EQ(object["setAside"].size(), 2U);
    for (std::size_t i = 1; i < 8; ++i)
    {
      EXPECT_GT(object["landmarks"][i]["firstFrame"], object["landmarks"][i - 1]["lastFrame"]);
    }
    const CommandResult registered = run({ "landmarks", file("model.txt"), file(name), "--json", "-o", file("phantom.json") });
    ASSERT_EQ(registered.exitCode, 0) << registered.err;
    EXPECT_LT(registered.json()["rmsMm"], 1.6);
    EXPECT_EQ(registered.json()["residualsMm"].size(), 8U);
    EXPECT_EQ(run({ "landmarks", file(name), file("model.txt") }).exitCode, 2) << "exchanged";
  }
}

TEST_F(StylusCommands, LandmarksFromRecordingWithAModel_RegisterInOneGo)
{
  const CommandResult result = run({ "landmarks", file("model.txt"), "--from-recording", plus(), "--stylus", file("stylus.json"),
    "--json", "-o", file("phantom.json") });
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const json object = json::parse(handeye::testing::readText(file("phantom.json")));
  EXPECT_LT(object["rmsMm"], 1.6);
  EXPECT_EQ(object["touched"]["landmarks"].size(), 8U);
  EXPECT_EQ(object["landmarkTreMm"].size(), 8U);
  write("seven.txt", std::string(FcalLandmarks).substr(0, std::string(FcalLandmarks).rfind("-34.3")));
  const CommandResult seven =
    run({ "landmarks", file("seven.txt"), "--from-recording", plus(), "--stylus", file("stylus.json"), "--json" });
  EXPECT_EQ(seven.exitCode, 1);
  EXPECT_EQ(seven.json()["status"], "landmark_count");
  EXPECT_NE(seven.err.find("7 landmarks, 8 were touched"), std::string::npos) << seven.err;
}

TEST_F(StylusCommands, WrongOrder_IsOfferedAndTakenIfAskedFor)
{
  write("other.txt", "-34.3 45 15\n104.3 5 20\n104.3 45 20\n104.3 45 0\n104.3 -5 0\n-34.3 -5 20\n-34.3 -5 0\n-34.3 45 0\n");
  const CommandResult wrong = run({ "landmarks", file("model.txt"), file("other.txt"), "--json", "-o", file("phantom.json") });
  EXPECT_EQ(wrong.exitCode, 1);
  EXPECT_EQ(wrong.json()["status"], "wrong_order");
  EXPECT_EQ(wrong.json()["suggestedOrder"], json({ 2, 3, 4, 5, 1, 6, 7, 8 }));
  EXPECT_FALSE(std::filesystem::exists(file("phantom.json")));
  const CommandResult fixed =
    run({ "landmarks", file("model.txt"), file("other.txt"), "--fix-order", "--json", "-o", file("phantom.json") });
  EXPECT_EQ(fixed.exitCode, 0) << fixed.err;
  EXPECT_EQ(fixed.json()["touchedOrder"], json({ 2, 3, 4, 5, 1, 6, 7, 8 }));
  EXPECT_LT(fixed.json()["rmsMm"], 1e-6);
}

TEST_F(StylusCommands, ExchangedListsWithTheMesh_AreNoticed)
{
  const std::string mesh = (Path(HANDEYE_RESOURCES_DIR) / "Meshes" / "Vertebra.ply").string();
  std::filesystem::copy_file(demo("phantom_model_points.txt"), file("a.txt"));
  std::filesystem::copy_file(demo("phantom_touched_points.txt"), file("b.txt"));
  EXPECT_EQ(run({ "landmarks", file("a.txt"), file("b.txt"), "--mesh", mesh }).exitCode, 0);
  const CommandResult exchanged = run({ "landmarks", file("b.txt"), file("a.txt"), "--mesh", mesh });
  EXPECT_EQ(exchanged.exitCode, 2);
  EXPECT_NE(exchanged.err.find("exchanged"), std::string::npos) << exchanged.err;
  EXPECT_EQ(run({ "landmarks", demo("phantom_touched_points.txt"), demo("phantom_model_points.txt") }).exitCode, 2)
    << "by their names";
}

TEST_F(StylusCommands, WrongUse_IsTwo)
{
  const std::vector<std::vector<std::string>> wrong = { { "landmarks" }, { "landmarks", file("model.txt") },
    { "landmarks", file("model.txt"), file("model.txt"), "--from-recording", plus() }, { "spin", plus() },
    { "spin", plus(), "--stylus", file("none.json") },
    { "landmarks", "--from-recording", plus(), "--phantom-transform", "BoneToTracker" },
    { "landmarks", "--from-recording", plus(), "--motion-mm", "-1" },
    { "landmarks", file("model.txt"), file("model.txt"), "--weights", "1,2" }, { "pivot", plus(), "--noise-mm", "0" } };
  for (const std::vector<std::string>& arguments : wrong)
  {
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exitCode, 2) << arguments.back();
    EXPECT_FALSE(result.err.empty());
  }
  for (const char* command : { "pivot", "spin", "landmarks" })
  {
    EXPECT_EQ(run({ command, "--help" }).exitCode, 0);
  }
}
