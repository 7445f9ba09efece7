// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TipTrack.h"

#include "Simulation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace handeye;

PoseTrackOptions longHistory()
{
  PoseTrackOptions options;
  options.historySec = 100;
  options.maximumRepeatSec = 0;  // the marker stands still
  return options;
}

/// A stylus that is carried along a smooth way, seen 50 times a second; the marker stands still, turned and moved.
struct Way
{
  Eigen::Isometry3d markerToTracker{ Eigen::Translation3d(30, -20, 400) *
    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()) };
  PoseTrack marker{ longHistory() }, stylus{ longHistory() };

  static Eigen::Vector3d tip_Tracker(double timeSec)
  {
    return { 80 * std::sin(3 * timeSec), 50 * std::cos(2 * timeSec), 300 + 40 * timeSec };
  }

  explicit Way(double noiseMm, double spacingSec = 0.02, double hiddenFromSec = 1e9)
  {
    test::Random random(5);
    for (int i = 0; i < 200; ++i)
    {
      const double timeSec = i * spacingSec;
      const Eigen::Vector3d noise(random.normal(noiseMm), random.normal(noiseMm), random.normal(noiseMm));
      const bool isSeen = timeSec < hiddenFromSec || timeSec > hiddenFromSec + 0.05;
      marker.add(timeSec, markerToTracker);
      stylus.add(timeSec, Eigen::Isometry3d(Eigen::Translation3d(tip_Tracker(timeSec) + noise)), isSeen);
    }
  }

  TipTrack track() const { return TipTrack(marker, stylus, Eigen::Vector3d::Zero()); }
  Eigen::Vector3d tip_Marker(double timeSec) const { return markerToTracker.inverse() * tip_Tracker(timeSec); }
};

TEST(TipTrack, BetweenMeasurements_FollowsACurvedWay)
{
  const Way way(0);
  const TipTrack track = way.track();
  for (double timeSec : { 0.511, 1.03, 2.0, 2.345 })
  {
    const auto place = track.at(timeSec);
    ASSERT_TRUE(place);
    // Straight between neighbours it would be off by up to 0.036 mm.
    EXPECT_LT((place->tip_Marker - way.tip_Marker(timeSec)).norm(), 1e-4) << timeSec;
  }
}

TEST(TipTrack, NoiseShare_IsThatOfTheWeights)
{
  const TipTrack track = Way(0).track();
  EXPECT_DOUBLE_EQ(track.at(50 * 0.02)->noiseShare, 1);
  EXPECT_NEAR(track.at(50 * 0.02 + 0.01)->noiseShare, 2 * (81 + 1) / 256.0, 1e-6);  // 9/16, 9/16, -1/16, -1/16
}

TEST(TipTrack, Noise_IsThatOfTheTrackerAndNotTheMotion)
{
  EXPECT_NEAR(Way(0.2).track().noiseMm(), 0.2, 0.03);
  EXPECT_LT(Way(0).track().noiseMm(), 1e-3);
}

TEST(TipTrack, HiddenToolAndOutside_HaveNoPlace)
{
  const TipTrack track = Way(0, 0.02, 1.0).track();
  EXPECT_FALSE(track.at(1.03));
  EXPECT_FALSE(track.at(0.99)) << "one of its neighbours was not seen";
  EXPECT_TRUE(track.at(0.97));
  EXPECT_FALSE(track.at(-0.01));
  EXPECT_FALSE(track.at(100));
}

TEST(TipTrack, SlowTrack_IsOneByItsOwnSpacing)
{
  EXPECT_TRUE(Way(0, 0.2).track().at(2.1)) << "five measurements a second are far apart, but none is missing";
}

}  // namespace
