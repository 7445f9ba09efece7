// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TouchedLandmarks.h"

#include "CaptureSimulation.h"
#include "GeometryMatchers.h"
#include "LandmarkRegistration.h"
#include "PivotSimulation.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace handeye;
using namespace handeye::test;
using handeye::io::test::expectFileError;
using handeye::io::test::TemporaryFolder;

namespace
{

using Points = std::vector<Eigen::Vector3d>;
using Status = TouchedLandmarksResult::Status;

/// A stream that PLUS recorded with an electromagnetic tracker: the stylus lies still, is pivoted on the eight landmarks of an
/// fCal 2.0 phantom in turn, and lies still again.
io::Recording plusRecording()
{
  return io::Recording::open(std::filesystem::path(HANDEYE_TEST_DATA_DIR) / "plus_landmarks.igs.mha");
}

/// Where the published description of the fCal 2.0 phantom has its landmarks #1 to #8 (mm).
const Points FcalLandmarks = { { 104.3, 5, 20 }, { 104.3, 45, 20 }, { 104.3, 45, 0 }, { 104.3, -5, 0 }, { -34.3, 45, 15 },
  { -34.3, -5, 20 }, { -34.3, -5, 0 }, { -34.3, 45, 0 } };

/// About which the stylus of that recording turns, as a pivot calibration of each landmark's frames on its own gives it (median).
const Eigen::Vector3d PlusTip_Stylus = { 109.6, 6.8, 2.8 };

const Points Landmarks = { { 0, 0, 0 }, { 40, 3, -2 }, { 5, 35, 1 }, { 12, 14, 28 } };

/// A stream of a stylus that touches landmarks of a phantom, 20 samples a second.
struct TouchSimulation
{
  PivotSimulation stylus;
  Eigen::Isometry3d phantomToTracker = makeRigid({ 0.3, 0.2, -0.5 }, { 40, -60, -900 });
  std::vector<io::SequenceFrame> frames;
  Random random{ 1 };

  void add(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& tip_Phantom)
  {
    stylus.pivot_Tracker = phantomToTracker * tip_Phantom;
    io::SequenceFrame frame;
    frame.timestampSec = 0.05 * double(frames.size());
    frame.transforms["StylusToTracker"] = { stylus.pose(rotation, random).matrix(), "OK" };
    frame.transforms["PhantomToTracker"] = { phantomToTracker.matrix(), "OK" };
    frames.push_back(frame);
  }

  /// The tip on a landmark for so many samples; the stylus leant by up to `tilt` (rad) in all directions.
  void touch(const Eigen::Vector3d& tip_Phantom, int samples, double tilt)
  {
    for (int i = 0; i < samples; ++i)
    {
      const double phase = 0.3 * i;
      add(rotationFromVector({ tilt * std::cos(phase), tilt * std::sin(1.37 * phase), 0.2 * tilt * std::sin(phase) }), tip_Phantom);
    }
  }

  /// On the way from one place to another.
  void travel(const Eigen::Vector3d& from, const Eigen::Vector3d& to)
  {
    for (int i = 1; i < 15; ++i)
    {
      const Eigen::Vector3d lifted = from + (i / 15.0) * (to - from) + Eigen::Vector3d(0, 0, 60 * std::sin(i * EIGEN_PI / 15));
      add(rotationFromVector({ 0.1 * std::sin(i), 0.1 * std::cos(i), 0 }), lifted);
    }
  }

  void touchAll(const Points& points, int samples, double tilt)
  {
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      if (i > 0)
      {
        travel(points[i - 1], points[i]);
      }
      touch(points[i], samples, tilt);
    }
  }

  io::Recording write(const TemporaryFolder& folder) const
  {
    const auto path = folder.path() / "touching.igs.mha";
    SimulatedSession::writeTracking(path, frames);
    return io::Recording::open(path);
  }
};

}  // namespace

TEST(TouchedLandmarks, PlusRecording_GivesItsEightLandmarksInOrder)
{
  const TouchedLandmarksResult result = landmarksFromRecording(plusRecording(), PlusTip_Stylus);
  ASSERT_EQ(result.status, Status::Ok) << result.message;
  EXPECT_EQ(result.phantomToTracker, "ReferenceToTracker");
  ASSERT_EQ(result.landmarks.size(), 8U);
  EXPECT_EQ(result.setAside.size(), 2U) << "the stylus on the table, before and after";
  for (std::size_t i = 0; i < 8; ++i)
  {
    const Rest& rest = result.landmarks[i].rest;
    EXPECT_EQ(rest.kind, Rest::Kind::Pivoted);
    EXPECT_GT(rest.endSec - rest.beginSec, 4) << i;
    EXPECT_LT(rest.rmsMm, 1) << i;
    EXPECT_TRUE(i == 0 || rest.firstSample > result.landmarks[i - 1].rest.lastSample);
  }
  ASSERT_TRUE(result.tipInRecording_Stylus);
  EXPECT_TRUE(pointNear(*result.tipInRecording_Stylus, PlusTip_Stylus, 0.6));
}

TEST(TouchedLandmarks, PlusRecording_FitsThePublishedPhantomInThatOrder)
{
  const TouchedLandmarksResult result = landmarksFromRecording(plusRecording(), PlusTip_Stylus);
  const LandmarkRegistrationResult registration = registerLandmarks(FcalLandmarks, result.points_Phantom());
  ASSERT_TRUE(registration.isUsable()) << registration.message;
  // The two side walls come out 135.9 mm apart in place of 138.6: the tip is a ball that does not reach the bottom of the holes.
  EXPECT_LT(registration.rmsMm, 1.6);
  // Within a wall, the holes are on a grid of 5 mm.
  for (std::size_t i = 0; i < 8; ++i)
  {
    for (std::size_t j = i < 4 ? 0 : 4; j < i; ++j)
    {
      const double expected = (FcalLandmarks[i] - FcalLandmarks[j]).norm();
      EXPECT_NEAR((result.landmarks[i].point_Phantom - result.landmarks[j].point_Phantom).norm(), expected, 0.6) << i << " " << j;
    }
  }
}

TEST(TouchedLandmarks, PlusRecordingWithATipThatIsALittleOff_StillGivesAllEight)
{
  Random random(3);
  for (int run = 0; run < 12; ++run)
  {
    const Eigen::Vector3d tip = PlusTip_Stylus + (run < 6 ? 1.0 : 2.0) * random.direction();
    const TouchedLandmarksResult result = landmarksFromRecording(plusRecording(), tip);
    EXPECT_TRUE(result.isUsable()) << result.message;
    EXPECT_EQ(result.landmarks.size(), 8U) << tip.transpose();
    EXPECT_EQ(result.warnings.empty(), (*result.tipInRecording_Stylus - tip).norm() <= 1);
  }
}

TEST(TouchedLandmarks, PlusRecordingWithoutATip_FindsItByItself)
{
  const TouchedLandmarksResult result = landmarksFromRecording(plusRecording(), std::nullopt);
  ASSERT_EQ(result.status, Status::Ok) << result.message;
  EXPECT_TRUE(pointNear(result.tip_Stylus, PlusTip_Stylus, 1));
  EXPECT_EQ(result.landmarks.size(), 8U);
}

TEST(TouchedLandmarks, TipOfAnotherStylus_IsRefusedWithTheOneInTheRecording)
{
  for (const Eigen::Vector3d& tip : { Eigen::Vector3d(0, 0, -158), Eigen::Vector3d(109, 15, 3) })
  {
    const TouchedLandmarksResult result = landmarksFromRecording(plusRecording(), tip);
    EXPECT_EQ(result.status, Status::WrongTip) << result.message;
    EXPECT_TRUE(says(result.message, { "turns about (109.", "mm from the tip that was given" }));
  }
}

TEST(TouchedLandmarks, ZeroTipOfAStylusThatTurnsElsewhere_IsWarnedOf)
{
  const TouchedLandmarksResult result = landmarksFromRecording(plusRecording(), Eigen::Vector3d::Zero());
  ASSERT_EQ(result.status, Status::Ok) << result.message;
  EXPECT_EQ(result.landmarks.size(), 8U);
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_TRUE(says(result.warnings[0], { "turns about (109." }));
  // Where the poses are the tip's own, zero is right.
  TouchSimulation touching;
  touching.stylus.tip_Stylus.setZero();
  touching.touchAll(Landmarks, 80, 0.4);
  const TemporaryFolder folder;
  const TouchedLandmarksResult own = landmarksFromRecording(touching.write(folder), Eigen::Vector3d(0, 0, 0));
  EXPECT_TRUE(own.warnings.empty());
  EXPECT_TRUE(own.tip_Stylus.isZero(0));
  EXPECT_EQ(own.landmarks.size(), 4U) << own.message;
}

TEST(TouchedLandmarks, HeldStill_GivesThePoints)
{
  TouchSimulation touching;
  touching.touchAll(Landmarks, 40, 0);
  const TemporaryFolder folder;
  const TouchedLandmarksResult result = landmarksFromRecording(touching.write(folder), touching.stylus.tip_Stylus);
  ASSERT_EQ(result.status, Status::Ok) << result.message;
  EXPECT_EQ(result.phantomToTracker, "PhantomToTracker");
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_FALSE(result.tipInRecording_Stylus) << "a stylus that is only held does not say where its tip is";
  ASSERT_EQ(result.landmarks.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i)
  {
    EXPECT_EQ(result.landmarks[i].rest.kind, Rest::Kind::Held);
    EXPECT_TRUE(pointNear(result.landmarks[i].point_Phantom, Landmarks[i], 0.15)) << i;
    EXPECT_NEAR(result.landmarks[i].rest.rmsMm, std::hypot(0.12 * std::sqrt(3.0), 158 * 0.025 * Degree * std::sqrt(2.0)), 0.08);
  }
}

TEST(TouchedLandmarks, Pivoted_GivesThePointsAndSetsOthersAside)
{
  TouchSimulation touching;
  touching.touch({ 200, 0, 0 }, 40, 0);
  touching.travel({ 200, 0, 0 }, Landmarks[0]);
  touching.touchAll(Landmarks, 80, 0.4);
  touching.travel(Landmarks.back(), { -150, 30, 0 });
  touching.touch({ -150, 30, 0 }, 40, 0);
  const TemporaryFolder folder;
  const TouchedLandmarksResult result = landmarksFromRecording(touching.write(folder), touching.stylus.tip_Stylus);
  ASSERT_EQ(result.landmarks.size(), 4U) << result.message;
  ASSERT_EQ(result.setAside.size(), 2U);
  EXPECT_TRUE(pointNear(result.setAside[0].point_Phantom, Eigen::Vector3d(200, 0, 0), 0.2));
  for (std::size_t i = 0; i < 4; ++i)
  {
    EXPECT_TRUE(pointNear(result.landmarks[i].point_Phantom, Landmarks[i], 0.15)) << i;
  }
  ASSERT_TRUE(result.tipInRecording_Stylus);
  EXPECT_TRUE(pointNear(*result.tipInRecording_Stylus, touching.stylus.tip_Stylus, 0.5));
}

TEST(TouchedLandmarks, NothingTouched_IsReported)
{
  TouchSimulation touching;
  for (int i = 0; i < 6; ++i)
  {
    touching.travel({ 0, 0, 0 }, { 100, 40, 0 });
  }
  const TemporaryFolder folder;
  const TouchedLandmarksResult result = landmarksFromRecording(touching.write(folder), touching.stylus.tip_Stylus);
  EXPECT_EQ(result.status, Status::NoRests);
  EXPECT_TRUE(says(result.message, { "rests nowhere", "1.5 mm", "1.0 s" }));
}

TEST(TouchedLandmarks, NoMarkerOnThePhantom_IsWarnedOf)
{
  TouchSimulation touching;
  touching.touchAll(Landmarks, 40, 0);
  for (io::SequenceFrame& frame : touching.frames)
  {
    frame.transforms.erase("PhantomToTracker");
  }
  const TemporaryFolder folder;
  const TouchedLandmarksResult result = landmarksFromRecording(touching.write(folder), touching.stylus.tip_Stylus);
  ASSERT_EQ(result.landmarks.size(), 4U) << result.message;
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_TRUE(says(result.warnings[0], { "no marker", "Tracker" }));
  EXPECT_TRUE(pointNear(result.landmarks[1].point_Phantom, touching.phantomToTracker * Landmarks[1], 0.15));
}

TEST(TouchedLandmarks, NoTimestamps_AreWarnedOf)
{
  TouchSimulation touching;
  touching.touchAll(Landmarks, 40, 0);
  for (io::SequenceFrame& frame : touching.frames)
  {
    frame.timestampSec.reset();
  }
  const TemporaryFolder folder;
  const TouchedLandmarksResult result = landmarksFromRecording(touching.write(folder), touching.stylus.tip_Stylus);
  EXPECT_EQ(result.landmarks.size(), 4U) << result.message;
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_TRUE(says(result.warnings[0], { "no timestamps", "20 frames a second" }));
}

TEST(TouchedLandmarks, UnknownTransforms_ListThoseThatExist)
{
  TouchedLandmarksOptions options;
  options.stylusToTracker = "PointerToTracker";
  expectFileError([&] { (void)landmarksFromRecording(plusRecording(), PlusTip_Stylus, options); },
    { "plus_landmarks", "PointerToTracker", "StylusToTracker" });
  options = {};
  options.phantomToTracker = "BoneToTracker";
  expectFileError([&] { (void)landmarksFromRecording(plusRecording(), PlusTip_Stylus, options); }, { "BoneToTracker" });
}
