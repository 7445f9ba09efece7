// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The command line as a script sees it: exit codes, output, the files' keys, and the main job on the demo capture.
#include "CaptureTruth.h"
#include "CommandRunner.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <fstream>

namespace
{

using handeye::testing::CommandResult;
using nlohmann::json;
using Path = std::filesystem::path;

class CommandLine : public ::testing::Test
{
protected:
  void SetUp() override
  {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = Path(HANDEYE_TEST_OUTPUT_DIR) / "CommandLine" / info->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }

  CommandResult run(const std::vector<std::string>& arguments) const
  {
    return handeye::testing::runCommand(HANDEYE_PROGRAM, arguments, folder_);
  }

  std::string file(const char* name) const { return (folder_ / name).string(); }
  std::string demo(const char* name) const { return (Path(HANDEYE_RESOURCES_DIR) / "Demo" / name).string(); }
  std::string model() const { return (Path(HANDEYE_RESOURCES_DIR) / "Meshes" / "Vertebra.ply").string(); }

  void write(const char* name, const std::string& text) const { std::ofstream(folder_ / name) << text; }

  CommandResult pivot() const { return run({ "pivot", demo("pivot.igs.mha"), "--json", "-o", file("stylus.json") }); }
  CommandResult calibrate(const std::vector<std::string>& more = {}) const
  {
    std::vector<std::string> arguments = { "calibrate", demo("calibration"), "--camera", demo("camera.yml"), "--stylus",
      file("stylus.json"), "--ball-radius", "15", "--json", "-o", file("calibration.json") };
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  CommandResult landmarks() const
  {
    return run(
      { "landmarks", demo("phantom_model_points.txt"), demo("phantom_touched_points.txt"), "--json", "-o", file("phantom.json") });
  }

  static void expectKeys(const json& object, const std::vector<std::string>& keys)
  {
    for (const std::string& key : keys)
    {
      EXPECT_TRUE(object.contains(key)) << key;
    }
  }

  /// Wrong use or a bad file: exit code 2, nothing on standard output, a sentence with these words.
  void expectRefused(const std::vector<std::string>& arguments, const std::vector<std::string>& words) const
  {
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exitCode, 2) << result.err;
    EXPECT_EQ(result.out, "");
    for (const std::string& word : words)
    {
      EXPECT_NE(result.err.find(word), std::string::npos) << "'" << word << "' is not in: " << result.err;
    }
  }

  Path folder_;
};

Eigen::Matrix4d toMatrix(const json& rows)
{
  Eigen::Matrix4d matrix;
  for (int k = 0; k < 16; ++k)
  {
    matrix(k / 4, k % 4) = rows.at(std::size_t(k / 4)).at(std::size_t(k % 4));
  }
  return matrix;
}

TEST_F(CommandLine, MainJob_GivesTheContractsFilesAndTheTruth)
{
  const auto truth = handeye::testing::readTruth(demo(""));
  const CommandResult stylus = pivot();
  ASSERT_EQ(stylus.exitCode, 0) << stylus.err;
  expectKeys(stylus.json(), { "tip_Stylus_Mm", "rmsMm", "maxMm", "usedFrames", "rejectedFrames", "tipCovariance_Mm2", "status" });
  EXPECT_EQ(stylus.json(), json::parse(handeye::testing::readText(file("stylus.json"))));

  const CommandResult calibration = calibrate();
  ASSERT_EQ(calibration.exitCode, 0) << calibration.err;
  const json calibrated = calibration.json();
  expectKeys(calibrated,
    { "markerToCamera", "status", "camera", "tip_Stylus_Mm", "ballRadiusMm", "reprojectionRmsPx", "covariance", "samples" });
  expectKeys(calibrated.at("camera"), { "width", "height", "cameraMatrix", "distortionCoefficients" });
  expectKeys(
    calibrated.at("samples").at(0), { "frame", "status", "used", "ball_Image_Px", "tip_Marker_Mm", "residualPx", "residualMm" });
  EXPECT_EQ(calibrated.at("samples").size(), 15U);
  const Eigen::Matrix4d apart = toMatrix(calibrated.at("markerToCamera")) - truth.markerToCamera.matrix();
  EXPECT_LT((apart.topLeftCorner<3, 3>().norm()), 0.005);
  EXPECT_LT((apart.topRightCorner<3, 1>().norm()), 1.5);

  const CommandResult validation =
    run({ "validate", demo("validation"), "--calibration", file("calibration.json"), "--json", "--report", file("report") });
  ASSERT_EQ(validation.exitCode, 0) << validation.err;
  expectKeys(validation.json().at("projectionErrorPx"), { "mean", "std", "min", "max", "rms", "count" });
  expectKeys(
    validation.json().at("samples").at(0), { "frame", "status", "ball_Image_Px", "projected_Image_Px", "errorPx", "distanceMm" });
  EXPECT_LT(validation.json().at("projectionErrorPx").at("mean").get<double>(), 1.5);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "report" / "report.html"));

  const CommandResult phantom = landmarks();
  ASSERT_EQ(phantom.exitCode, 0) << phantom.err;
  expectKeys(phantom.json(), { "modelToPhantom", "rmsMm", "residualsMm" });
}

TEST_F(CommandLine, Overlay_CoversThePhantomInThePicture)
{
  ASSERT_EQ(pivot().exitCode, 0);
  ASSERT_EQ(calibrate().exitCode, 0);
  ASSERT_EQ(landmarks().exitCode, 0);
  const CommandResult overlay = run({ "overlay", demo("validation"), "--calibration", file("calibration.json"), "--model", model(),
    "--registration", file("phantom.json"), "--mask", "--json", "-o", file("mask") });
  ASSERT_EQ(overlay.exitCode, 0) << overlay.err;
  ASSERT_EQ(overlay.json().at("frames").size(), 8U);
  for (const json& frame : overlay.json().at("frames"))
  {
    const cv::Mat mask = cv::imread(frame.at("file").get<std::string>(), cv::IMREAD_GRAYSCALE);
    const cv::Mat truth = cv::imread(
      (Path(demo("validation")) / "mask" / Path(frame.at("file").get<std::string>()).filename()).string(), cv::IMREAD_GRAYSCALE);
    ASSERT_EQ(mask.size(), cv::Size(640, 480));
    ASSERT_EQ(truth.size(), mask.size());
    // The true masks show what of the phantom is seen; something in front of it takes pixels away from them, never from ours.
    const double both = cv::countNonZero((mask > 127) & (truth > 127)), seen = cv::countNonZero(truth > 127);
    const double ours = cv::countNonZero(mask > 127);
    EXPECT_GT(both / seen, 0.97) << frame.dump();
    EXPECT_GT(both / ours, 0.80) << frame.dump();
    EXPECT_EQ(cv::countNonZero((mask != 0) & (mask != 255)), 0);
  }
}

TEST_F(CommandLine, StereoRig_WithKnownRelation_IsOneRegistration)
{
  ASSERT_EQ(pivot().exitCode, 0);
  // The demo's camera stands in for both eyes: the relation between them is then the identity.
  write("leftToRight.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const CommandResult joined =
    calibrate({ "--right", demo("validation"), "--right-camera", demo("camera.yml"), "--left-to-right", file("leftToRight.txt") });
  ASSERT_EQ(joined.exitCode, 0) << joined.err;
  const json both = joined.json();
  EXPECT_EQ(both.at("samples").size(), 15U);
  EXPECT_EQ(both.at("rightSamples").size(), 8U);
  EXPECT_LT((toMatrix(both.at("markerToCamera")) - toMatrix(both.at("markerToRightCamera"))).norm(), 1e-12);
  // A relation that is not there must not be believed: both eyes contradict each other.
  write("wrong.txt", "1 0 0 -60\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const CommandResult wrong =
    calibrate({ "--right", demo("validation"), "--right-camera", demo("camera.yml"), "--left-to-right", file("wrong.txt") });
  EXPECT_EQ(wrong.exitCode, 1) << wrong.out;
  const CommandResult apart = calibrate({ "--right", demo("validation"), "--right-camera", demo("camera.yml") });
  ASSERT_EQ(apart.exitCode, 0) << apart.err;
  EXPECT_GT((toMatrix(apart.json().at("markerToCamera")) - toMatrix(apart.json().at("markerToRightCamera"))).norm(), 1e-6);
}

TEST_F(CommandLine, Detect_NamesEveryFrame)
{
  const CommandResult result =
    run({ "detect", demo("calibration"), "--camera", demo("camera.yml"), "--ball-radius", "15", "--json" });
  ASSERT_EQ(result.exitCode, 0) << result.err;
  ASSERT_EQ(result.json().at("frames").size(), 15U);
  expectKeys(result.json().at("frames").at(0), { "frame", "status", "ball_Image_Px", "radiusPx", "distanceMm" });
}

TEST_F(CommandLine, Register_PrintsTheTransform)
{
  // A turn by 90 deg about z and a shift, seen on skew lines.
  write("table.txt",
    "# points, origins, directions\n"
    "1 0 0  10 21 35  0 0 1\n0 1 0  9 25 30  0 1 0\n0 0 1  17 20 31  1 0 0\n1 1 1  9 21 38  0 0 2\n-3 2 5  5 17 35  -3 0 0\n");
  const CommandResult result = run({ "register", file("table.txt") });
  ASSERT_EQ(result.exitCode, 0) << result.err;
  std::istringstream text(result.out);
  const double expected[] = { 0, -1, 0, 10, 1, 0, 0, 20, 0, 0, 1, 30, 0, 0, 0, 1 };
  for (double value : expected)
  {
    double printed = 99;
    text >> printed;
    EXPECT_NEAR(printed, value, 1e-9);
  }
}

TEST_F(CommandLine, Register_TakesEachMethodAndRefusesWhatDoesNotFit)
{
  // Six points 400 mm ahead, seen from one centre; moved by (1, 2, 3).
  const std::string rays = "-1 -2 397 0 0 0 0 0 400\n99 -2 407 0 0 0 100 0 410\n-1 98 427 0 0 0 0 100 430\n"
                           "-101 -2 447 0 0 0 -100 0 450\n-1 -102 377 0 0 0 0 -100 380\n59 68 397 0 0 0 60 70 400\n";
  write("rays.txt", rays);
  for (const std::string method : { "ml", "global", "procrustes", "oi", "ppnp", "epnp", "sqpnp", "iterative" })
  {
    const CommandResult result = run({ "register", file("rays.txt"), "--rays", "--method", method, "--json" });
    ASSERT_EQ(result.exitCode, 0) << method << ": " << result.err << result.out;
    EXPECT_EQ(result.json().at("rank"), 6);
    const Eigen::Matrix4d moved = toMatrix(result.json().at("pointsToLines"));
    EXPECT_LT((moved.topRightCorner<3, 1>() - Eigen::Vector3d(1, 2, 3)).norm(), 0.01) << method;
  }
  write("two.txt", rays + "1 2 3 50 0 0 1 2 6\n");
  const CommandResult refused = run({ "register", file("two.txt"), "--method", "sqpnp" });
  EXPECT_EQ(refused.exitCode, 1);
  EXPECT_NE((refused.out + refused.err).find("one centre"), std::string::npos) << refused.out << refused.err;
  write("wrong.txt",
    "200 0 0 0 0 0 0 0 1\n0 200 0 0 0 0 1 0 1\n0 0 200 0 0 0 0 1 1\n-200 0 0 0 0 0 1 1 1\n"
    "0 -200 0 0 0 0 -1 0 1\n0 0 -200 0 0 0 0 -1 1\n150 150 0 0 0 0 -1 -1 1\n");
  const CommandResult wrong = run({ "register", file("wrong.txt"), "--json", "--sigma-mm", "0.5" });
  EXPECT_EQ(wrong.exitCode, 1) << wrong.out;
  EXPECT_FALSE(wrong.json().contains("pointsToLines"));
  expectRefused({ "register", file("rays.txt"), "--method", "best" }, { "--method", "'best'", "procrustes", "ml" });
  expectRefused({ "register", file("rays.txt"), "--sigma-mm", "-1" }, { "standard deviation" });
}

TEST_F(CommandLine, Calibrate_SaysWhereToHoldTheBallNextAndWhatItExpects)
{
  ASSERT_EQ(pivot().exitCode, 0);
  const CommandResult result = calibrate({ "--refine-tip", "--depth-range", "200", "600" });
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const json calibrated = result.json();
  expectKeys(calibrated.at("nextPlacement"), { "status", "message", "worthwhile", "ball_Image_Px", "depthMm", "gain" });
  EXPECT_GE(calibrated.at("nextPlacement").at("depthMm").get<double>(), 200);
  EXPECT_LE(calibrated.at("nextPlacement").at("depthMm").get<double>(), 600.001);
  expectKeys(calibrated, { "predictedErrorMm", "rank", "conditionNumber", "weakestFreedom", "noise", "tipRefinement" });
  EXPECT_EQ(calibrated.at("rank"), 6);
  EXPECT_EQ(calibrated.at("predictedErrors").size(), 27U);
  expectKeys(calibrated.at("predictedErrors").at(0), { "point_Image_Px", "depthMm", "errorPx", "errorMm" });
  const CommandResult text = run(
    { "calibrate", demo("calibration"), "--camera", demo("camera.yml"), "--stylus", file("stylus.json"), "--ball-radius", "15" });
  EXPECT_NE(text.out.find("next placement"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("target error"), std::string::npos) << text.out;
  expectRefused({ "calibrate", demo("calibration"), "--camera", demo("camera.yml"), "--stylus", file("stylus.json"),
                  "--ball-radius", "15", "--depth-range", "600", "200" },
    { "--depth-range", "nearest" });
}

TEST_F(CommandLine, DataThatDoNotAllowAResult_Exit1AndKeepTheOldFile)
{
  write("parallel.txt", "0 0 0 0 0 0 0 0 1\n1 0 0 1 0 0 0 0 1\n0 1 0 0 1 0 0 0 1\n1 1 1 1 1 0 0 0 1\n");
  const CommandResult parallel = run({ "register", file("parallel.txt"), "--json" });
  EXPECT_EQ(parallel.exitCode, 1);
  EXPECT_EQ(parallel.json().at("status"), "not_observable");
  EXPECT_FALSE(parallel.json().contains("pointsToLines"));
  EXPECT_NE(parallel.err.find("parallel"), std::string::npos) << parallel.err;

  ASSERT_EQ(pivot().exitCode, 0);
  write("calibration.json", "what was there before");
  // A ball radius does not matter to the rays, a stylus with a tip elsewhere does.
  json stylus = json::parse(handeye::testing::readText(file("stylus.json")));
  stylus["tip_Stylus_Mm"] = { 80.0, -60.0, 20.0 };
  write("stylus.json", stylus.dump());
  const CommandResult wrong = calibrate();
  EXPECT_EQ(wrong.exitCode, 1) << wrong.out;
  EXPECT_FALSE(wrong.json().contains("markerToCamera"));
  EXPECT_EQ(handeye::testing::readText(file("calibration.json")), "what was there before");
}

/// What a tired person does at seven in the morning: each must not end in a result.
TEST_F(CommandLine, SlipsOfThePerson_AreNotCalledUsable)
{
  ASSERT_EQ(pivot().exitCode, 0);
  const auto status = [](const CommandResult& result) { return result.json().at("status").get<std::string>(); };
  for (const char* radius : { "12", "30", "1000" })
  {
    const CommandResult wrongRadius = run({ "calibrate", demo("calibration"), "--camera", demo("camera.yml"), "--stylus",
      file("stylus.json"), "--ball-radius", radius, "--json" });
    EXPECT_EQ(wrongRadius.exitCode, 1) << radius;
    EXPECT_EQ(status(wrongRadius), "wrong_scale") << radius;
  }

  const std::string touched = handeye::testing::readText(demo("phantom_touched_points.txt"));
  std::vector<std::string> lines;
  std::istringstream text(touched);
  for (std::string line; std::getline(text, line);)
  {
    if (!line.empty() && line[0] != '#')
    {
      lines.push_back(line);
    }
  }
  std::string reversed;
  for (const std::string& line : lines)
  {
    reversed = line + "\n" + reversed;
  }
  write("reversed.txt", reversed);
  const CommandResult wrongOrder = run({ "landmarks", demo("phantom_model_points.txt"), file("reversed.txt"), "--json" });
  EXPECT_EQ(wrongOrder.exitCode, 1);
  EXPECT_FALSE(wrongOrder.json().contains("modelToPhantom"));

  // The same few places again and again are no fifteen samples.
  const std::filesystem::path repeated = folder_ / "repeated";
  std::filesystem::create_directories(repeated / "frames");
  const std::string tracking = handeye::testing::readText(Path(demo("calibration")) / "tracking.igs.mha");
  std::string copied;
  std::istringstream header(tracking);
  std::vector<std::string> frames(15);
  for (std::string line; std::getline(header, line);)
  {
    if (line.rfind("Seq_Frame", 0) == 0)
    {
      frames.at(std::stoul(line.substr(9, 4))) += line.substr(13) + "\n";
    }
    else if (line.rfind("ElementDataFile", 0) != 0)
    {
      copied += line + "\n";
    }
  }
  for (std::size_t frame = 0; frame < 15; ++frame)
  {
    const std::string number = (frame < 10 ? "000" : "00") + std::to_string(frame);
    const std::string source = "000" + std::to_string(frame % 4);
    std::istringstream fields(frames.at(frame % 4));
    for (std::string line; std::getline(fields, line);)
    {
      copied += "Seq_Frame" + number + line + "\n";
    }
    std::filesystem::copy_file(Path(demo("calibration")) / "frames" / (source + ".jpg"), repeated / "frames" / (number + ".jpg"));
  }
  std::ofstream(repeated / "tracking.igs.mha") << copied << "ElementDataFile = LOCAL\n";
  const CommandResult fewPlaces = run({ "calibrate", repeated.string(), "--camera", demo("camera.yml"), "--stylus",
    file("stylus.json"), "--ball-radius", "15", "--json" });
  EXPECT_EQ(fewPlaces.exitCode, 1) << fewPlaces.out;
  EXPECT_FALSE(fewPlaces.json().contains("markerToCamera"));
}

TEST_F(CommandLine, OverlayOutOfView_IsNotCalledDrawn)
{
  ASSERT_EQ(pivot().exitCode, 0);
  ASSERT_EQ(calibrate().exitCode, 0);
  ASSERT_EQ(landmarks().exitCode, 0);
  json phantom = json::parse(handeye::testing::readText(file("phantom.json")));
  phantom["modelToPhantom"][0][3] = 1e5;
  write("phantom.json", phantom.dump());
  const CommandResult overlay = run({ "overlay", demo("validation"), "--calibration", file("calibration.json"), "--model", model(),
    "--registration", file("phantom.json"), "--json", "-o", file("pictures") });
  EXPECT_EQ(overlay.exitCode, 1);
  EXPECT_EQ(overlay.json().at("frames").at(0).at("status"), "out_of_view");
}

TEST_F(CommandLine, WrongUse_Exits2WithASentence)
{
  expectRefused({}, { "handeye" });
  expectRefused({ "calibrat" }, { "calibrat" });
  expectRefused({ "pivot" }, { "recording" });
  expectRefused({ "pivot", file("none.mha") }, { "none.mha", "no such file" });
  expectRefused({ "pivot", demo("pivot.igs.mha"), "--transform", "ProbeToTracker" }, { "ProbeToTracker", "StylusToTracker" });
  expectRefused({ "pivot", demo("pivot.igs.mha"), "-o", "/none/stylus.json" }, { "/none" });
  ASSERT_EQ(pivot().exitCode, 0);
  const std::vector<std::string> base = { "calibrate", demo("calibration"), "--camera", demo("camera.yml"), "--stylus",
    file("stylus.json") };
  const auto with = [&](std::vector<std::string> more)
  {
    more.insert(more.begin(), base.begin(), base.end());
    return more;
  };
  expectRefused(with({}), { "--ball-radius" });
  expectRefused(with({ "--ball-radius", "-15" }), { "--ball-radius", "'-15'", "positive" });
  expectRefused(with({ "--ball-radius", "15", "--method", "magic" }), { "magic", "global", "procrustes" });
  expectRefused(with({ "--ball-radius", "15", "--marker-transform", "CameraToTracker" }),
    { "CameraToTracker", "MarkerToTracker", "PhantomToTracker", "StylusToTracker" });
  write("other.yml",
    "%YAML:1.0\n---\nimage_width: 1920\nimage_height: 1080\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
    "   data: [ 600, 0, 960, 0, 600, 540, 0, 0, 1 ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 4\n"
    "   dt: d\n   data: [ 0, 0, 0, 0 ]\n");
  expectRefused(
    { "calibrate", demo("calibration"), "--camera", file("other.yml"), "--stylus", file("stylus.json"), "--ball-radius", "15" },
    { "1920 x 1080", "640 x 480" });
  write("points.txt", "1 2 3\n4 five 6\n");
  expectRefused({ "landmarks", file("points.txt"), file("points.txt") }, { "points.txt", "line 2" });
  expectRefused({ "validate", demo("validation"), "--calibration", file("stylus.json") }, { "stylus.json", "markerToCamera" });
}

TEST_F(CommandLine, Help_IsThereForEveryCommand)
{
  EXPECT_EQ(run({ "--help" }).exitCode, 0);
  EXPECT_EQ(run({ "--version" }).exitCode, 0);
  for (const char* command : { "pivot", "calibrate", "validate", "detect", "register", "landmarks", "overlay" })
  {
    const CommandResult help = run({ command, "--help" });
    EXPECT_EQ(help.exitCode, 0);
    EXPECT_NE(help.out.find("--json"), std::string::npos) << command;
    EXPECT_NE(help.out.find("-o"), std::string::npos) << command;
  }
}

}  // namespace
