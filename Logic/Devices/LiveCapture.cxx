// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LiveCapture.h"

#include "RigidTransform.h"
#include "StreamRecorder.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace handeye::devices
{

namespace
{

using Status = LiveCapture::Step::Status;

LiveCapture::Step step(Status status, const std::string& message)
{
  return { status, -1, message };
}

nlohmann::json pointJson(const Eigen::VectorXd& point)
{
  return std::vector<double>(point.begin(), point.end());
}

/// The place of a stored sample, where it has one.
std::optional<Eigen::Vector3d> placeOf(const io::SessionSample& sample)
{
  const nlohmann::json place =
    sample.detection.is_object() ? sample.detection.value("tip_Marker_Mm", nlohmann::json()) : nlohmann::json();
  const bool isPoint = place.is_array() && place.size() == 3 &&
    std::all_of(place.begin(), place.end(), [](const nlohmann::json& value) { return value.is_number(); });
  return isPoint ? std::optional<Eigen::Vector3d>(Eigen::Vector3d(place[0], place[1], place[2])) : std::nullopt;
}

/// A tool that is hidden for longer begins the rest anew.
constexpr double LongestHiddenSec = 0.2;

/// The ball must keep still in the marker's frame; how the stylus is turned about it does not matter.
StillnessOptions stillnessOf(const LiveCaptureOptions& options)
{
  StillnessOptions stillness;
  stillness.touch = StillnessOptions::Touch::Either;
  stillness.minimumDurationSec = options.stillSec;
  stillness.maximumMotionMm = options.stillMm;
  stillness.maximumGapSec = 1;  // of a slow video; a tool that is hidden ends the rest sooner
  stillness.maximumExcursionSec = 0.1;
  return stillness;
}

const LiveCaptureOptions& checked(const LiveCaptureOptions& options)
{
  options.check();
  return options;
}

}  // namespace

void LiveCaptureOptions::check() const
{
  if (!(ballRadiusMm > 0) || !(stillSec > 0) || !(stillMm > 0) || !(differentPlaceMm >= 0))
  {
    throw std::invalid_argument("live capture: positive times and lengths are expected");
  }
  detection.check();
}

LiveCapture::LiveCapture(
  const CameraModel& camera, const Eigen::Vector3d& tip_Stylus, io::Session& session, const LiveCaptureOptions& options)
  : camera_(camera)
  , tip_Stylus_(tip_Stylus)
  , session_(session)
  , options_(checked(options))
  , stillness_(tip_Stylus, stillnessOf(options))
{
  for (const auto& [id, sample] : session.samples())
  {
    if (const std::optional<Eigen::Vector3d> place_Marker = placeOf(sample))
    {
      places_Marker_[id] = *place_Marker;
    }
  }
}

std::optional<Eigen::Isometry3d> LiveCapture::stylusToMarker(const PairedFrame& frame, std::string& problem) const
{
  for (const std::string& name : { options_.markerToTracker, options_.stylusToTracker })
  {
    const auto pose = frame.poses.find(name);
    if (pose == frame.poses.end() || !pose->second.isUsable())
    {
      problem = name + ": " + (pose == frame.poses.end() ? "no pose was received" : pose->second.message);
      return std::nullopt;
    }
  }
  return frame.poses.at(options_.markerToTracker).transform.inverse() * frame.poses.at(options_.stylusToTracker).transform;
}

/// A sample that was set aside, or is gone, leaves its place to another.
bool LiveCapture::isTaken(const Eigen::Vector3d& tip_Marker) const
{
  return std::any_of(places_Marker_.begin(), places_Marker_.end(),
    [&](const auto& place)
    {
      const auto sample = session_.samples().find(place.first);
      const bool counts = sample != session_.samples().end() && !sample->second.isExcluded;
      return counts && (place.second - tip_Marker).norm() < options_.differentPlaceMm;
    });
}

LiveCapture::Step LiveCapture::add(const PairedFrame& frame)
{
  std::string problem;
  const std::optional<Eigen::Isometry3d> stylusToMarker = this->stylusToMarker(frame, problem);
  if (!stylusToMarker)
  {
    stillness_.addInvalid(frame.image.timeSec);
    if (std::abs(frame.image.timeSec - lastSeenSec_) > LongestHiddenSec)
    {
      stillness_.finish();
    }
    return step(Status::NoPose, problem);
  }
  lastSeenSec_ = frame.image.timeSec;
  stillness_.add(frame.image.timeSec, *stylusToMarker);
  const Eigen::Vector3d tip_Marker = *stylusToMarker * tip_Stylus_;
  if (isTaken(tip_Marker))
  {
    return step(Status::SamePlace, "this place is taken: move on");
  }
  const std::optional<Rest> rest = stillness_.current();
  const bool isStill = rest && rest->endSec == frame.image.timeSec;  // this frame itself, not an excursion
  return isStill ? store(frame, tip_Marker) : step(Status::Moving, "hold the ball still");
}

LiveCapture::Step LiveCapture::store(const PairedFrame& frame, const Eigen::Vector3d& tip_Marker)
{
  const cv::Mat& image = frame.image.frame()->image;
  const bool isSize = !camera_.hasImageSize() || (image.cols == camera_.width() && image.rows == camera_.height());
  if (!isSize || image.empty() || image.channels() < 3)
  {
    return step(Status::WrongImage,
      "'" + frame.image.name + "' has " + std::to_string(image.cols) + " x " + std::to_string(image.rows) + " px and " +
        std::to_string(image.channels()) + " channels; " +
        (image.channels() < 3
            ? std::string("colours are")
            : std::to_string(camera_.width()) + " x " + std::to_string(camera_.height()) + " px of the camera's calibration are") +
        " expected");
  }
  const BallDetection ball = detectBall(image, camera_, options_.ballRadiusMm, options_.detection);
  if (!ball.isFound())
  {
    return step(Status::NoBall, ball.message);
  }
  io::SessionSample sample = toSessionSample(frame);
  sample.detection = { { "status", toString(ball.status) }, { "ball_Image_Px", pointJson(ball.ball_Image) },
    { "radiusPx", ball.radiusPx }, { "distanceMm", ball.distanceMm }, { "confidence", ball.confidence },
    { "tip_Marker_Mm", pointJson(tip_Marker) } };
  Step accepted;
  accepted.status = Status::Accepted;
  accepted.sampleId = session_.addSample(image, sample);
  accepted.message = "sample " + std::to_string(accepted.sampleId) + " is stored";
  places_Marker_[accepted.sampleId] = tip_Marker;
  stillness_.finish();
  return accepted;
}

io::SessionSample toSessionSample(const PairedFrame& frame)
{
  io::SessionSample sample;
  sample.timeSec = frame.image.timeSec;
  sample.pairing = { { "poseTimeSec", frame.poseTimeSec }, { "latencySec", frame.latencySec } };
  for (const auto& [name, pose] : frame.poses)
  {
    sample.transforms[name] = toSequenceTransform(pose.transform, pose.isUsable());
    sample.pairing["poses"][name] = { { "status", toString(pose.status) }, { "gapSec", pose.gapSec },
      { "extrapolationSec", pose.extrapolationSec }, { "repeatSec", pose.repeatSec } };
  }
  return sample;
}

}  // namespace handeye::devices
