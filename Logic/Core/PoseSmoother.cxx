// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PoseSmoother.h"

#include "RigidTransform.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace handeye
{

namespace
{

double timeConstantSec(double cutoffHz)
{
  return 1 / (2 * M_PI * cutoffHz);
}

/// The share by which the filter follows a measurement (equation 1).
double share(double stepSec, double cutoffHz)
{
  return 1 / (1 + timeConstantSec(cutoffHz) / stepSec);
}

Eigen::Vector3d rotationVector(const Eigen::Matrix3d& rotation)
{
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

void requirePositive(double value, const char* sentence)
{
  if (!(std::isfinite(value) && value > 0))
  {
    throw std::invalid_argument(sentence);
  }
}

void requireNotNegative(double value, const char* sentence)
{
  if (!(std::isfinite(value) && value >= 0))
  {
    throw std::invalid_argument(sentence);
  }
}

}  // namespace

void PoseSmootherOptions::check() const
{
  requirePositive(this->restCutoffHz, "the cutoff at rest must be more than 0 Hz");
  requireNotNegative(this->cutoffPerMmPerSec, "the cutoff by speed must be 0 or more Hz per mm/s");
  requireNotNegative(this->cutoffPerRadPerSec, "the cutoff by turning must be 0 or more Hz per rad/s");
  requirePositive(this->speedCutoffHz, "the cutoff of the speed must be more than 0 Hz");
  requirePositive(this->resetGapSec, "the gap after which the filter starts anew must be more than 0 s");
}

PoseSmoother::PoseSmoother(const PoseSmootherOptions& options)
  : options_(options)
{
  options_.check();
}

SmoothedPose PoseSmoother::add(double timeSec, const Eigen::Isometry3d& transform)
{
  if (!std::isfinite(timeSec) || !transform.matrix().allFinite())
  {
    throw std::invalid_argument("a pose or its time is not finite");
  }
  if (last_ && timeSec <= last_->timeSec)
  {
    return last_->result;
  }
  if (!last_ || timeSec - last_->timeSec > options_.resetGapSec)
  {
    last_ = Filter{ timeSec, transform, transform, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), { transform, 0, 0 } };
    return last_->result;
  }
  Filter& filter = *last_;
  const double stepSec = timeSec - filter.timeSec;
  const double speedShare = share(stepSec, options_.speedCutoffHz);
  const Eigen::Vector3d velocity = (transform.translation() - filter.measured.translation()) / stepSec;
  const Eigen::Matrix3d turned = filter.measured.linear().transpose() * transform.linear();
  const Eigen::Vector3d turnRate = rotationVector(turned) / stepSec;
  filter.velocityMm += speedShare * (velocity - filter.velocityMm);
  filter.turnRate += speedShare * (turnRate - filter.turnRate);

  const double shiftCutoffHz = options_.restCutoffHz + options_.cutoffPerMmPerSec * filter.velocityMm.norm();
  const double turnCutoffHz = options_.restCutoffHz + options_.cutoffPerRadPerSec * filter.turnRate.norm();
  filter.smoothed.translation() += share(stepSec, shiftCutoffHz) * (transform.translation() - filter.smoothed.translation());
  const Eigen::Matrix3d behind = filter.smoothed.linear().transpose() * transform.linear();
  const Eigen::Matrix3d follow = rotationFromVector(share(stepSec, turnCutoffHz) * rotationVector(behind));
  filter.smoothed.linear() = nearestRotation(filter.smoothed.linear() * follow);

  filter.timeSec = timeSec;
  filter.measured = transform;
  const double delaySec = timeConstantSec(std::min(shiftCutoffHz, turnCutoffHz));
  filter.result = { filter.smoothed, delaySec, shiftCutoffHz };
  return filter.result;
}

}  // namespace handeye
