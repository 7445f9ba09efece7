// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SimulatedRoom.h"

#include "RigidTransform.h"
#include "RoomMotion.h"
#include "RoomPicture.h"

#include <stdexcept>

namespace handeye::simulation
{

namespace
{

constexpr double DropOutSec = 0.2;

Eigen::Isometry3d rigid(const Eigen::Vector3d& rotationVector, const Eigen::Vector3d& translation)
{
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = rotationFromVector(rotationVector);
  transform.translation() = translation;
  return transform;
}

/// Random numbers that belong to a moment and a tool, whatever was asked for before.
std::mt19937 engineFor(unsigned seed, unsigned tool, double timeSec, double stepSec)
{
  const auto step = std::int64_t(std::floor(timeSec / stepSec + 0.5));
  std::seed_seq sequence{ seed, tool, unsigned(step), unsigned(step >> 32) };
  return std::mt19937(sequence);
}

CameraModel defaultCamera()
{
  Eigen::Matrix3d cameraMatrix;
  cameraMatrix << 601.7, 0, 316.2, 0, 602.9, 244.8, 0, 0, 1;
  return CameraModel(640, 480, cameraMatrix, { 0.041, -0.112, -0.0007, 0.0011, 0.02 });
}

}  // namespace

struct SimulatedRoom::Parts
{
  explicit Parts(const RoomOptions& options)
    : script(options)
    , rays(options.camera)
  {
  }
  RoomScript script;
  RayTable rays;
};

RoomOptions::RoomOptions()
  : camera(defaultCamera())
  , markerToCamera(rigid({ 1.9, -1.1, 0.7 }, { 18, -61, 34 }))
  , tip_Stylus(-1.9, 0.4, 186.4)
  // A vertebra that is x right, y anterior, z superior shows its back, seen a little from above.
  , modelToPhantom(rigid({ 1.75, -0.32, -1.19 }, { 9, -11, 21 }))
{
}

void RoomOptions::check() const
{
  const bool isGood = camera.hasImageSize() && ballRadiusMm > 0 && placeCount > 0 && holdSec > 0 && moveSec > 0 &&
    (motion != RoomMotion::Landmarks || !landmarks_Model.empty()) && nearestMm > 2 * ballRadiusMm && furthestMm > nearestMm &&
    trackingSigmaMm >= 0 && trackingSigmaDeg >= 0 && dropOutShare >= 0 && dropOutShare < 1 && imageNoise >= 0 && blurPx >= 0 &&
    std::isfinite(videoDelaySec) && tip_Stylus.norm() > 1;
  if (!isGood)
  {
    throw std::invalid_argument(
      "simulated room: a camera with its image size, positive sizes, times and depths (nearest beyond two "
      "radii of the ball), noise that is not negative, and landmarks for the motion over them are expected");
  }
}

SimulatedRoom::SimulatedRoom(const RoomOptions& options)
  : options_(options)
{
  options_.check();
  parts_ = std::make_unique<Parts>(options_);
}

SimulatedRoom::~SimulatedRoom() = default;

std::vector<RoomPose> SimulatedRoom::track(double timeSec) const
{
  const RoomScript& script = parts_->script;
  std::vector<RoomPose> poses = { { "MarkerToTracker", script.markerToTracker(timeSec), true },
    { "StylusToTracker", script.stylusToTracker(timeSec), true }, { "PhantomToTracker", script.phantomToTracker(), true } };
  for (unsigned tool = 0; tool < poses.size(); ++tool)
  {
    std::mt19937 engine = engineFor(options_.seed, tool, timeSec, 1e-4);
    std::normal_distribution<double> normal;
    const auto normal3 = [&](double sigma)
    {
      const double x = normal(engine), y = normal(engine), z = normal(engine);
      return Eigen::Vector3d(sigma * x, sigma * y, sigma * z);
    };
    RoomPose& pose = poses[tool];
    pose.transform.linear() = pose.transform.linear() * rotationFromVector(normal3(options_.trackingSigmaDeg * EIGEN_PI / 180));
    pose.transform.translation() += normal3(options_.trackingSigmaMm);
    std::mt19937 dropOut = engineFor(options_.seed, tool + 100, std::floor(timeSec / DropOutSec) * DropOutSec, DropOutSec);
    pose.isValid = std::uniform_real_distribution<double>(0, 1)(dropOut) >= options_.dropOutShare;
  }
  return poses;
}

SimulatedRoom::Truth SimulatedRoom::truth(double frameTimeSec) const
{
  Truth truth;
  truth.exposureSec = frameTimeSec - options_.videoDelaySec;
  truth.markerToTracker = parts_->script.markerToTracker(truth.exposureSec);
  truth.stylusToTracker = parts_->script.stylusToTracker(truth.exposureSec);
  truth.phantomToTracker = parts_->script.phantomToTracker();
  const Eigen::Vector3d ball_Tracker = truth.stylusToTracker * options_.tip_Stylus;
  const Eigen::Vector3d ball_Marker = truth.markerToTracker.inverse() * ball_Tracker;
  truth.ball_Camera = options_.markerToCamera * ball_Marker;
  return truth;
}

cv::Mat SimulatedRoom::picture(double timeSec) const
{
  const Truth now = truth(timeSec);
  RoomView view;
  view.trackerToCamera = options_.markerToCamera * now.markerToTracker.inverse();
  view.ball_Camera = now.ball_Camera;
  view.handle_Camera = view.trackerToCamera * now.stylusToTracker.translation();
  view.phantomToCamera = view.trackerToCamera * now.phantomToTracker;
  return drawRoom(options_, parts_->rays, view, unsigned(engineFor(options_.seed, 7, timeSec, 1e-4)()));
}

bool SimulatedRoom::isHeldStill(double timeSec) const
{
  return parts_->script.isHeldStill(timeSec);
}

std::string toString(RoomMotion motion)
{
  switch (motion)
  {
    case RoomMotion::Pivot:
      return "pivot";
    case RoomMotion::Spin:
      return "spin";
    case RoomMotion::Placements:
      return "placements";
    case RoomMotion::Free:
      return "free";
    case RoomMotion::Rest:
      return "rest";
    case RoomMotion::Landmarks:
      return "landmarks";
    case RoomMotion::Tour:
      return "tour";
  }
  return "tour";
}

}  // namespace handeye::simulation
