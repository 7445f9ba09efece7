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
  , options_(options)
{
  options_.check();
  for (const auto& sample : session.samples())
  {
    if (const std::optional<Eigen::Vector3d> place_Marker = placeOf(sample.second))
    {
      places_Marker_.push_back(*place_Marker);
    }
  }
}

std::optional<Eigen::Vector3d> LiveCapture::tipOf(const PairedFrame& frame, std::string& problem) const
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
  const Eigen::Vector3d tip_Tracker = frame.poses.at(options_.stylusToTracker).transform * tip_Stylus_;
  return frame.poses.at(options_.markerToTracker).transform.inverse() * tip_Tracker;
}

bool LiveCapture::isStill() const
{
  if (window_.size() < 3 || window_.back().timeSec - window_.front().timeSec < options_.stillSec)
  {
    return false;
  }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Moment& moment : window_)
  {
    mean += moment.tip_Marker / double(window_.size());
  }
  double squared = 0;
  for (const Moment& moment : window_)
  {
    squared += (moment.tip_Marker - mean).squaredNorm() / double(window_.size());
  }
  return std::sqrt(squared) < options_.stillMm;
}

LiveCapture::Step LiveCapture::add(const PairedFrame& frame)
{
  std::string problem;
  const std::optional<Eigen::Vector3d> tip_Marker = tipOf(frame, problem);
  if (!tip_Marker)
  {
    window_.clear();
    return step(Status::NoPose, problem);
  }
  if (!window_.empty() && frame.image.timeSec <= window_.back().timeSec)
  {
    window_.clear();  // a clock that was set
  }
  window_.push_back({ frame.image.timeSec, *tip_Marker });
  // One more than the window's length stays, so that it spans all of it.
  while (window_.size() > 2 && window_.back().timeSec - window_[1].timeSec >= options_.stillSec)
  {
    window_.pop_front();
  }
  const bool isKnown = std::any_of(places_Marker_.begin(), places_Marker_.end(),
    [&](const Eigen::Vector3d& place_Marker) { return (place_Marker - *tip_Marker).norm() < options_.differentPlaceMm; });
  if (isKnown)
  {
    return step(Status::SamePlace, "this place is taken: move on");
  }
  return isStill() ? store(frame, *tip_Marker) : step(Status::Moving, "hold the ball still");
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
  places_Marker_.push_back(tip_Marker);
  window_.clear();
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
