// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Boards on the command line: printing one, a lens from its pictures, the classical hand-eye calibration.
#include "GeometryMatchers.h"  // before handeye::testing hides gtest's testing

#include "BoardPicture.h"
#include "BoardSimulation.h"
#include "CameraFile.h"
#include "CaptureSimulation.h"
#include "CommandRunner.h"
#include "ResultFiles.h"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include <cstdio>
#include <fstream>

namespace
{

using namespace handeye;
using namespace handeye::test;
using handeye::testing::CommandResult;
using handeye::testing::readText;
using nlohmann::json;
using Path = std::filesystem::path;

constexpr const char* Board = "charuco:7x5:12:9:DICT_4X4_50";

CameraModel boardCamera()
{
  return makeCamera(480, 360, 450, 451, 238.2, 181.7, { -0.12, 0.05, 0.0006, -0.0008 });
}

/// A recording of a board, made once: pictures and tracking without noise but the pixels'.
class BoardCommands : public ::testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    folder_ = Path(HANDEYE_TEST_OUTPUT_DIR) / "BoardCommands";
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_ / "board" / "frames");
    scene_ = new BoardScene{ parseBoard(Board), boardCamera() };
    const simulation::BoardPicture picture(scene_->board, scene_->camera);
    BoardViews how;
    how.nearestMm = 110;
    how.furthestMm = 170;
    how.borderShare = 0.2;
    Random random(1);
    std::vector<io::SequenceFrame> frames;
    for (int i = 0; i < 14; ++i)
    {
      const Eigen::Isometry3d boardToCamera = how.pose(scene_->board, scene_->camera, random);
      char name[32];
      std::snprintf(name, sizeof(name), "%04d.png", i);
      simulation::Photograph photograph;
      photograph.noise = 1;
      photograph.seed = unsigned(i);
      cv::imwrite((folder_ / "board" / "frames" / name).string(), picture.take(boardToCamera, photograph));
      frames.emplace_back();
      frames.back().timestampSec = 0.1 * i;
      frames.back().transforms["MarkerToTracker"] = { scene_->view(i, boardToCamera, {}, random).markerToTracker.matrix(),
        i == 3 ? "INVALID" : "OK" };
      frames.back().transforms["BoardMarkerToTracker"] = { scene_->boardToTracker.matrix(), "OK" };
    }
    SimulatedSession::writeTracking(folder_ / "board" / "tracking.igs.mha", frames);
    write("camera.yml", R"(%YAML:1.0
---
image_width: 480
image_height: 360
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 450., 0., 238.2, 0., 451., 181.7, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 4
   cols: 1
   dt: d
   data: [ -0.12, 0.05, 0.0006, -0.0008 ]
)");
    write("stylus.json", R"({ "status": "ok", "tip_Stylus_Mm": [1.5, -2.5, -150] })");
  }

  static void TearDownTestSuite() { delete scene_; }

  static CommandResult run(const std::vector<std::string>& arguments)
  {
    return handeye::testing::runCommand(HANDEYE_PROGRAM, arguments, folder_);
  }

  static std::string file(const std::string& name) { return (folder_ / name).string(); }
  static void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }

  static inline Path folder_;
  static inline BoardScene* scene_ = nullptr;
};

Eigen::Isometry3d transformOf(const json& rows)
{
  Eigen::Isometry3d transform;
  for (int i = 0; i < 16; ++i)
  {
    transform.matrix()(i / 4, i % 4) = rows[std::size_t(i / 4)][std::size_t(i % 4)].get<double>();
  }
  return transform;
}

}  // namespace

TEST_F(BoardCommands, PrintedBoard_HasItsTrueSize)
{
  const CommandResult picture = run({ "camera", "board", "chessboard:7x5:20", "--dpi", "254", "--json", "-o", file("chess.png") });
  ASSERT_EQ(picture.exitCode, 0) << picture.err;
  EXPECT_EQ(picture.json()["paper"], "A4 landscape");
  const cv::Mat image = cv::imread(file("chess.png"), cv::IMREAD_GRAYSCALE);
  ASSERT_EQ(image.size(), cv::Size(2970, 2100)) << "ten pixels a millimetre";
  // The rows of the first squares: black ones are 200 px wide.
  std::vector<int> lengths;
  int row = 0;
  while (row < image.rows && cv::countNonZero(image.row(row)) == image.cols)
  {
    ++row;
  }
  for (int x = 0, run = 0; x < image.cols; ++x)
  {
    const bool isBlack = image.at<uchar>(row + 100, x) < 128;
    run = isBlack ? run + 1 : 0;
    if (isBlack && (x + 1 == image.cols || image.at<uchar>(row + 100, x + 1) >= 128))
    {
      lengths.push_back(run);
    }
  }
  EXPECT_EQ(lengths, std::vector<int>(4, 200));
  const std::string bytes = readText(file("chess.png"));
  const std::size_t sizeChunk = bytes.find("pHYs");
  ASSERT_NE(sizeChunk, std::string::npos);
  EXPECT_EQ(bytes.substr(sizeChunk + 4, 4), std::string("\x00\x00\x27\x10", 4)) << "10,000 pixels a metre";
  // The detector finds what was printed.
  const BoardDetection detection = detectBoard(image, parseBoard("chessboard:7x5:20"));
  ASSERT_TRUE(detection.isUsable()) << detection.message;
  EXPECT_NEAR((detection.points_Image[6] - detection.points_Image[0]).norm(), 1200, 0.3);

  const CommandResult paper = run({ "camera", "board", Board, "-o", file("board.pdf") });
  ASSERT_EQ(paper.exitCode, 0) << paper.err;
  const std::string pdf = readText(file("board.pdf"));
  EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
  EXPECT_NE(pdf.find("MediaBox"), std::string::npos);
}

TEST_F(BoardCommands, WrongBoards_AreWrongUse)
{
  const CommandResult unknown = run({ "camera", "board", "checker:9x6:20", "-o", file("no.pdf") });
  EXPECT_EQ(unknown.exitCode, 2);
  EXPECT_NE(unknown.err.find("no kind of board"), std::string::npos) << unknown.err;
  const CommandResult large = run({ "camera", "board", "chessboard:9x6:40", "--paper", "A4", "-o", file("no.pdf") });
  EXPECT_EQ(large.exitCode, 2);
  EXPECT_NE(large.err.find("A4 does not hold"), std::string::npos) << large.err;
  EXPECT_EQ(run({ "camera", "board", "chessboard:9x6:20", "-o", file("no.jpg") }).exitCode, 2);
  EXPECT_EQ(run({ "camera", "board", "chessboard:9x6:20" }).exitCode, 2);
  EXPECT_EQ(run({ "camera", "calibrate", file("board"), "--board", Board, "--model", "6" }).exitCode, 2);
  EXPECT_EQ(run({ "camera", "calibrate", file("nothing"), "--board", Board }).exitCode, 2);
  EXPECT_FALSE(std::filesystem::exists(file("no.pdf")));
}

TEST_F(BoardCommands, CameraCalibrate_WritesTheLens)
{
  const CommandResult result = run({ "camera", "calibrate", file("board"), "--board", Board, "--model", "4", "--repeat", "3",
    "--coverage", file("coverage.png"), "--json", "-o", file("found.yml") });
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const json object = result.json();
  const double focal = object["camera"]["cameraMatrix"][0][0];
  EXPECT_NEAR(focal, 450, 0.9) << "0.2 % with a small picture";
  EXPECT_GT(object["sigmas"]["fx"], 0);
  EXPECT_LT(object["reprojectionRmsPx"], 0.2);
  EXPECT_EQ(object["views"].size(), 14U);
  EXPECT_EQ(object["models"].size(), 3U);
  EXPECT_EQ(object["repetitions"]["count"], 3);
  EXPECT_EQ(object["coverage"].size(), 6U);
  const io::CameraFile file4 = io::readCameraFile(file("found.yml"));
  EXPECT_NEAR(file4.camera.fx(), focal, 1e-9);
  EXPECT_EQ(file4.camera.width(), 480);
  EXPECT_EQ(file4.camera.distortionCoefficients().size(), 4U);
  EXPECT_EQ(cv::imread(file("coverage.png")).cols, 960);
  // Another board is not in these pictures.
  const CommandResult other =
    run({ "camera", "calibrate", file("board"), "--board", "chessboard:9x6:20", "-o", file("other.yml") });
  EXPECT_EQ(other.exitCode, 1);
  EXPECT_NE(other.err.find("too_few_views"), std::string::npos) << other.err;
  EXPECT_FALSE(std::filesystem::exists(file("other.yml")));
}

TEST_F(BoardCommands, CameraCalibrate_FromLiveVideo_TakesViewsAndStoresTheirPictures)
{
  // As if live, so slowly that a busy machine sees each picture; each board stands still for one of them only.
  const std::vector<std::string> live{ "camera", "calibrate", "--replay", file("board"), "--speed", "0.2", "--still-frames", "1",
    "--board", Board, "--model", "4", "--store-pictures", file("stored"), "--json", "-o", file("live.yml") };
  const CommandResult result = run(live);
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const json object = result.json();
  EXPECT_NEAR(object["camera"]["cameraMatrix"][0][0].get<double>(), 450, 2);
  EXPECT_NE(result.err.find("view 1 taken"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("of the image covered. Hold"), std::string::npos) << "what to do next: " << result.err;
  EXPECT_EQ(object["sources"].size(), 1U);
  // The pictures that were stored give the same lens, whichever way they are read.
  const CommandResult again = run({ "camera", "calibrate", file("stored"), "--board", Board, "--model", "4", "--all", "--json" });
  ASSERT_EQ(again.exitCode, 0) << again.err;
  EXPECT_EQ(again.json()["views"].size(), object["views"].size());
  EXPECT_NEAR(
    again.json()["camera"]["cameraMatrix"][0][0].get<double>(), object["camera"]["cameraMatrix"][0][0].get<double>(), 1e-6);
  const CommandResult played = run({ "camera", "calibrate", "--replay", file("stored"), "--speed", "3", "--still-frames", "1",
    "--board", Board, "--model", "4", "--json" });
  ASSERT_EQ(played.exitCode, 0) << played.err;
  EXPECT_NEAR(played.json()["camera"]["cameraMatrix"][0][0].get<double>(), 450, 2) << "a replay without tracking";
  // They are not replaced.
  const CommandResult second = run(live);
  EXPECT_EQ(second.exitCode, 2);
  EXPECT_NE(second.err.find("not replaced"), std::string::npos) << second.err;
  // Soon ended, there are too few.
  const CommandResult few = run({ "camera", "calibrate", "--replay", file("board"), "--speed", "0.2", "--still-frames", "1",
    "--seconds", "0.2", "--board", Board });
  EXPECT_EQ(few.exitCode, 1);
  EXPECT_NE(few.err.find("too_few_views"), std::string::npos) << few.err;
  // A recording or a live video, one of them.
  for (const std::vector<std::string>& wrong : { std::vector<std::string>{ "camera", "calibrate", "--board", Board },
         { "camera", "calibrate", file("board"), "--replay", file("board"), "--board", Board },
         { "camera", "calibrate", "--replay", file("board"), "--all", "--board", Board },
         { "camera", "calibrate", file("board"), "--store-pictures", file("other"), "--board", Board },
         { "camera", "calibrate", file("board"), "--seconds", "3", "--board", Board },
         { "camera", "calibrate", file("board"), "--speed", "0", "--board", Board },
         { "camera", "calibrate", "--replay", file("board"), "--store-pictures", file("camera.yml"), "--board", Board },
         { "camera", "calibrate", "--video", file("nothing.mp4"), "--board", Board } })
  {
    EXPECT_EQ(run(wrong).exitCode, 2) << wrong.back();
  }
}

TEST_F(BoardCommands, CameraCalibrate_StereoPair_HasBothLensesAndTheirRelation)
{
  // The same eye twice: what is between them is known, nothing.
  const CommandResult result =
    run({ "camera", "calibrate", file("board"), "--board", Board, "--model", "4", "--right", file("board"), "--repeat", "2",
      "--right-output", file("right.yml"), "--left-to-right", file("leftToRight.txt"), "--json", "-o", file("left.yml") });
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.err.find("warning"), std::string::npos) << result.err;
  const json object = result.json();
  EXPECT_EQ(object["status"], "ok");
  EXPECT_GE(object["pairFrames"].size(), 12U);
  for (const char* const eye : { "left", "right" })
  {
    EXPECT_NEAR(object[eye]["camera"]["cameraMatrix"][0][0].get<double>(), 450, 0.9) << eye;
    EXPECT_EQ(object[eye]["repetitions"]["count"], 2) << eye;
    EXPECT_NEAR(io::readCameraFile(file(std::string(eye) + ".yml")).camera.fx(), 450, 0.9) << eye;
  }
  EXPECT_TRUE(rigid3dNear(transformOf(object["leftToRight"]), Eigen::Isometry3d::Identity(), 1e-4, 0.05));
  std::ifstream matrix(file("leftToRight.txt"));
  double first = 0;
  matrix >> first;
  EXPECT_NEAR(first, 1, 1e-6);
}

TEST_F(BoardCommands, BoardHandEye_FindsTheMarkerByEachMethod)
{
  for (const std::string method :
    { "tsai", "park", "horaud", "daniilidis", "branch-and-bound", "tracked-board", "tracked-board-lines" })
  {
    std::vector<std::string> arguments = { "board-hand-eye", file("board"), "--board", Board, "--camera", file("camera.yml"),
      "--method", method, "--time-limit", "3", "--stylus", file("stylus.json"), "--ball-radius", "12", "--json", "-o",
      file(method + ".json") };
    if (method.rfind("tracked", 0) == 0)
    {
      arguments.insert(arguments.end(), { "--board-transform", "BoardMarkerToTracker" });
    }
    const CommandResult result = run(arguments);
    ASSERT_EQ(result.exitCode, 0) << method << result.err;
    const json object = result.json();
    EXPECT_EQ(object["method"], method);
    // The pixels' noise alone; the search knows its result to a gap only.
    const bool isSearch = method == "branch-and-bound";
    EXPECT_TRUE(
      rigid3dNear(transformOf(object["markerToCamera"]), scene_->markerToCamera, isSearch ? 0.01 : 0.002, isSearch ? 2 : 0.4))
      << method;
    EXPECT_EQ(object["samples"].size(), 14U);
    EXPECT_EQ(object["samples"][3]["status"], "marker_invalid");
    EXPECT_EQ(object["samples"][3]["used"], false);
    EXPECT_EQ(object.contains("branchAndBound"), isSearch);
    EXPECT_EQ(object.contains("covariance"), !isSearch);
    const StoredCalibration stored = readCalibration(file(method + ".json"));
    EXPECT_EQ(stored.ballRadiusMm, 12);
    EXPECT_TRUE(rigid3dNear(stored.markerToCamera, transformOf(object["markerToCamera"]), 1e-12, 1e-12));
  }
}

TEST_F(BoardCommands, BoardHandEye_SaysWhyNot)
{
  const CommandResult untracked =
    run({ "board-hand-eye", file("board"), "--board", Board, "--camera", file("camera.yml"), "--method", "tracked-board" });
  EXPECT_EQ(untracked.exitCode, 1);
  EXPECT_NE(untracked.err.find("no_tracked_board"), std::string::npos) << untracked.err;
  const CommandResult missing = run(
    { "board-hand-eye", file("board"), "--board", Board, "--camera", file("camera.yml"), "--marker-transform", "CameraToTracker" });
  EXPECT_EQ(missing.exitCode, 2);
  EXPECT_NE(missing.err.find("BoardMarkerToTracker"), std::string::npos) << "those that there are: " << missing.err;
  const CommandResult unknown =
    run({ "board-hand-eye", file("board"), "--board", Board, "--camera", file("camera.yml"), "--method", "magic" });
  EXPECT_EQ(unknown.exitCode, 2);
  EXPECT_NE(unknown.err.find("daniilidis"), std::string::npos) << unknown.err;
}
