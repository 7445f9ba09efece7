// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RoomMotion.h"

#include "RigidTransform.h"

namespace handeye::simulation
{

namespace
{

constexpr double PivotSec = 12, PlacementsSec = 40, FreeSec = 20;

Eigen::Isometry3d rigid(const Eigen::Vector3d& rotationVector, const Eigen::Vector3d& translation)
{
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = rotationFromVector(rotationVector);
  transform.translation() = translation;
  return transform;
}

double wave(double timeSec, double periodSec, double phase)
{
  return std::sin(2 * EIGEN_PI * timeSec / periodSec + phase);
}

/// From 0 to 1 with no speed at both ends.
double smoothStep(double share)
{
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * s * (s * (6 * s - 15) + 10);
}

/// A hand is never quite still.
Eigen::Vector3d tremor(double timeSec)
{
  return { 0.05 * wave(timeSec, 0.31, 0), 0.05 * wave(timeSec, 0.27, 1), 0.05 * wave(timeSec, 0.37, 2) };
}

/// Places in view whose balls are whole in the picture: well spread over the image and the depth.
std::vector<Eigen::Vector3d> makePlaces(const RoomOptions& options)
{
  std::mt19937 engine(options.seed);
  const auto uniform = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(engine); };
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < options.placeCount; ++i)
  {
    // One place in each cell of a grid of the image, the depths in turn.
    const double depth =
      options.nearestMm + (options.furthestMm - options.nearestMm) * std::fmod(i * 0.618 + 0.05 * uniform(-1, 1) + 1, 1.0);
    const double margin = 1.25 * options.ballRadiusMm / depth * options.camera.fx();
    const double column = (i % 5 + uniform(0.2, 0.8)) / 5, row = (i / 5 % 3 + uniform(0.2, 0.8)) / 3;
    const double x = margin + column * (options.camera.width() - 2 * margin);
    const double y = margin + row * (options.camera.height() - 2 * margin);
    const Eigen::Vector3d ray_Camera = options.camera.unproject({ x, y }).ray_Camera;
    places.push_back(ray_Camera * depth / ray_Camera.z());
  }
  return places;
}

}  // namespace

RoomScript::RoomScript(const RoomOptions& options)
  : options_(options)
  , cameraToTracker_(rigid({ 0.4, 2.6, -0.2 }, { 120, -80, -1350 }))
{
  const double middleMm = (options.nearestMm + options.furthestMm) / 2;
  phantomToTracker_ = cameraToTracker_ * rigid({ 0.3, -0.4, 0.9 }, { -45, 60, middleMm + 90 });
  if (options.motion == RoomMotion::Landmarks)
  {
    const Eigen::Isometry3d modelToTracker = phantomToTracker_ * options.modelToPhantom;
    for (const Eigen::Vector3d& landmark_Model : options.landmarks_Model)
    {
      places_Tracker_.push_back(modelToTracker * landmark_Model);
    }
    return;
  }
  for (const Eigen::Vector3d& place_Camera : makePlaces(options))
  {
    places_Tracker_.push_back(cameraToTracker_ * place_Camera);
  }
}

RoomScript::Moment RoomScript::momentOf(double timeSec) const
{
  if (options_.motion != RoomMotion::Tour)
  {
    return { options_.motion, timeSec };
  }
  const double inTour = std::fmod(timeSec, PivotSec + PlacementsSec + FreeSec);
  if (inTour < PivotSec)
  {
    return { RoomMotion::Pivot, inTour };
  }
  return inTour < PivotSec + PlacementsSec ? Moment{ RoomMotion::Placements, inTour - PivotSec }
                                           : Moment{ RoomMotion::Free, inTour - PivotSec - PlacementsSec };
}

Eigen::Isometry3d RoomScript::markerToTracker(double timeSec) const
{
  Eigen::Isometry3d sway = Eigen::Isometry3d::Identity();
  if (options_.cameraMoves)
  {
    // Two hands hold it as still as they can.
    sway = rigid({ 0.002 * wave(timeSec, 4.1, 0), 0.0025 * wave(timeSec, 5.3, 1), 0.002 * wave(timeSec, 3.7, 2) },
      { 0.5 * wave(timeSec, 4.7, 0), 0.6 * wave(timeSec, 3.9, 1), 0.5 * wave(timeSec, 6.1, 2) });
  }
  const Eigen::Isometry3d movedToTracker = cameraToTracker_ * sway;
  return movedToTracker * options_.markerToCamera;
}

Eigen::Vector3d RoomScript::ball_Tracker(const Moment& moment) const
{
  const double middleMm = (options_.nearestMm + options_.furthestMm) / 2;
  if (moment.motion == RoomMotion::Pivot || moment.motion == RoomMotion::Spin)
  {
    return cameraToTracker_ * Eigen::Vector3d(10, 15, middleMm);
  }
  if (moment.motion == RoomMotion::Free)
  {
    const double t = moment.timeSec, reach = 0.28 * middleMm;
    return cameraToTracker_ *
      Eigen::Vector3d(reach * wave(t, 2.3, 0), 0.7 * reach * wave(t, 1.7, 0.5),
        middleMm + 0.3 * (options_.furthestMm - options_.nearestMm) * wave(t, 3.1, 1));
  }
  if (moment.motion == RoomMotion::Rest)
  {
    const double restMm = options_.nearestMm + 0.3 * (options_.furthestMm - options_.nearestMm);
    return cameraToTracker_ * Eigen::Vector3d(0.03 * restMm, -0.05 * restMm, restMm) + tremor(moment.timeSec);
  }
  return this->placedBall_Tracker(moment.timeSec);
}

/// At one place after another.
Eigen::Vector3d RoomScript::placedBall_Tracker(double timeSec) const
{
  const double periodSec = options_.holdSec + options_.moveSec;
  const auto place = std::size_t(timeSec / periodSec);
  const double inPeriod = timeSec - double(place) * periodSec;
  const double share = smoothStep((inPeriod - options_.holdSec) / options_.moveSec);
  const Eigen::Vector3d& from = places_Tracker_[place % places_Tracker_.size()];
  const Eigen::Vector3d& to = places_Tracker_[(place + 1) % places_Tracker_.size()];
  return (1 - share) * from + share * to + tremor(timeSec);
}

/// The shaft comes from below and behind the ball, seen from the camera, and sways; or the stylus is spun about it.
Eigen::Matrix3d RoomScript::stylusRotation(const Moment& moment) const
{
  const Eigen::Vector3d shaft_Stylus = -options_.tip_Stylus.normalized();  // from the ball to the handle
  const Eigen::Vector3d shaft_Camera = Eigen::Vector3d(0.35, 0.75, 0.55).normalized();
  const Eigen::Matrix3d stylusToCamera = Eigen::Quaterniond::FromTwoVectors(shaft_Stylus, shaft_Camera).toRotationMatrix();
  if (moment.motion == RoomMotion::Spin)
  {
    // Fingers turn it to and fro, and lean it a little while they do.
    const Eigen::Vector3d lean(0.012 * wave(moment.timeSec, 1.9, 0), 0.012 * wave(moment.timeSec, 2.3, 1), 0);
    const Eigen::Matrix3d leantToCamera = rotationFromVector(lean) * stylusToCamera;
    const Eigen::Vector3d spin_Stylus = 1.2 * wave(moment.timeSec, 3.1, 0) * shaft_Stylus;
    const Eigen::Matrix3d spunToCamera = leantToCamera * rotationFromVector(spin_Stylus);
    return cameraToTracker_.linear() * spunToCamera;
  }
  const bool isPivot = moment.motion == RoomMotion::Pivot;
  const double swing = isPivot ? 0.6 : 0.15, t = moment.timeSec;
  const Eigen::Vector3d turn(swing * wave(t, 2.9, 0), swing * wave(t, 2.1, 1), (isPivot ? 0.8 : 0.2) * wave(t, 4.3, 2));
  const Eigen::Matrix3d swungToCamera = rotationFromVector(turn) * stylusToCamera;
  return cameraToTracker_.linear() * swungToCamera;
}

Eigen::Isometry3d RoomScript::stylusToTracker(double timeSec) const
{
  const Moment moment = momentOf(timeSec);
  Eigen::Isometry3d stylusToTracker = Eigen::Isometry3d::Identity();
  stylusToTracker.linear() = stylusRotation(moment);
  const Eigen::Vector3d tipOffset_Tracker = stylusToTracker.linear() * options_.tip_Stylus;
  stylusToTracker.translation() = ball_Tracker(moment) - tipOffset_Tracker;
  return stylusToTracker;
}

bool RoomScript::isHeldStill(double timeSec) const
{
  const Moment moment = momentOf(timeSec);
  if (moment.motion == RoomMotion::Rest)
  {
    return true;
  }
  const double inPeriod = std::fmod(moment.timeSec, options_.holdSec + options_.moveSec);
  const bool isHolding = moment.motion == RoomMotion::Placements || moment.motion == RoomMotion::Landmarks;
  return isHolding && inPeriod > 0.25 * options_.holdSec && inPeriod < options_.holdSec;
}

}  // namespace handeye::simulation
