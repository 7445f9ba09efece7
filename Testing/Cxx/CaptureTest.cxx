// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Capture.h"

#include "CaptureSimulation.h"
#include "GeometryMatchers.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace handeye;
using namespace handeye::test;
using handeye::io::test::expectFileError;
using handeye::io::test::TemporaryFolder;

namespace
{

/// A recording of five frames with all that can be amiss: see damage().
class Capture : public testing::Test
{
protected:
  const SimulatedSession session{ 5 };
  const TemporaryFolder folder;
  std::vector<io::SequenceFrame> tracking = session.trackAll();

  io::Recording record() const { return io::Recording::open(session.write(folder.path() / "capture", tracking)); }

  std::vector<CapturedFrame> read(const io::Recording& recording, const Progress& progress = {}) const
  {
    return readCapture(recording, {}, session.camera, session.tip_Stylus, session.ballRadiusMm, {}, progress);
  }

  /// What a file says of a hidden tool: INVALID, beside a transform that looks like any other.
  void hide(std::size_t frame, const std::string& transform) { tracking[frame].transforms[transform].status = "INVALID"; }
};

}  // namespace

TEST_F(Capture, EachFrame_GivesTheBallInImageAndMarker)
{
  const io::Recording recording = record();
  const std::vector<CapturedFrame> frames = read(recording);
  ASSERT_EQ(frames.size(), 5U);
  for (std::size_t i = 0; i < frames.size(); ++i)
  {
    EXPECT_EQ(frames[i].frame, int(i));
    ASSERT_EQ(frames[i].status, "ok") << frames[i].message;
    EXPECT_TRUE(frames[i].isSample());
    const Eigen::Vector2d expected = session.camera.project(session.balls_Camera[i]).point_Image;
    EXPECT_TRUE(pointNear(frames[i].ball.ball_Image, expected, 0.05));
    EXPECT_TRUE(pointNear(*frames[i].tip_Marker, session.tip_Marker(i), 1e-9));
  }
}

TEST_F(Capture, HiddenTool_IsNoSampleAndHasNoTip)
{
  hide(1, "StylusToTracker");
  hide(2, "MarkerToTracker");
  hide(3, "MarkerToTracker");
  hide(3, "StylusToTracker");
  const std::vector<CapturedFrame> frames = read(record());
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_EQ(frames[1].status, "stylus_invalid");
  EXPECT_EQ(frames[2].status, "marker_invalid");
  EXPECT_EQ(frames[3].status, "marker_invalid");
  for (const std::size_t i : { std::size_t(1), std::size_t(2), std::size_t(3) })
  {
    EXPECT_FALSE(frames[i].isSample());
    EXPECT_FALSE(frames[i].tip_Marker.has_value());
    EXPECT_TRUE(says(frames[i].message, {}));
    EXPECT_TRUE(frames[i].ball.isFound()) << "the ball is there all the same";
  }
  const std::vector<HandEyeSample> samples = toSamples(frames);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[0].frame, 0);
  EXPECT_EQ(samples[1].frame, 4);
}

TEST_F(Capture, TransformThatAFrameDoesNotHave_IsMissing)
{
  tracking[2].transforms.erase("StylusToTracker");
  tracking[4].transforms.erase("MarkerToTracker");
  const std::vector<CapturedFrame> frames = read(record());
  EXPECT_EQ(frames[2].status, "stylus_missing");
  EXPECT_EQ(frames[4].status, "marker_missing");
}

TEST_F(Capture, MatrixThatIsNotRigid_IsInvalid)
{
  (*tracking[1].transforms["StylusToTracker"].matrix)(0, 0) = std::nan("");
  *tracking[2].transforms["MarkerToTracker"].matrix = Eigen::Matrix4d::Zero();
  const std::vector<CapturedFrame> frames = read(record());
  EXPECT_EQ(frames[1].status, "stylus_invalid");
  EXPECT_EQ(frames[2].status, "marker_invalid");
  EXPECT_EQ(toSamples(frames).size(), 3U);
}

TEST_F(Capture, MissingImage_IsNoSample)
{
  const std::filesystem::path path = session.write(folder.path() / "capture", tracking);
  std::filesystem::remove(SimulatedSession::picturePath(path, 0));
  std::filesystem::remove(SimulatedSession::picturePath(path, 2));
  const std::vector<CapturedFrame> frames = read(io::Recording::open(path));
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_EQ(frames[0].status, "image_missing");
  EXPECT_EQ(frames[2].status, "image_missing");
  EXPECT_FALSE(frames[2].ball.isFound());
  EXPECT_EQ(frames[1].status, "ok");
  EXPECT_EQ(toSamples(frames).size(), 3U);
}

TEST_F(Capture, FrameWithoutTheBall_SaysSo)
{
  const std::filesystem::path path = session.write(folder.path() / "capture", tracking);
  SimulatedSession::writePicture(path, 3, SphereScene(session.camera).photograph());
  const std::vector<CapturedFrame> frames = read(io::Recording::open(path));
  EXPECT_EQ(frames[3].status, "not_found");
  EXPECT_TRUE(says(frames[3].message, { "no ball" }));
  EXPECT_TRUE(frames[3].tip_Marker.has_value());
  EXPECT_FALSE(frames[3].isSample());
}

TEST_F(Capture, OtherTransformNames_ListThoseThatExist)
{
  const io::Recording recording = record();
  const ToolNames tools{ "PointerToTracker", "MarkerToTracker" };
  const auto call = [&] { (void)readCapture(recording, tools, session.camera, session.tip_Stylus, session.ballRadiusMm); };
  expectFileError(call, { "tracking.igs.mha", "PointerToTracker", "MarkerToTracker", "StylusToTracker" });
}

TEST_F(Capture, OtherNames_AreFollowed)
{
  for (io::SequenceFrame& frame : tracking)
  {
    frame.transforms["PointerToTracker"] = frame.transforms["StylusToTracker"];
    frame.transforms["HeadToTracker"] = frame.transforms["MarkerToTracker"];
    frame.transforms["StylusToTracker"].matrix->col(3).head<3>() += Eigen::Vector3d(50, 0, 0);
    frame.transforms["MarkerToTracker"].status = "INVALID";
  }
  const io::Recording recording = record();
  const ToolNames tools{ "PointerToTracker", "HeadToTrackerTransform" };
  const auto frames = readCapture(recording, tools, session.camera, session.tip_Stylus, session.ballRadiusMm);
  ASSERT_EQ(frames[2].status, "ok") << frames[2].message;
  EXPECT_TRUE(pointNear(*frames[2].tip_Marker, session.tip_Marker(2), 1e-9));
}

TEST_F(Capture, ImagesOfAnotherSize_AreRefused)
{
  const std::filesystem::path path = session.write(folder.path() / "capture", tracking);
  for (int frame = 0; frame < 5; ++frame)
  {
    SimulatedSession::writePicture(path, frame, cv::Mat(240, 426, CV_8UC3, cv::Scalar(120, 120, 120)));
  }
  const io::Recording recording = io::Recording::open(path);
  expectInvalidArgument([&] { (void)read(recording); }, { "320 x 240", "426 x 240" });
  expectInvalidArgument([&] { (void)cameraForRecording(session.camera, recording); }, { "320 x 240", "426 x 240" });
}

TEST_F(Capture, OneImageOfAnotherSize_IsRefused)
{
  const std::filesystem::path path = session.write(folder.path() / "capture", tracking);
  SimulatedSession::writePicture(path, 4, cv::Mat(480, 640, CV_8UC3, cv::Scalar(120, 120, 120)));
  expectInvalidArgument([&] { (void)read(io::Recording::open(path)); }, { "640 x 480", "320 x 240" });
}

TEST_F(Capture, CameraWithoutImageSize_TakesThatOfTheRecording)
{
  const CameraModel sizeless(0, 0, session.camera.cameraMatrix(), session.camera.distortionCoefficients());
  const CameraModel sized = cameraForRecording(sizeless, record());
  EXPECT_EQ(sized.width(), 320);
  EXPECT_EQ(sized.height(), 240);
}

TEST_F(Capture, RecordingWithoutImages_IsRefused)
{
  const std::filesystem::path path = folder.path() / "only.igs.mha";
  SimulatedSession::writeTracking(path, tracking);
  const io::Recording recording = io::Recording::open(path);
  expectFileError([&] { (void)read(recording); }, { "only.igs.mha", "no images" });
  expectFileError([&] { (void)detectBalls(recording, session.camera, session.ballRadiusMm); }, { "no images" });
}

TEST_F(Capture, Progress_IsToldAndStops)
{
  const io::Recording recording = record();
  std::vector<int> told;
  const auto frames = read(recording,
    [&](int done, int total)
    {
      EXPECT_EQ(total, 5);
      told.push_back(done);
      return done < 3;
    });
  EXPECT_EQ(told, (std::vector<int>{ 1, 2, 3 }));
  EXPECT_EQ(frames.size(), 3U);
}

TEST_F(Capture, DetectBalls_NeedsNoTracking)
{
  hide(1, "StylusToTracker");
  const auto frames = detectBalls(record(), session.camera, session.ballRadiusMm);
  ASSERT_EQ(frames.size(), 5U);
  for (const CapturedFrame& frame : frames)
  {
    EXPECT_EQ(frame.status, "ok");
    EXPECT_FALSE(frame.tip_Marker.has_value());
  }
  EXPECT_TRUE(toSamples(frames).empty()) << "without tracking there are no samples";
}

TEST(CaptureSamples, ToSamples_PassesEverythingOn)
{
  const SimulatedSession session(3);
  std::vector<CapturedFrame> frames = session.captured();
  frames[1].status = "several_balls";
  const std::vector<HandEyeSample> samples = toSamples(frames, 1);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[1].frame, 2);
  EXPECT_EQ(samples[1].eye, 1);
  EXPECT_EQ(samples[1].tip_Marker, *frames[2].tip_Marker);
  EXPECT_EQ(samples[1].ball_Image, frames[2].ball.ball_Image);
  EXPECT_EQ(samples[1].ray_Eye, frames[2].ball.ray_Camera);
  EXPECT_NEAR(samples[1].sigmaPx, 0.1, 1e-12);
}
