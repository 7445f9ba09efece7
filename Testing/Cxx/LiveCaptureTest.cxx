// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LiveCapture.h"
#include "IoTestSupport.h"
#include "SimulatedRoom.h"

namespace
{

using namespace handeye;
using namespace handeye::devices;
using handeye::io::test::TemporaryFolder;
using simulation::RoomMotion;
using simulation::RoomOptions;
using simulation::SimulatedRoom;
using Status = LiveCapture::Step::Status;

/// The room's stream through pairing, as a server would deliver it: poses at 100 Hz, 10 frames a second.
std::vector<PairedFrame> framesOf(const SimulatedRoom& room, double seconds, double latencySec, int posesAFrame = 10)
{
  FramePairingOptions options;
  options.latencySec = latencySec;
  FramePairing pairing(options);
  std::vector<PairedFrame> frames;
  for (int i = 0; i < int(100 * seconds); ++i)
  {
    const double timeSec = 0.01 * i;
    for (const simulation::RoomPose& pose : room.track(timeSec))
    {
      TrackedPose tracked;
      tracked.isValid = pose.isValid;
      tracked.transform = pose.transform;
      pairing.add({ pose.name, 100 + timeSec, 0, {}, tracked });
    }
    if (i % posesAFrame == 0)
    {
      VideoFrame video;
      video.image = room.picture(timeSec);
      pairing.add({ "Video", 100 + timeSec, 0, {}, video });
    }
    while (std::optional<PairedFrame> frame = pairing.take())
    {
      frames.push_back(std::move(*frame));
    }
  }
  return frames;
}

RoomOptions fivePlaces()
{
  RoomOptions options;
  options.motion = RoomMotion::Placements;
  options.placeCount = 5;
  return options;
}

TEST(LiveCapture, EachPlaceIsStoredOnce_WhereItIs)
{
  const TemporaryFolder folder;
  io::Session session = io::Session::create(folder.path() / "s");
  const SimulatedRoom room(fivePlaces());
  LiveCapture capture(room.options().camera, room.options().tip_Stylus, session);
  int samePlace = 0;
  for (const PairedFrame& frame : framesOf(room, 26, 0))  // twice around
  {
    const LiveCapture::Step step = capture.add(frame);
    samePlace += step.status == Status::SamePlace ? 1 : 0;
    if (step.status == Status::Accepted)
    {
      const double timeSec = frame.image.timeSec - 100;
      EXPECT_LT(
        (room.truth(timeSec).ball_Camera - room.truth(timeSec - 0.1).ball_Camera).norm(), 1.0);  // of 100 mm/s and more on its way
      EXPECT_EQ(session.samples().count(step.sampleId), 1U);
    }
  }
  EXPECT_EQ(session.samples().size(), 5U);
  EXPECT_GT(samePlace, 50);
  for (const auto& [id, sample] : session.samples())
  {
    const Eigen::Vector3d ball_Camera = room.truth(sample.timeSec - 100).ball_Camera;
    const Eigen::Vector2d expected = room.options().camera.project(ball_Camera).point_Image;
    EXPECT_NEAR(sample.detection.at("ball_Image_Px")[0].get<double>(), expected.x(), 0.5);
    EXPECT_EQ(sample.transforms.at("StylusToTracker").status, "OK");
    EXPECT_GT(sample.pairing.at("poses").at("MarkerToTracker").at("gapSec").get<double>(), -1e-9);
  }
}

TEST(LiveCapture, ImageOfAnotherSizeOrInGrey_IsSaidAndNotTaken)
{
  const TemporaryFolder folder;
  io::Session session = io::Session::create(folder.path() / "s");
  const SimulatedRoom room(fivePlaces());
  std::vector<PairedFrame> frames = framesOf(room, 4, 0);
  for (const cv::Mat& wrong : { cv::Mat(24, 32, CV_8UC3, cv::Scalar::all(0)),
         cv::Mat(room.options().camera.height(), room.options().camera.width(), CV_8UC1, cv::Scalar::all(0)) })
  {
    LiveCapture capture(room.options().camera, room.options().tip_Stylus, session);
    int refused = 0;
    for (PairedFrame& frame : frames)
    {
      VideoFrame video;
      video.image = wrong;
      frame.image.content = video;
      refused += capture.add(frame).status == Status::WrongImage ? 1 : 0;
    }
    EXPECT_GT(refused, 0);
  }
  EXPECT_TRUE(session.samples().empty());
}

TEST(LiveCapture, LatencyOfThePairing_IsKeptWithTheSample)
{
  PairedFrame frame;
  frame.latencySec = -0.04;
  EXPECT_EQ(toSessionSample(frame).pairing.at("latencySec"), -0.04);
  const TemporaryFolder folder;
  const SimulatedRoom room(fivePlaces());
  EXPECT_EQ(framesOf(room, 1, -0.04).at(0).latencySec, -0.04);
}

TEST(LiveCapture, SessionThatIsContinued_KnowsItsPlaces)
{
  const TemporaryFolder folder;
  const SimulatedRoom room(fivePlaces());
  const std::vector<PairedFrame> frames = framesOf(room, 14, 0);
  for (int round = 0; round < 2; ++round)
  {
    io::Session session = io::Session::openOrCreate(folder.path() / "s");
    LiveCapture capture(room.options().camera, room.options().tip_Stylus, session);
    int accepted = 0;
    for (const PairedFrame& frame : frames)
    {
      accepted += capture.add(frame).status == Status::Accepted ? 1 : 0;
    }
    EXPECT_EQ(accepted, round == 0 ? 5 : 0);
  }
}

/// Software rendering, a slow network: three pictures a second are enough for balls that are held still.
TEST(LiveCapture, SlowVideo_IsCapturedToo)
{
  const TemporaryFolder folder;
  io::Session session = io::Session::create(folder.path() / "s");
  const SimulatedRoom room(fivePlaces());
  LiveCapture capture(room.options().camera, room.options().tip_Stylus, session);
  for (const PairedFrame& frame : framesOf(room, 14, 0, 33))
  {
    (void)capture.add(frame);
  }
  EXPECT_EQ(session.samples().size(), 5U);
}

TEST(LiveCapture, SampleThatWasSetAside_LeavesItsPlaceToAnother)
{
  const TemporaryFolder folder;
  const SimulatedRoom room(fivePlaces());
  const std::vector<PairedFrame> frames = framesOf(room, 14, 0);
  io::Session session = io::Session::create(folder.path() / "s");
  LiveCapture capture(room.options().camera, room.options().tip_Stylus, session);
  const auto takeAll = [&]
  {
    int accepted = 0;
    for (const PairedFrame& frame : frames)
    {
      accepted += capture.add(frame).status == Status::Accepted ? 1 : 0;
    }
    return accepted;
  };
  EXPECT_EQ(takeAll(), 5);
  EXPECT_EQ(takeAll(), 0);
  session.setExcluded(session.samples().begin()->first, true);
  EXPECT_EQ(takeAll(), 1);
  EXPECT_EQ(session.samples().size(), 6U);
}

TEST(LiveCapture, HiddenTool_IsSaidByName)
{
  const TemporaryFolder folder;
  io::Session session = io::Session::create(folder.path() / "s");
  RoomOptions options = fivePlaces();
  options.dropOutShare = 0.99;
  const SimulatedRoom room(options);
  LiveCapture capture(options.camera, options.tip_Stylus, session);
  int hidden = 0;
  for (const PairedFrame& frame : framesOf(room, 4, 0))
  {
    const LiveCapture::Step step = capture.add(frame);
    hidden += step.status == Status::NoPose ? 1 : 0;
    EXPECT_TRUE(step.status != Status::NoPose || step.message.find("ToTracker") != std::string::npos);
  }
  EXPECT_GT(hidden, 20);
  EXPECT_TRUE(session.samples().empty());
}

/// A delay that is known and applied gives the places of the truth; one that is ignored gives frames paired with later poses.
TEST(LiveCapture, Latency_IsAppliedToMovingFrames)
{
  RoomOptions options = fivePlaces();
  options.motion = RoomMotion::Free;
  options.videoDelaySec = 0.08;
  options.dropOutShare = 0;
  const SimulatedRoom room(options);
  double worst[2] = { 0, 0 };
  for (int isApplied = 0; isApplied < 2; ++isApplied)
  {
    for (const PairedFrame& frame : framesOf(room, 2, isApplied != 0 ? -0.08 : 0))
    {
      if (!frame.poses.at("StylusToTracker").isUsable() || !frame.poses.at("MarkerToTracker").isUsable())
      {
        continue;
      }
      const Eigen::Vector3d tip_Tracker = frame.poses.at("StylusToTracker").transform * options.tip_Stylus;
      const Eigen::Vector3d tip_Marker = frame.poses.at("MarkerToTracker").transform.inverse() * tip_Tracker;
      const Eigen::Vector3d tip_Camera = options.markerToCamera * tip_Marker;
      worst[isApplied] = std::max(worst[isApplied], (tip_Camera - room.truth(frame.image.timeSec - 100).ball_Camera).norm());
    }
  }
  EXPECT_GT(worst[0], 10);
  EXPECT_LT(worst[1], 1.5);  // tracking noise of 0.12 mm and 0.03 deg at 190 mm
}

}  // namespace
