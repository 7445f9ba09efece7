// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LiveOverlay.h"

#include "RigidTransform.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>

namespace
{

using namespace handeye;

Eigen::Isometry3d pose(const Eigen::Vector3d& rotationVector, const Eigen::Vector3d& translation)
{
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = rotationFromVector(rotationVector);
  result.translation() = translation;
  return result;
}

OverlayTransforms rig()
{
  return { pose({ 0.2, -0.4, 1.1 }, { 10, -30, 5 }), pose({ -0.7, 0.1, 0.3 }, { 4, 8, -60 }) };
}

Eigen::Isometry3d markerAt(double timeSec)
{
  return pose({ 0.1, 0.02 * timeSec, 0 }, { 100 + 20 * timeSec, 0, -1200 });
}

Eigen::Isometry3d phantomAt(double timeSec)
{
  return pose({ 0, 0, 0.5 }, { -40, 12 * timeSec, -1100 });
}

/// Both tools from 0 to `untilSec`, 50 poses a second.
void feed(LiveOverlay& overlay, double fromSec, double untilSec, bool phantomIsValid = true)
{
  for (int i = 0; fromSec + 0.02 * i < untilSec; ++i)
  {
    const double timeSec = fromSec + 0.02 * i;
    overlay.addMarker(timeSec, markerAt(timeSec));
    overlay.addPhantom(timeSec, phantomAt(timeSec), phantomIsValid);
  }
}

}  // namespace

TEST(LiveOverlay, Frame_HasThePosesOfItsTimePlusTheLatency)
{
  LiveOverlayOptions options;
  options.latencySec = -0.035;
  LiveOverlay overlay(rig(), options);
  feed(overlay, 0, 1);
  const LiveOverlayPose shown = overlay.at(0.805);
  ASSERT_TRUE(shown.isUsable()) << shown.message;
  const Eigen::Isometry3d expected = toModelToCamera(rig(), markerAt(0.77), phantomAt(0.77));
  EXPECT_LT((shown.modelToCamera->matrix() - expected.matrix()).norm(), 1e-3);  // straight between two poses
  EXPECT_EQ(shown.opacity, 1);
  EXPECT_EQ(shown.message, "");
}

TEST(LiveOverlay, HiddenPhantom_FadesThenGoes_AndComesBack)
{
  LiveOverlay overlay(rig());
  feed(overlay, 0, 1);
  ASSERT_TRUE(overlay.at(0.97).isUsable());
  feed(overlay, 1, 3, false);
  const LiveOverlayPose fading = overlay.at(1.35);
  ASSERT_TRUE(fading.isUsable());
  EXPECT_GT(fading.opacity, 0);
  EXPECT_LT(fading.opacity, 1);
  EXPECT_NE(fading.message.find("phantom"), std::string::npos);
  EXPECT_LT((fading.modelToCamera->matrix() - toModelToCamera(rig(), markerAt(0.97), phantomAt(0.97)).matrix()).norm(), 1e-3);
  const LiveOverlayPose gone = overlay.at(2);
  EXPECT_FALSE(gone.isUsable());
  EXPECT_EQ(gone.opacity, 0);
  EXPECT_EQ(gone.status, PoseAge::Status::Gone);
  feed(overlay, 3, 3.5);
  const LiveOverlayPose back = overlay.at(3.4);
  ASSERT_TRUE(back.isUsable());
  EXPECT_EQ(back.opacity, 1);
  EXPECT_EQ(back.message, "");
}

/// Each tool by itself was seen a moment ago, but the model was placed when both were seen: it must not stay there.
TEST(LiveOverlay, ToolsHiddenInTurn_FadeAsIfOneWereHidden)
{
  LiveOverlay overlay(rig());
  feed(overlay, 0, 1);
  ASSERT_TRUE(overlay.at(0.97).isUsable());
  for (int i = 0; i < 100; ++i)
  {
    const double timeSec = 1 + 0.02 * i;
    const bool isPhantomsTurn = i / 5 % 2 == 0;
    overlay.addMarker(timeSec, markerAt(timeSec), !isPhantomsTurn);
    overlay.addPhantom(timeSec, phantomAt(timeSec), isPhantomsTurn);
    const LiveOverlayPose shown = overlay.at(timeSec);
    if (timeSec > 1.8)
    {
      EXPECT_FALSE(shown.isUsable()) << timeSec;
      EXPECT_NE(shown.message.find("at once"), std::string::npos) << shown.message;
    }
    else if (timeSec > 1.3)
    {
      EXPECT_LT(shown.opacity, 1) << timeSec;
    }
  }
}

TEST(LiveOverlay, ClockThatWasSet_BeginsAnew)
{
  LiveOverlay overlay(rig());
  feed(overlay, 1000, 1001);
  ASSERT_TRUE(overlay.at(1000.97).isUsable());
  overlay.addMarker(5, markerAt(5));
  EXPECT_FALSE(overlay.at(5).isUsable()) << "the phantom was not seen since";
  feed(overlay, 5.02, 6);
  const LiveOverlayPose shown = overlay.at(5.9);
  ASSERT_TRUE(shown.isUsable()) << shown.message;
  EXPECT_LT((shown.modelToCamera->matrix() - toModelToCamera(rig(), markerAt(5.9), phantomAt(5.9)).matrix()).norm(), 1e-3);
}

TEST(LiveOverlay, StreamThatStops_FadesToo)
{
  LiveOverlay overlay(rig());
  feed(overlay, 0, 1);
  ASSERT_TRUE(overlay.at(0.98).isUsable());
  EXPECT_LT(overlay.at(1.4).opacity, 1);
  EXPECT_FALSE(overlay.at(2).isUsable());
  EXPECT_NE(overlay.at(2).message.find("camera's marker"), std::string::npos);
}

TEST(LiveOverlay, Smoothing_ReportsItsDelayAndCalms)
{
  std::mt19937 random(2);
  std::normal_distribution<double> mm(0, 0.3);
  LiveOverlayOptions options;
  options.smooth = true;
  LiveOverlay smooth(rig(), options), raw(rig());
  double smoothMm = 0, rawMm = 0;
  const Eigen::Isometry3d truth = toModelToCamera(rig(), markerAt(0), phantomAt(0));
  for (int i = 0; i < 400; ++i)
  {
    Eigen::Isometry3d phantom = phantomAt(0);
    phantom.translation() += Eigen::Vector3d(mm(random), mm(random), mm(random));
    for (LiveOverlay* overlay : { &smooth, &raw })
    {
      Eigen::Isometry3d marker = markerAt(0);
      marker.translation().x() += 1e-9 * i;  // a tracker that has stopped repeats itself bit by bit
      overlay->addMarker(0.03 * i, marker);
      overlay->addPhantom(0.03 * i, phantom);
    }
    const LiveOverlayPose calm = smooth.at(0.03 * i), jumping = raw.at(0.03 * i);
    ASSERT_TRUE(calm.isUsable() && jumping.isUsable()) << calm.message;
    if (i > 100)
    {
      EXPECT_GT(calm.delaySec, 0);
      EXPECT_EQ(jumping.delaySec, 0);
      smoothMm += (calm.modelToCamera->translation() - truth.translation()).squaredNorm();
      rawMm += (jumping.modelToCamera->translation() - truth.translation()).squaredNorm();
    }
  }
  EXPECT_LT(smoothMm, 0.25 * rawMm);
}

TEST(LiveOverlay, NothingSeen_ShowsNothingAndSaysSo)
{
  LiveOverlay overlay(rig());
  EXPECT_FALSE(overlay.at(0).isUsable());
  EXPECT_EQ(overlay.at(0).status, PoseAge::Status::NeverSeen);
  EXPECT_NE(overlay.at(0).message, "");
}

TEST(LiveOverlay, NeverSeenTogether_ShowsNothingAndSaysSo)
{
  LiveOverlay overlay(rig());
  overlay.addMarker(0, markerAt(0));
  EXPECT_FALSE(overlay.at(0).isUsable());
  overlay.addMarker(0.2, markerAt(0), false);
  overlay.addPhantom(0.1, phantomAt(0));
  const LiveOverlayPose pose = overlay.at(0.12);
  EXPECT_FALSE(pose.isUsable());
  EXPECT_EQ(pose.message, "the phantom and the camera's marker have not been seen together yet");
}

TEST(LiveOverlay, Nonsense_IsRefused)
{
  LiveOverlay overlay(rig());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(overlay.at(nan)), std::invalid_argument);
  EXPECT_THROW(overlay.addMarker(nan, markerAt(0)), std::invalid_argument);
  LiveOverlayOptions options;
  options.latencySec = nan;
  EXPECT_THROW(LiveOverlay(rig(), options), std::invalid_argument);
}
