// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PoseTrack.h"

#include "NumberWords.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace handeye
{

namespace
{

std::string inMs(double seconds)
{
  return fixedDigits(1000 * seconds, 0) + " ms";
}

PoseAtTime refused(PoseAtTime pose, PoseAtTime::Status status, const std::string& message)
{
  pose.status = status;
  pose.message = message;
  return pose;
}

}  // namespace

void PoseTrackOptions::check() const
{
  const bool isGood = historySec > 0 && maximumGapSec > 0 && maximumExtrapolationSec >= 0 && maximumRepeatSec >= 0;
  if (!isGood)  // also for NaN
  {
    throw std::invalid_argument("pose track: positive times are expected");
  }
}

PoseTrack::PoseTrack(const PoseTrackOptions& options)
  : options_(options)
{
  options_.check();
}

bool PoseTrack::add(double timeSec, const Eigen::Isometry3d& transform, bool isValid)
{
  if (!std::isfinite(timeSec) || (isValid && !transform.matrix().allFinite()))
  {
    throw std::invalid_argument("pose track: a pose or its time is not finite");
  }
  if (!poses_.empty() && timeSec < poses_.back().timeSec - options_.historySec)
  {
    return false;
  }
  const auto place =
    std::lower_bound(poses_.begin(), poses_.end(), timeSec, [](const Pose& pose, double time) { return pose.timeSec < time; });
  Pose pose{ timeSec, transform, isValid, timeSec };
  if (place != poses_.begin())
  {
    const Pose& before = *std::prev(place);
    const bool isSame = isValid && before.isValid && before.transform.matrix() == transform.matrix();
    pose.sameSinceSec = isSame ? before.sameSinceSec : timeSec;
  }
  if (place != poses_.end() && place->timeSec == timeSec)
  {
    *place = pose;
  }
  else
  {
    poses_.insert(place, pose);
  }
  while (poses_.front().timeSec < poses_.back().timeSec - options_.historySec)
  {
    poses_.pop_front();
  }
  return true;
}

std::vector<double> PoseTrack::timesSec() const
{
  std::vector<double> times;
  for (const Pose& pose : poses_)
  {
    times.push_back(pose.timeSec);
  }
  return times;
}

PoseAtTime PoseTrack::at(double timeSec) const
{
  if (poses_.empty())
  {
    return refused({}, PoseAtTime::Status::NoPose, "no pose was received");
  }
  const auto after =
    std::lower_bound(poses_.begin(), poses_.end(), timeSec, [](const Pose& pose, double time) { return pose.timeSec < time; });
  if (after == poses_.end())
  {
    return outside(poses_.back(), timeSec - poses_.back().timeSec);
  }
  if (after->timeSec == timeSec)
  {
    return between(*after, *after, timeSec);
  }
  return after == poses_.begin() ? outside(*after, timeSec - after->timeSec) : between(*std::prev(after), *after, timeSec);
}

PoseAtTime PoseTrack::outside(const Pose& nearest, double extrapolationSec) const
{
  PoseAtTime pose = between(nearest, nearest, nearest.timeSec);
  pose.extrapolationSec = extrapolationSec;
  if (std::abs(extrapolationSec) > options_.maximumExtrapolationSec)
  {
    return refused(pose, PoseAtTime::Status::Extrapolated,
      extrapolationSec > 0 ? "the last pose is " + inMs(extrapolationSec) + " older than the image"
                           : "the first pose is " + inMs(-extrapolationSec) + " later than the image");
  }
  return pose;
}

PoseAtTime PoseTrack::between(const Pose& before, const Pose& after, double timeSec) const
{
  PoseAtTime pose;
  pose.gapSec = after.timeSec - before.timeSec;
  if (!before.isValid || !after.isValid)
  {
    return refused(pose, PoseAtTime::Status::Invalid, "the tracker did not see the tool");
  }
  pose.repeatSec = std::min(timeSec, before.timeSec) - before.sameSinceSec;
  if (options_.maximumRepeatSec > 0 && pose.repeatSec > options_.maximumRepeatSec)
  {
    return refused(pose, PoseAtTime::Status::Stale, "the pose has not changed by a single bit for " + inMs(pose.repeatSec));
  }
  if (pose.gapSec > options_.maximumGapSec)
  {
    return refused(pose, PoseAtTime::Status::GapTooLarge, "the poses beside the image are " + inMs(pose.gapSec) + " apart");
  }
  const double share = pose.gapSec > 0 ? (timeSec - before.timeSec) / pose.gapSec : 0;
  const Eigen::Quaterniond from(before.transform.linear()), to(after.transform.linear());
  pose.transform.linear() = from.slerp(share, to).toRotationMatrix();
  pose.transform.translation() = (1 - share) * before.transform.translation() + share * after.transform.translation();
  pose.status = PoseAtTime::Status::Ok;
  return pose;
}

std::string toString(PoseAtTime::Status status)
{
  switch (status)
  {
    case PoseAtTime::Status::Ok:
      return "ok";
    case PoseAtTime::Status::NoPose:
      return "no_pose";
    case PoseAtTime::Status::Invalid:
      return "invalid";
    case PoseAtTime::Status::GapTooLarge:
      return "gap_too_large";
    case PoseAtTime::Status::Extrapolated:
      return "extrapolated";
    case PoseAtTime::Status::Stale:
      return "stale";
  }
  return "no_pose";
}

}  // namespace handeye
