// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OverlayPose.h"

#include "GeometryMatchers.h"
#include "IoTestSupport.h"
#include "SequenceMetafileWriter.h"
#include "Simulation.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace
{

using namespace handeye;
using namespace handeye::test;

struct Scene
{
  OverlayTransforms transforms{ typicalMarkerToCamera(), makeRigid({ 0.4, -0.2, 1.3 }, { 70, 12, -33 }) };
  Eigen::Isometry3d markerToTracker = makeRigid({ 0.1, 0.7, -0.2 }, { 20, -40, -1400 });
  Eigen::Isometry3d phantomToTracker = makeRigid({ -0.5, 0.3, 2 }, { -90, 10, -1250 });

  /// As a person would take it from frame to frame.
  Eigen::Vector3d toCamera(const Eigen::Vector3d& point_Model) const
  {
    const Eigen::Vector3d point_Phantom = transforms.modelToPhantom * point_Model;
    const Eigen::Vector3d point_Tracker = phantomToTracker * point_Phantom;
    const Eigen::Vector3d point_Marker = markerToTracker.inverse() * point_Tracker;
    return transforms.markerToCamera * point_Marker;
  }
};

/// Frame 0 is good; 1 has lost the phantom, 2 the marker, 3 both; in 4 the phantom is not mentioned.
io::Recording writeRecording(const io::test::TemporaryFolder& folder, const Scene& scene)
{
  const std::filesystem::path path = folder.path() / "tracking.igs.mha";
  io::SequenceMetafileWriter writer(path, { false, true, {} });
  for (int frame = 0; frame < 5; ++frame)
  {
    io::SequenceFrame fields;
    fields.transforms["MarkerToTracker"] = { scene.markerToTracker.matrix(), frame == 2 || frame == 3 ? "INVALID" : "OK" };
    if (frame != 4)
    {
      fields.transforms["PhantomToTracker"] = { scene.phantomToTracker.matrix(), frame == 1 || frame == 3 ? "INVALID" : "OK" };
    }
    writer.append(fields);
  }
  writer.close();
  return io::Recording::open(path);
}

}  // namespace

TEST(OverlayPose, KnownPoint_IsTakenWhereItBelongs)
{
  const Scene scene;
  const Eigen::Vector3d point_Model(12, 14, 28);
  const Eigen::Isometry3d modelToCamera = toModelToCamera(scene.transforms, scene.markerToTracker, scene.phantomToTracker);
  EXPECT_TRUE(pointNear(modelToCamera * point_Model, scene.toCamera(point_Model), 1e-9));
}

TEST(OverlayPose, StylusTip_IsTakenWhereItBelongs)
{
  const Scene scene;
  const Eigen::Isometry3d stylusToTracker = makeRigid({ 1.2, 0.1, -0.6 }, { 15, 60, -1300 });
  const Eigen::Isometry3d stylusTipToStylus = makeRigid({ 0.2, 0.3, 0 }, { 1, -2, -158 });
  const Eigen::Isometry3d stylusTipToCamera =
    toStylusTipToCamera(scene.transforms.markerToCamera, scene.markerToTracker, stylusToTracker, stylusTipToStylus);
  const Eigen::Vector3d point_StylusTip(3, 4, 25);
  const Eigen::Vector3d point_Stylus = stylusTipToStylus * point_StylusTip;
  const Eigen::Vector3d point_Tracker = stylusToTracker * point_Stylus;
  const Eigen::Vector3d point_Marker = scene.markerToTracker.inverse() * point_Tracker;
  EXPECT_TRUE(pointNear(stylusTipToCamera * point_StylusTip, scene.transforms.markerToCamera * point_Marker, 1e-9));
}

TEST(OverlayPose, TrackedFrame_HasAPose)
{
  const io::test::TemporaryFolder folder;
  const Scene scene;
  const OverlayPose pose = overlayPose(writeRecording(folder, scene), 0, "MarkerToTracker", "PhantomToTracker", scene.transforms);
  ASSERT_TRUE(pose.isUsable()) << pose.message;
  EXPECT_EQ(pose.status, "ok");
  EXPECT_EQ(pose.message, "");
  EXPECT_TRUE(pointNear(*pose.modelToCamera * Eigen::Vector3d(1, 2, 3), scene.toCamera({ 1, 2, 3 }), 1e-9));
}

TEST(OverlayPose, LostTools_AreNamedAndGiveNoPose)
{
  const io::test::TemporaryFolder folder;
  const Scene scene;
  const io::Recording recording = writeRecording(folder, scene);
  const std::vector<std::string> expected = { "ok", "phantom_invalid", "marker_invalid", "marker_invalid", "phantom_missing" };
  for (int frame = 1; frame < recording.frameCount(); ++frame)
  {
    const OverlayPose pose = overlayPose(recording, frame, "MarkerToTracker", "PhantomToTracker", scene.transforms);
    EXPECT_FALSE(pose.isUsable());
    EXPECT_EQ(pose.status, expected[std::size_t(frame)]);
    EXPECT_TRUE(says(pose.message, { frame == 4 ? "PhantomToTracker" : "INVALID" }));
  }
  EXPECT_EQ(overlayPose(recording, 0, "HeadToTracker", "PhantomToTracker", scene.transforms).status, "marker_missing");
  EXPECT_THROW(
    static_cast<void>(overlayPose(recording, 5, "MarkerToTracker", "PhantomToTracker", scene.transforms)), std::out_of_range);
}
