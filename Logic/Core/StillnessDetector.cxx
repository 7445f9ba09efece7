// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StillnessDetector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace handeye
{

namespace
{

constexpr std::size_t WindowCapacity = 256;
/// Share of the samples of a beginning rest that may lie beyond the limits.
constexpr double ToleratedShare = 0.1;
/// A time that goes back by more than this is a clock that was set, not a late sample.
constexpr double ClockJumpSec = 10;

double angleBetween(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b)
{
  return 2 * std::acos(std::min(1.0, std::abs(a.dot(b))));
}

/// Quaternions of both signs are the same rotation: added with that of the sum so far.
void addTo(Eigen::Quaterniond& sum, const Eigen::Quaterniond& orientation)
{
  sum.coeffs() += (sum.dot(orientation) < 0 ? -1.0 : 1.0) * orientation.coeffs();
}

}  // namespace

void StillnessOptions::check() const
{
  for (const double limit : { maximumMotionMm, maximumTurn, minimumPivoting, minimumDurationSec, maximumGapSec })
  {
    if (!(limit > 0 && std::isfinite(limit)))
    {
      throw std::invalid_argument("stillness options: positive limits of motion (mm), turning (rad) and time (s) are expected");
    }
  }
  if (!(maximumExcursionSec >= 0 && std::isfinite(maximumExcursionSec)))
  {
    throw std::invalid_argument("stillness options: the longest excursion (s) must not be negative");
  }
}

StillnessDetector::StillnessDetector(const Eigen::Vector3d& tip_Tool, const StillnessOptions& options)
  : tip_Tool_(tip_Tool)
  , options_(options)
{
  options_.check();
  if (!tip_Tool.allFinite())
  {
    throw std::invalid_argument("stillness: the tip is not finite");
  }
  window_.reserve(WindowCapacity);
}

bool StillnessDetector::isWithin(
  const Sample& sample, const Eigen::Vector3d& tip_World, const Eigen::Quaterniond& orientation) const
{
  const bool isTipStill = (sample.tip_World - tip_World).norm() <= options_.maximumMotionMm;
  return isTipStill &&
    (options_.touch != StillnessOptions::Touch::Held || angleBetween(sample.toolToWorld, orientation) <= options_.maximumTurn);
}

/// Keeps the newest samples; of a fast stream only as many as fit into the duration that matters.
void StillnessDetector::push(const Sample& sample)
{
  const double spacing = 2 * options_.minimumDurationSec / double(WindowCapacity);
  if (!window_.empty() && sample.timeSec - window_.back().timeSec < spacing && sample.timeSec > window_.back().timeSec)
  {
    return;
  }
  // A little more than the duration, so that a window that reaches back over all of it can be told from a stream that just began.
  // One sample from before that stays: of a slow stream it may be the only one that reaches back.
  const std::size_t within = this->windowBegin(sample.timeSec - 1.5 * options_.minimumDurationSec);
  const std::size_t old = within > 0 ? within - 1 : 0;
  window_.erase(window_.begin(), window_.begin() + std::ptrdiff_t(std::max(old, std::size_t(window_.size() == WindowCapacity))));
  window_.push_back(sample);
}

std::size_t StillnessDetector::windowBegin(double sinceSec) const
{
  const auto first = std::find_if(window_.begin(), window_.end(), [&](const Sample& sample) { return sample.timeSec >= sinceSec; });
  return std::size_t(first - window_.begin());
}

std::optional<Rest> StillnessDetector::add(double timeSec, const Eigen::Isometry3d& toolToWorld)
{
  if (!std::isfinite(timeSec) || !toolToWorld.matrix().allFinite())
  {
    throw std::invalid_argument("stillness: sample " + std::to_string(added_) + " holds a number that is not finite");
  }
  std::optional<Rest> ended = this->finishIfClockWasSet(timeSec);
  if (added_ > 0 && timeSec < newestSec_)
  {
    ++added_;
    return ended;
  }
  if (added_ > 0 && timeSec - newestValidSec_ > options_.maximumGapSec)
  {
    ended = this->finish();
  }
  const Sample sample{ timeSec, added_, toolToWorld * tip_Tool_, Eigen::Quaterniond(toolToWorld.linear()).normalized() };
  ++added_;
  newestSec_ = newestValidSec_ = timeSec;
  this->push(sample);
  if (!isResting_)
  {
    this->tryToBegin();
    return ended;
  }
  if (this->isWithin(sample, rest_.tip_World, rest_.count > 0 ? orientationSum_.normalized() : sample.toolToWorld))
  {
    this->include(sample);
  }
  else if (timeSec - rest_.endSec > options_.maximumExcursionSec)
  {
    ended = this->end();
    this->tryToBegin();
  }
  else
  {
    ++pending_;
  }
  return ended;
}

std::optional<Rest> StillnessDetector::addInvalid(double timeSec)
{
  if (!std::isfinite(timeSec))
  {
    throw std::invalid_argument("stillness: the time of sample " + std::to_string(added_) + " is not finite");
  }
  std::optional<Rest> ended = this->finishIfClockWasSet(timeSec);
  const bool isGap = added_ > 0 && timeSec - newestValidSec_ > options_.maximumGapSec;
  newestSec_ = added_ > 0 ? std::max(newestSec_, timeSec) : timeSec;
  newestValidSec_ = added_ > 0 ? newestValidSec_ : timeSec;
  ++added_;
  return isGap ? this->finish() : ended;
}

/// Times that go far back begin anew; one sample from the future must not silence all that follow.
std::optional<Rest> StillnessDetector::finishIfClockWasSet(double timeSec)
{
  if (added_ == 0 || timeSec >= newestSec_ - ClockJumpSec)
  {
    return std::nullopt;
  }
  newestSec_ = newestValidSec_ = timeSec;
  return this->finish();
}

void StillnessDetector::tryToBegin()
{
  const double sinceSec = newestSec_ - options_.minimumDurationSec;
  if (window_.empty() || window_.front().timeSec > sinceSec)
  {
    return;
  }
  // From the last sample before the duration on, so that the samples span all of it.
  const std::size_t after = this->windowBegin(sinceSec);
  const std::size_t begin = window_[after].timeSec > sinceSec ? after - 1 : after;
  const std::size_t count = window_.size() - begin;
  std::array<double, WindowCapacity> values{};
  Eigen::Vector3d center;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (std::size_t k = 0; k < count; ++k)
    {
      values[k] = window_[begin + k].tip_World(axis);
    }
    const auto middle = values.begin() + std::ptrdiff_t(count / 2);
    std::nth_element(values.begin(), middle, values.begin() + std::ptrdiff_t(count));
    center(axis) = *middle;
  }
  Eigen::Quaterniond sum(Eigen::Vector4d::Zero());
  for (std::size_t k = begin; k < window_.size(); ++k)
  {
    addTo(sum, window_[k].toolToWorld);
  }
  const Eigen::Quaterniond orientation = sum.normalized();
  std::size_t beyond = 0;
  for (std::size_t k = begin; k < window_.size(); ++k)
  {
    beyond += this->isWithin(window_[k], center, orientation) ? 0 : 1;
  }
  if (double(beyond) > ToleratedShare * double(count) || !this->isWithin(window_[begin], center, orientation))
  {
    return;
  }
  isResting_ = true;
  rest_ = {};
  pending_ = 0;
  scatter_.setZero();
  orientationSum_.coeffs().setZero();
  rest_.beginSec = window_[begin].timeSec;
  rest_.firstSample = window_[begin].index;
  for (std::size_t k = begin; k < window_.size(); ++k)
  {
    if (this->isWithin(window_[k], center, orientation))
    {
      this->include(window_[k]);
    }
    else
    {
      ++pending_;
    }
  }
}

/// Running mean and scatter (Welford).
void StillnessDetector::include(const Sample& sample)
{
  ++rest_.count;
  rest_.leftOut += pending_;
  pending_ = 0;
  const Eigen::Vector3d before = sample.tip_World - rest_.tip_World;
  rest_.tip_World += before / double(rest_.count);
  const Eigen::Vector3d after = sample.tip_World - rest_.tip_World;
  scatter_ += before * after.transpose();
  addTo(orientationSum_, sample.toolToWorld);
  rest_.endSec = sample.timeSec;
  rest_.lastSample = sample.index;
}

std::optional<Rest> StillnessDetector::current() const
{
  if (!isResting_)
  {
    return std::nullopt;
  }
  Rest rest = rest_;
  rest.tipCovariance = (scatter_ + scatter_.transpose()) / (2.0 * std::max(1, rest.count - 1));
  rest.rmsMm = std::sqrt(scatter_.trace() / double(rest.count));
  // The mean of cos(angle / 2) is 1 - angle^2 / 8 for angles that are not large.
  rest.turn = std::sqrt(8 * std::max(0.0, 1 - orientationSum_.norm() / double(rest.count)));
  rest.toolToWorld.linear() = orientationSum_.normalized().toRotationMatrix();
  rest.toolToWorld.translation() = rest.tip_World - rest.toolToWorld.linear() * tip_Tool_;
  rest.kind = options_.touch != StillnessOptions::Touch::Held && rest.turn >= options_.minimumPivoting ? Rest::Kind::Pivoted
                                                                                                       : Rest::Kind::Held;
  return rest;
}

std::optional<Rest> StillnessDetector::end()
{
  std::optional<Rest> rest = this->current();
  isResting_ = false;
  if (rest)
  {
    // The next rest begins after this one.
    const auto isPart = [&](const Sample& sample) { return sample.index <= rest->lastSample; };
    window_.erase(std::remove_if(window_.begin(), window_.end(), isPart), window_.end());
    if (options_.touch == StillnessOptions::Touch::Pivoted && rest->kind != Rest::Kind::Pivoted)
    {
      rest.reset();
    }
  }
  return rest;
}

std::optional<Rest> StillnessDetector::finish()
{
  std::optional<Rest> rest = this->end();
  window_.clear();
  return rest;
}

double StillnessDetector::progress() const
{
  return isResting_ ? 1 : std::clamp((newestSec_ - this->stillSince()) / options_.minimumDurationSec, 0.0, 1.0);
}

/// Since when the samples have been within the limits about the newest one.
double StillnessDetector::stillSince() const
{
  double sinceSec = newestSec_;
  for (auto sample = window_.rbegin(); sample != window_.rend(); ++sample)
  {
    if (!this->isWithin(*sample, window_.back().tip_World, window_.back().toolToWorld))
    {
      break;
    }
    sinceSec = sample->timeSec;
  }
  return sinceSec;
}

std::string toString(Rest::Kind kind)
{
  return kind == Rest::Kind::Pivoted ? "pivoted" : "held";
}

}  // namespace handeye
