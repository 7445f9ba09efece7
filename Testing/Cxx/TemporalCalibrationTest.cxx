// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TemporalCalibration.h"
#include "SimulatedRoom.h"
#include "Simulation.h"

#include <gtest/gtest.h>

namespace
{

using namespace handeye;
using namespace handeye::simulation;
using Status = TemporalCalibrationResult::Status;

/// Some seconds of a moving ball: poses at 100 Hz, 30 frames a second, noise as the room and a segmentation have it.
struct Stream
{
  RoomOptions options;
  std::vector<BallSighting> sightings;
  PoseTrack marker, stylus;

  Stream(double delaySec, double seconds, unsigned seed, RoomMotion motion = RoomMotion::Free)
    : marker(historyOf(seconds))
    , stylus(historyOf(seconds))
  {
    options.videoDelaySec = delaySec;
    options.motion = motion;
    options.cameraMoves = motion == RoomMotion::Free;  // a camera that sways tells the latency, too
    options.seed = seed;
    const SimulatedRoom room(options);
    takePosesEvery(0.01, seconds);
    test::Random random(seed + 100);
    for (double timeSec = 0.35; timeSec < seconds - 0.35; timeSec += 1 / 30.0)
    {
      const Eigen::Vector3d ball_Camera = room.truth(timeSec).ball_Camera;
      Eigen::Vector2d seen = options.camera.project(ball_Camera).point_Image;
      seen += Eigen::Vector2d(random.normal(0.3), random.normal(0.3));
      sightings.push_back({ timeSec, options.camera.unproject(seen).ray_Camera, ball_Camera.norm() * (1 + random.normal(0.02)) });
    }
  }

  void takePosesEvery(double spacingSec, double seconds)
  {
    marker.clear();
    stylus.clear();
    const SimulatedRoom room(options);
    for (double timeSec = 0; timeSec < seconds; timeSec += spacingSec)
    {
      const std::vector<RoomPose> poses = room.track(timeSec);
      marker.add(timeSec, poses[0].transform, poses[0].isValid);
      stylus.add(timeSec, poses[1].transform, poses[1].isValid);
    }
  }

  static PoseTrackOptions historyOf(double seconds)
  {
    PoseTrackOptions track;
    track.historySec = seconds + 1;
    return track;
  }

  TemporalCalibrationResult calibrate(const std::optional<Eigen::Isometry3d>& markerToCamera = {}) const
  {
    return calibrateLatency(sightings, marker, stylus, options.tip_Stylus, options.camera, markerToCamera);
  }
};

/// The figure asked for: 5 ms at 30 frames a second from a few seconds. Reached: see the test's output.
TEST(TemporalCalibration, FewSeconds_GiveTheLatencyToFiveMs)
{
  double worstSec = 0, squaredSigmas = 0;
  int count = 0;
  for (double delaySec : { -0.12, -0.033, 0.0, 0.02, 0.071, 0.15 })
  {
    for (unsigned seed : { 1U, 2U, 3U })
    {
      const Stream stream(delaySec, 5, seed);
      const TemporalCalibrationResult result = stream.calibrate();
      ASSERT_EQ(result.status, Status::Ok) << result.message;
      const double errorSec = result.latencySec + delaySec;  // a frame that is late belongs to earlier poses
      worstSec = std::max(worstSec, std::abs(errorSec));
      squaredSigmas += std::pow(errorSec / result.sigmaSec, 2);
      ++count;
    }
  }
  std::printf("worst of %d: %.2f ms; RMS in sigmas %.2f\n", count, 1000 * worstSec, std::sqrt(squaredSigmas / count));
  EXPECT_LT(worstSec, 0.005);
  // Honest: 18 errors of one sigma have a root mean square between 0.5 and 1.6; neighbouring frames share the noise of poses, hence 2.
  EXPECT_LT(std::sqrt(squaredSigmas / count), 2);
  EXPECT_GT(std::sqrt(squaredSigmas / count), 0.3);
}

/// A recording has its poses at the times of its images. Between two of them a pose is a mean with less noise, which must not draw the
/// latency to the middle; nor may a ball that rests half of the time make it look better known than it is.
TEST(TemporalCalibration, PosesAtTheTimesOfFrames_AreNotBiasedAndTheUncertaintyIsHonest)
{
  double squaredSigmas = 0, worstSec = 0;
  int count = 0, refused = 0;
  for (double spacingSec : { 1 / 30.0, 0.05 })
  {
    for (unsigned seed = 1; seed <= 6; ++seed)
    {
      Stream stream(0.037, 8, seed, RoomMotion::Placements);
      stream.takePosesEvery(spacingSec, 8);
      const TemporalCalibrationResult result = stream.calibrate();
      refused += result.isUsable() ? 0 : 1;
      if (result.isUsable())
      {
        const double errorSec = result.latencySec + 0.037;
        worstSec = std::max(worstSec, std::abs(errorSec));
        squaredSigmas += std::pow(errorSec / result.sigmaSec, 2);
        ++count;
      }
    }
  }
  std::printf(
    "worst of %d: %.2f ms; RMS in sigmas %.2f; refused %d\n", count, 1000 * worstSec, std::sqrt(squaredSigmas / count), refused);
  EXPECT_GE(count, 8);
  EXPECT_LT(worstSec, 0.005);
  EXPECT_LT(std::sqrt(squaredSigmas / count), 2);
  EXPECT_GT(std::sqrt(squaredSigmas / count), 0.2);
}

TEST(TemporalCalibration, KnownHandEye_GivesTheSame)
{
  const Stream stream(0.045, 4, 7);
  const TemporalCalibrationResult result = stream.calibrate(stream.options.markerToCamera);
  ASSERT_EQ(result.status, Status::Ok) << result.message;
  EXPECT_NEAR(result.latencySec, -0.045, 0.005);
}

TEST(TemporalCalibration, WrongSightings_AreLeftOut)
{
  Stream stream(0.06, 6, 4);
  test::Random random(9);
  for (std::size_t i = 0; i < stream.sightings.size(); i += 12)
  {
    stream.sightings[i].ray_Camera = (Eigen::Vector3d::UnitZ() + 0.4 * random.direction()).normalized();
  }
  const TemporalCalibrationResult result = stream.calibrate(stream.options.markerToCamera);
  ASSERT_EQ(result.status, Status::Ok) << result.message;
  EXPECT_NEAR(result.latencySec, -0.06, 0.005);
  EXPECT_GE(result.rejectedCount, 8);
}

TEST(TemporalCalibration, BallAtRest_IsTooLittleMotion)
{
  Stream stream(0.05, 5, 2, RoomMotion::Pivot);
  const TemporalCalibrationResult result = stream.calibrate(stream.options.markerToCamera);
  EXPECT_FALSE(result.isUsable()) << result.message;
  EXPECT_TRUE(result.status == Status::TooLittleMotion || result.status == Status::AtLimit) << result.message;
}

TEST(TemporalCalibration, LatencyBeyondTheLimit_IsSaidSo)
{
  Stream stream(0, 5, 2);
  for (BallSighting& sighting : stream.sightings)
  {
    sighting.timeSec += 0.45;
  }
  const TemporalCalibrationResult result = stream.calibrate(stream.options.markerToCamera);
  EXPECT_FALSE(result.isUsable()) << result.message;
}

TEST(TemporalCalibration, TooFewSightings_AreCounted)
{
  Stream stream(0.05, 5, 2);
  stream.sightings.resize(12);
  const TemporalCalibrationResult result = stream.calibrate();
  EXPECT_EQ(result.status, Status::TooFewSightings);
  EXPECT_NE(result.message.find("12"), std::string::npos);
}

TEST(TemporalCalibration, CallersMistakes_NameTheSighting)
{
  Stream stream(0.05, 2, 2);
  stream.sightings[3].distanceMm = 0;
  try
  {
    (void)stream.calibrate();
    FAIL();
  }
  catch (const std::invalid_argument& error)
  {
    EXPECT_NE(std::string(error.what()).find("sighting 3"), std::string::npos);
  }
}

}  // namespace
