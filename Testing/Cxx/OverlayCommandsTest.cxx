// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// `handeye overlay`: its looks, both lens ways, the stylus, hidden tools, two eyes, video and transforms.
#include "CommandRunner.h"
#include "SequenceMetafile.h"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include <cmath>
#include <fstream>
#include <utility>

namespace
{

using handeye::testing::CommandResult;
using nlohmann::json;
using Path = std::filesystem::path;

class OverlayCommands : public ::testing::Test
{
protected:
  void SetUp() override
  {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = Path(HANDEYE_TEST_OUTPUT_DIR) / "OverlayCommands" / info->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    // Files as the commands before write them, from the truth.
    const json truth = json::parse(handeye::testing::readText(demo("truth.json")));
    const json camera = { { "width", 640 }, { "height", 480 },
      { "cameraMatrix", { { 600, 0, 320 }, { 0, 600, 240 }, { 0, 0, 1 } } }, { "distortionCoefficients", { -0.2, 0.03, 0, 0 } } };
    json covariance = json::array();
    for (int row = 0; row < 6; ++row)
    {
      covariance.push_back(json::array({ 0, 0, 0, 0, 0, 0 }));
      covariance[std::size_t(row)][std::size_t(row)] = row < 3 ? 1e-6 : 0.25;
    }
    write("calibration.json",
      json{ { "status", "ok" }, { "markerToCamera", truth.at("markerToCamera") },
        { "markerToRightCamera", truth.at("markerToCamera") }, { "camera", camera }, { "tip_Stylus_Mm", truth.at("tip_Stylus_Mm") },
        { "ballRadiusMm", truth.at("ballRadiusMm") }, { "covariance", covariance } }
        .dump());
    write("phantom.json", json{ { "status", "ok" }, { "modelToPhantom", truth.at("modelToPhantom") } }.dump());
    write("stylus.json", json{ { "status", "ok" }, { "tip_Stylus_Mm", truth.at("tip_Stylus_Mm") } }.dump());
    cutRecording();
  }

  /// The first four frames of the demo's validation, 0.2 s apart; the phantom is hidden in frames 2 and 3.
  void cutRecording()
  {
    std::filesystem::create_directories(folder_ / "recording" / "frames");
    std::istringstream all(handeye::testing::readText(demo("validation/tracking.igs.mha")));
    std::ofstream tracking(folder_ / "recording" / "tracking.igs.mha");
    for (std::string line; std::getline(all, line);)
    {
      const bool beyond = line.rfind("Seq_Frame000", 0) == 0 && line.at(12) >= '4';
      if (line.find("_Timestamp") != std::string::npos)
      {
        line = line.substr(0, line.find('=')) + "= " + std::to_string(100 + 0.2 * (line.at(12) - '0'));
      }
      if (line == "DimSize = 0 0 8")
      {
        line = "DimSize = 0 0 4";
      }
      if (line == "Seq_Frame0002_PhantomToTrackerTransformStatus = OK" ||
        line == "Seq_Frame0003_PhantomToTrackerTransformStatus = OK")
      {
        line = line.substr(0, line.find('=')) + "= INVALID";
      }
      if (!beyond)
      {
        tracking << line << "\n";
      }
    }
    for (const std::string name : { "0000.jpg", "0001.jpg", "0002.jpg", "0003.jpg" })
    {
      std::filesystem::copy_file(demo("validation/frames/" + name), folder_ / "recording" / "frames" / name);
    }
  }

  CommandResult overlay(const std::vector<std::string>& more, const std::string& out) const
  {
    std::vector<std::string> arguments{ "overlay", file("recording"), "--calibration", file("calibration.json"), "--model",
      (Path(HANDEYE_RESOURCES_DIR) / "Meshes" / "Vertebra.ply").string(), "--registration", file("phantom.json"), "--json", "-o",
      file(out) };
    arguments.insert(arguments.end(), more.begin(), more.end());
    return handeye::testing::runCommand(HANDEYE_PROGRAM, arguments, folder_);
  }

  cv::Mat picture(const std::string& out, const std::string& name = "0000.png") const
  {
    return cv::imread((folder_ / out / name).string());
  }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  static std::string demo(const std::string& name) { return (Path(HANDEYE_RESOURCES_DIR) / "Demo" / name).string(); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }

  Path folder_;
};

}  // namespace

TEST_F(OverlayCommands, Looks_ChangeThePictures)
{
  const CommandResult plain = overlay({}, "plain");
  ASSERT_EQ(plain.exitCode, 0) << plain.err;
  const CommandResult looks =
    overlay({ "--look", "outline,ghosting,halo", "--keyhole", "0.5,0.5,0.3", "--without", "stylus", "--opacity", "1" }, "looks");
  ASSERT_EQ(looks.exitCode, 0) << looks.err;
  const CommandResult straight = overlay({ "--lens", "undistorted" }, "straight");
  ASSERT_EQ(straight.exitCode, 0) << straight.err;
  ASSERT_EQ(picture("plain").size(), cv::Size(640, 480));
  ASSERT_EQ(picture("straight").size(), cv::Size(640, 480));
  EXPECT_GT(cv::norm(picture("plain"), picture("looks"), cv::NORM_INF), 50);
  EXPECT_GT(cv::norm(picture("plain"), picture("straight"), cv::NORM_INF), 50);
  EXPECT_GT(plain.json().at("frames").at(0).at("predictedErrorPx").get<double>(), 0.5);
}

TEST_F(OverlayCommands, HiddenPhantom_LeavesTheVideoAlone_OrFades)
{
  const CommandResult plain = overlay({}, "plain");
  ASSERT_EQ(plain.exitCode, 0) << plain.err;
  EXPECT_EQ(plain.json().at("frames").at(2).at("status"), "phantom_invalid");
  const cv::Mat video = cv::imread(file("recording/frames/0002.jpg"));
  EXPECT_EQ(cv::norm(picture("plain", "0002.png"), video, cv::NORM_INF), 0);

  const CommandResult faded = overlay({ "--fade" }, "faded");
  ASSERT_EQ(faded.exitCode, 0) << faded.err;
  const json frames = faded.json().at("frames");
  EXPECT_EQ(frames.at(1).at("opacity"), 1.0);
  EXPECT_EQ(frames.at(2).at("poseAge"), "fading");
  EXPECT_LT(frames.at(2).at("opacity").get<double>(), 1.0);
  EXPECT_LT(frames.at(3).at("opacity").get<double>(), frames.at(2).at("opacity").get<double>());
  EXPECT_EQ(frames.at(2).at("status"), "phantom_invalid");
  EXPECT_GT(cv::norm(picture("faded", "0002.png"), video, cv::NORM_INF), 20);
}

TEST_F(OverlayCommands, VideoAndTransforms_AreWritten)
{
  const CommandResult result = overlay({ "--video", file("overlay.mp4"), "--smooth", "--stylus", file("stylus.json") }, "out");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_GT(result.json().at("smoothingDelaySec").at("max").get<double>(), 0);
  cv::VideoCapture video(file("overlay.mp4"));
  cv::Mat frame;
  int count = 0;
  while (video.read(frame))
  {
    ++count;
  }
  EXPECT_EQ(count, 4);
  for (const std::string name : { "overlay.igs.mha", "out/transforms.igs.mha" })
  {
    const handeye::io::SequenceMetafile metafile = handeye::io::SequenceMetafile::open(file(name));
    ASSERT_EQ(metafile.frameCount(), 4) << name;
    EXPECT_TRUE(metafile.transform(0, "ModelToCamera").isUsable()) << name;
    EXPECT_TRUE(metafile.transform(0, "StylusTipToCamera").isUsable()) << name;
    EXPECT_EQ(metafile.transform(2, "ModelToCamera").status, handeye::io::TransformSample::Status::Invalid) << name;
  }
}

TEST_F(OverlayCommands, TwoEyes_ShareAPicture)
{
  const std::vector<std::string> right{ "--right", file("recording"), "--right-camera", file("calibration.json") };
  const std::vector<std::pair<std::string, cv::Size>> layouts{ { "side-by-side", { 1280, 480 } }, { "top-bottom", { 640, 960 } },
    { "interlaced", { 640, 480 } }, { "anaglyph", { 640, 480 } } };
  for (const auto& [layout, size] : layouts)
  {
    std::vector<std::string> arguments = right;
    arguments.insert(arguments.end(), { "--stereo", layout });
    const CommandResult result = overlay(arguments, layout);
    ASSERT_EQ(result.exitCode, 0) << layout << result.err;
    EXPECT_EQ(picture(layout).size(), size) << layout;
    EXPECT_EQ(result.json().at("frames").at(0).at("right").at("status"), "ok");
  }
  const CommandResult noLens = overlay({ "--right", file("recording") }, "nothing");
  EXPECT_EQ(noLens.exitCode, 2) << noLens.err;
}

TEST_F(OverlayCommands, RightEyesHalo_IsOfTheRightEye)
{
  // All that is uncertain is a turn about the left eye's axis; the right eye is 25 mm beside it and has the same lens, without
  // distortion.
  json calibration = json::parse(handeye::testing::readText(file("calibration.json")));
  for (std::size_t i = 0; i < 6; ++i)
  {
    calibration["covariance"][i][i] = i == 2 ? 1e-4 : 0.0;
  }
  calibration["camera"]["distortionCoefficients"] = { 0, 0, 0, 0 };
  calibration["rightCamera"] = calibration["camera"];
  calibration["markerToRightCamera"][0][3] = calibration["markerToCamera"][0][3].get<double>() - 25;
  const auto errorsPx = [&](const std::string& out)
  {
    write("calibration.json", calibration.dump());
    const CommandResult result = overlay({ "--right", file("recording") }, out);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    const json row = result.json().at("frames").at(0);
    return std::pair(row.at("predictedErrorPx").get<double>(), row.at("right").at("predictedErrorPx").get<double>());
  };
  const auto [left, right] = errorsPx("together");
  // Both eyes see the same motion of the same point at the same depth.
  EXPECT_GT(left, 0.2);
  EXPECT_NEAR(right / left, 1, 0.02);
  // A turn about the right eye's own axis is another one.
  calibration["right"] = { { "status", "ok" }, { "covariance", calibration["covariance"] } };
  const double own = errorsPx("apart").second;
  EXPECT_GT(std::abs(own / left - 1), 0.1);
  for (json& row : calibration["right"]["covariance"])
  {
    row[2] = 9 * row[2].get<double>();
  }
  EXPECT_NEAR(errorsPx("wider").second / own, 3, 1e-6);
}

TEST_F(OverlayCommands, WrongUse_IsSaid)
{
  EXPECT_EQ(overlay({ "--look", "sparkle" }, "x").exitCode, 2);
  EXPECT_EQ(overlay({ "--stereo", "anaglyph" }, "x").exitCode, 2);
  EXPECT_EQ(overlay({ "--lens", "fisheye" }, "x").exitCode, 2);
  EXPECT_EQ(overlay({ "--keyhole", "0.5,0.5,0" }, "x").exitCode, 2);
  EXPECT_EQ(overlay({ "--clipping-depth", "2" }, "x").exitCode, 2);
  const CommandResult ending = overlay({ "--video", file("overlay.gif") }, "x");
  EXPECT_EQ(ending.exitCode, 2);
  EXPECT_NE(ending.err.find(".mp4"), std::string::npos) << ending.err;
  EXPECT_NE(overlay({ "--look", "sparkle" }, "x").err.find("depth-colors"), std::string::npos);
}
