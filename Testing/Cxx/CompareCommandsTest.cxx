// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardPicture.h"
#include "CaptureSimulation.h"

#include "CommandRunner.h"

#include <gtest/gtest.h>

#include <fstream>

using namespace handeye::test;
using handeye::testing::CommandResult;
using json = nlohmann::json;
using Path = std::filesystem::path;

namespace
{

const char* const Board = "chessboard:9x6:10";

/// Recordings of ball and board by one camera, without noise, as files.
class CompareCommands : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    folder_ = Path(HANDEYE_TEST_OUTPUT_DIR) / "CompareCommands";
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    const SimulatedSession first(9, 1), second(9, 2), validation(5, 3);
    first.write(folder_ / "first", first.trackAll(5));
    second.write(folder_ / "second", second.trackAll(6));
    validation.write(folder_ / "validation", validation.trackAll(7));
    writeBoard(first);
    writeCamera(first.camera);
    std::ofstream(folder_ / "stylus.json") << json{ { "schema", "handeye-stylus/1" }, { "status", "ok" }, { "message", "" },
      { "tip_Stylus_Mm", { 1.5, -2.5, -150.0 } }, { "tipCovariance_Mm2", { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 } } } };
  }

  static void writeBoard(const SimulatedSession& session)
  {
    const handeye::BoardDescription board = handeye::parseBoard(Board);
    const handeye::simulation::BoardPicture pictures(board, session.camera);
    Random random(4);
    const Eigen::Isometry3d boardToTracker = random.rigid(300);
    std::vector<handeye::io::SequenceFrame> tracking;
    std::filesystem::create_directories(folder_ / "board" / "frames");
    for (int i = 0; i < 9; ++i)
    {
      Eigen::Isometry3d boardToCamera = makeRigid(
        { random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.7, 0.7) }, { 0, 0, random.uniform(170, 230) });
      boardToCamera.translation() -= boardToCamera.linear() * handeye::boardCenter(board);
      SimulatedSession::writePicture(folder_ / "board", i, pictures.take(boardToCamera));
      const Eigen::Isometry3d boardToMarker = session.markerToCamera.inverse() * boardToCamera;
      const Eigen::Isometry3d markerToBoard = boardToMarker.inverse();
      const Eigen::Isometry3d markerToTracker = boardToTracker * markerToBoard;
      handeye::io::SequenceFrame frame;
      frame.timestampSec = 0.1 * i;
      frame.transforms["MarkerToTracker"] = { markerToTracker.matrix(), "OK" };
      frame.transforms["BoardToTracker"] = { boardToTracker.matrix(), "OK" };
      tracking.push_back(frame);
    }
    SimulatedSession::writeTracking(folder_ / "board" / "tracking.igs.mha", tracking);
  }

  static void writeCamera(const handeye::CameraModel& camera)
  {
    std::ofstream file(folder_ / "camera.yml");
    file
      << "%YAML:1.0\n---\nimage_width: 320\nimage_height: 240\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
      << "   data: [ " << camera.fx() << ", 0, " << camera.cx() << ", 0, " << camera.fy() << ", " << camera.cy()
      << ", 0, 0, 1 ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 4\n   cols: 1\n   dt: d\n   data: [ ";
    for (std::size_t i = 0; i < 4; ++i)
    {
      file << (i > 0 ? ", " : "") << camera.distortionCoefficients()[i];
    }
    file << " ]\n";
  }

  static std::string file(const char* name) { return (folder_ / name).string(); }

  static CommandResult run(std::vector<std::string> arguments)
  {
    return handeye::testing::runCommand(HANDEYE_PROGRAM, arguments, folder_);
  }

  static std::vector<std::string> compare(const std::vector<std::string>& more)
  {
    std::vector<std::string> arguments = { "compare", "--validation", file("validation"), "--stylus", file("stylus.json"),
      "--ball-radius", "12", "--camera", file("camera.yml") };
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  static json methodOf(const json& result, const std::string& name)
  {
    for (const json& method : result.at("methods"))
    {
      if (method.at("name") == name)
      {
        return method;
      }
    }
    return nullptr;
  }

  static Path folder_;
};

Path CompareCommands::folder_;

}  // namespace

TEST_F(CompareCommands, BallAndBoard_EveryMethodIsARowAndFindsTheTruth)
{
  const CommandResult result = run(
    compare({ "--ball", file("first"), "--board-recording", file("board"), "--board", Board, "--board-transform", "BoardToTracker",
      "--subsets", "2", "--time-limit", "2", "--report", file("report"), "--json", "-o", file("comparison.json") }));
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const json comparison = result.json();
  EXPECT_EQ(comparison, json::parse(handeye::testing::readText(file("comparison.json"))));
  for (const char* const name : { "ml", "global", "procrustes", "oi", "ppnp", "epnp", "sqpnp", "iterative", "tsai", "park",
         "horaud", "daniilidis", "tracked-board", "tracked-board-lines" })
  {
    const json method = methodOf(comparison, name);
    ASSERT_FALSE(method.is_null()) << name;
    ASSERT_EQ(method.at("status"), "ok") << name << ": " << method.at("message");
    EXPECT_EQ(method.at("projectionErrorPx").at("count"), 5) << name;
    EXPECT_LT(method.at("projectionErrorPx").at("max").get<double>(), 1.5) << name << ": pictures without noise";
  }
  EXPECT_FALSE(methodOf(comparison, "branch-and-bound").is_null());
  EXPECT_FALSE(methodOf(comparison, "as-published").is_null());
  for (const char* const name : { "report.html", "report.pdf", "methods.csv", "errors.csv", "subsets.csv", "repeatability.csv" })
  {
    EXPECT_GT(std::filesystem::file_size(folder_ / "report" / name), 100U) << name;
  }
  const std::string html = handeye::testing::readText(folder_ / "report" / "report.html");
  EXPECT_NE(html.find("chessboard:9x6:10, found and tracked in 9 of 9 frames"), std::string::npos);
}

TEST_F(CompareCommands, SeveralCaptures_GiveTheRepeatability)
{
  const CommandResult result =
    run(compare({ "--ball", file("first"), "--ball", file("second"), "--subsets", "0", "--without-published", "--json" }));
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const json ml = methodOf(result.json(), "ml");
  EXPECT_EQ(ml.at("captures").size(), 2U);
  EXPECT_EQ(ml.at("projectionErrorPx").at("count"), 10);
  EXPECT_EQ(ml.at("repeatability").at("calibrations"), 2);
  EXPECT_FALSE(ml.at("repeatability").at("ofHalves").get<bool>());
  EXPECT_LT(ml.at("repeatability").at("projectionPx").get<double>(), 0.5);
  EXPECT_TRUE(methodOf(result.json(), "as-published").is_null());
  EXPECT_TRUE(ml.at("subsets").empty());
}

TEST_F(CompareCommands, Text_SaysRanks)
{
  const CommandResult result = run(compare({ "--ball", file("first"), "--subsets", "0", "--without-published" }));
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NE(result.out.find("method              rank    mean"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("    1    0."), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("~: not told apart from the first"), std::string::npos) << result.out;
}

TEST_F(CompareCommands, WhatIsValidatedOnOrThereTwice_IsRefused)
{
  for (const std::vector<std::string>& twice :
    { std::vector<std::string>{ "--ball", file("validation") }, { "--ball", file("first"), "--ball", file("first") + "/" } })
  {
    const CommandResult refused = run(compare(twice));
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_NE(refused.err.find("no method may be fitted to what it is judged by"), std::string::npos) << refused.err;
  }
}

TEST_F(CompareCommands, NothingToCalibrateFrom_IsWrongUse)
{
  const CommandResult result = run(compare({}));
  EXPECT_EQ(result.exitCode, 2);
  EXPECT_NE(result.err.find("--ball RECORDING"), std::string::npos) << result.err;
}

TEST_F(CompareCommands, BoardOrItsDescriptionAlone_IsWrongUse)
{
  EXPECT_EQ(run(compare({ "--board-recording", file("board") })).exitCode, 2);
  EXPECT_EQ(run(compare({ "--board", Board })).exitCode, 2);
  const CommandResult result = run(compare({ "--board-recording", file("board"), "--board", "chessboard:9x6" }));
  EXPECT_EQ(result.exitCode, 2);
  EXPECT_NE(result.err.find("chessboard:9x6"), std::string::npos) << result.err;
}

TEST_F(CompareCommands, WrongBoard_IsNoResultAndSaysWhy)
{
  const CommandResult result =
    run(compare({ "--board-recording", file("board"), "--board", "chessboard:7x4:10", "--subsets", "0", "--json" }));
  EXPECT_EQ(result.exitCode, 1) << result.err;
  EXPECT_EQ(result.json().at("status"), "no_method");
  EXPECT_EQ(methodOf(result.json(), "park").at("status"), "too_few_views");
}

TEST_F(CompareCommands, Validation_HasReportAndPdf)
{
  ASSERT_EQ(run({ "calibrate", file("first"), "--camera", file("camera.yml"), "--stylus", file("stylus.json"), "--ball-radius",
                  "12", "-o", file("calibration.json") })
              .exitCode,
    0);
  const CommandResult result =
    run({ "validate", file("validation"), "--calibration", file("calibration.json"), "--report", file("validated") });
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.err.find("XDG_RUNTIME_DIR"), std::string::npos) << "what Qt says about its surroundings is not shown";
  EXPECT_EQ(handeye::testing::readText(folder_ / "validated" / "report.pdf").rfind("%PDF-", 0), 0U);
  EXPECT_NE(handeye::testing::readText(folder_ / "validated" / "report.html").find("data:image/png"), std::string::npos);
}

TEST_F(CompareCommands, Study_GivesItsJsonAndItsReport)
{
  const CommandResult result = run({ "study", "--repetitions", "1", "--camera", "webcam", "--time-limit", "0", "--no-noise",
    "--subsets", "0", "--report", file("study"), "--json" });
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const json study = result.json();
  EXPECT_EQ(study.at("schema"), "handeye-study/1");
  ASSERT_EQ(study.at("cameras").size(), 1U);
  for (const json& method : study.at("cameras")[0].at("methods"))
  {
    EXPECT_LT(method.at("projectionErrorPx").at("max").get<double>(), 0.05) << method.at("name");
  }
  EXPECT_TRUE(std::filesystem::exists(folder_ / "study" / "report.pdf"));
  EXPECT_EQ(run({ "study", "--camera", "endoscope" }).exitCode, 2);
  EXPECT_EQ(run({ "study", "--repetitions", "0" }).exitCode, 2);
}
