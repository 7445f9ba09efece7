// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PivotCollector.h"

#include "PivotMethods.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace handeye
{

namespace
{

/// The estimate is renewed when so many poses, and such a share of them, are new.
constexpr std::size_t RenewedAfter = 10;
constexpr std::size_t RenewedShare = 10;
/// Kept poses that are asked for one of a crowded orientation.
constexpr int AskedToGiveWay = 16;
/// Poses over which "of late" reaches.
constexpr double LatePoses = 40;
constexpr double MovedShare = 0.6;
/// Below this residual (mm) no pose disagrees.
constexpr double ResolutionMm = 0.05;

}  // namespace

void PivotCollectorOptions::check() const
{
  calibration.check();
  if (!(enoughTipErrorMm > 0) || capacity < 2 * std::size_t(calibration.minimumPoses) ||
    !(domeAngle > 0 && domeAngle < EIGEN_PI / 2))
  {
    throw std::invalid_argument(
      "pivot collector options: a positive limit (mm), a capacity of twice the least number of poses or more, "
      "and a dome of less than 90 deg are expected");
  }
}

double DomeCoverage::share() const
{
  return double(std::count_if(poses.begin(), poses.end(), [](int count) { return count > 0; })) / Cells;
}

int DomeCoverage::covered() const
{
  return int(std::count_if(poses.begin(), poses.end(), [](int count) { return count >= PosesEach; }));
}

PivotCollector::PivotCollector(const PivotCollectorOptions& options)
  : options_(options)
  , crowd_(OrientationCells, 0)
{
  options_.check();
  poses_.reserve(options_.capacity);
  this->reset();
}

void PivotCollector::reset()
{
  poses_.clear();
  std::fill(crowd_.begin(), crowd_.end(), std::uint16_t(0));
  counts_ = {};
  estimate_ = calibratePivot({}, options_.calibration);
  hasLast_ = false;
  changes_ = 0;
  disagreement_ = 0;
  random_ = 1;
}

PivotCollector::Outcome PivotCollector::addInvalid()
{
  ++counts_.invalid;
  return Outcome::Invalid;
}

PivotCollector::Outcome PivotCollector::add(const Eigen::Isometry3d& stylusToTracker)
{
  if (!stylusToTracker.matrix().allFinite())
  {
    return this->addInvalid();
  }
  if (hasLast_ && isSamePose(last_, stylusToTracker))
  {
    ++counts_.repeated;
    return Outcome::Repeated;
  }
  last_ = stylusToTracker;
  hasLast_ = true;
  const bool disagrees = this->disagrees(stylusToTracker);
  disagreement_ += ((disagrees ? 1.0 : 0.0) - disagreement_) / LatePoses;
  if (disagrees)
  {
    ++counts_.disagreeing;
    return Outcome::Disagrees;
  }
  return this->keep(stylusToTracker);
}

/// The residual against the noise of the poses that stay, and against what the tip may still be off.
bool PivotCollector::disagrees(const Eigen::Isometry3d& stylusToTracker) const
{
  if (!estimate_.isUsable())
  {
    return false;
  }
  const double residualMm = (stylusToTracker * estimate_.tip_Stylus - estimate_.pivot_Tracker).norm();
  const double noiseMm = estimate_.rmsMm / std::sqrt(3.0) + std::sqrt(estimate_.tipCovariance.trace());
  return residualMm > std::max(ResolutionMm, 1.5 * options_.calibration.rejectionFactor * noiseMm);
}

PivotCollector::Outcome PivotCollector::keep(const Eigen::Isometry3d& stylusToTracker)
{
  const std::size_t cell = orientationCell(stylusToTracker.linear());
  if (poses_.size() < options_.capacity)
  {
    poses_.push_back(stylusToTracker);
  }
  else
  {
    std::size_t giving = 0, most = 0;
    for (int asked = 0; asked < AskedToGiveWay; ++asked)
    {
      random_ = random_ * 1664525U + 1013904223U;
      const std::size_t slot = (random_ >> 8) % poses_.size();
      const std::size_t crowd = crowd_[orientationCell(poses_[slot].linear())];
      if (crowd > most)
      {
        most = crowd;
        giving = slot;
      }
    }
    if (crowd_[cell] + 1U >= most)
    {
      ++counts_.redundant;
      return Outcome::Redundant;
    }
    --crowd_[orientationCell(poses_[giving].linear())];
    --counts_.kept;
    ++counts_.redundant;
    // The order stays that of time: whether the tip moved is judged by it.
    poses_.erase(poses_.begin() + std::ptrdiff_t(giving));
    poses_.push_back(stylusToTracker);
  }
  ++crowd_[cell];
  ++counts_.kept;
  ++changes_;
  if (changes_ >= std::max(RenewedAfter, poses_.size() / RenewedShare))
  {
    this->renew();
  }
  return Outcome::Kept;
}

void PivotCollector::renew()
{
  changes_ = 0;
  estimate_ = calibratePivot(poses_, options_.calibration);
  if (estimate_.isUsable())
  {
    this->dropRejected();
  }
}

/// What disagrees or repeats makes room.
void PivotCollector::dropRejected()
{
  std::size_t kept = 0, next = 0;
  for (std::size_t i = 0; i < poses_.size(); ++i)
  {
    if (next < estimate_.rejections.size() && estimate_.rejections[next].index == int(i))
    {
      const bool isRepeated = estimate_.rejections[next].reason == PivotRejection::Reason::Repeated;
      ++(isRepeated ? counts_.repeated : counts_.disagreeing);
      --counts_.kept;
      --crowd_[orientationCell(poses_[i].linear())];
      ++next;
      continue;
    }
    poses_[kept++] = poses_[i];
  }
  poses_.resize(kept);
}

PivotCalibrationResult PivotCollector::calibrate() const
{
  return calibratePivot(poses_, options_.calibration);
}

PivotCollector::Counts PivotCollector::countsWith(const PivotCalibrationResult& result) const
{
  Counts counts = counts_;
  for (const PivotRejection& rejection : result.rejections)
  {
    const bool isRepeated = rejection.reason == PivotRejection::Reason::Repeated;
    ++(isRepeated ? counts.repeated : counts.disagreeing);
    --counts.kept;
  }
  return counts;
}

double PivotCollector::predictedTipErrorMm() const
{
  return estimate_.isUsable() ? std::sqrt(estimate_.tipCovariance.trace()) : std::numeric_limits<double>::infinity();
}

bool PivotCollector::hasTipMoved() const
{
  return estimate_.status == PivotCalibrationResult::Status::TipMoved || disagreement_ > MovedShare;
}

bool PivotCollector::isEnough() const
{
  return estimate_.isUsable() && !this->hasTipMoved() && this->predictedTipErrorMm() < options_.enoughTipErrorMm;
}

DomeCoverage PivotCollector::coverage() const
{
  DomeCoverage coverage;
  if (estimate_.tip_Stylus.norm() == 0)
  {
    return coverage;
  }
  const Eigen::Vector3d shaft_Stylus = -estimate_.tip_Stylus.normalized();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Isometry3d& pose : poses_)
  {
    mean += pose.linear() * shaft_Stylus;
  }
  const Eigen::Matrix3d upright = Eigen::Quaterniond::FromTwoVectors(mean, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (const Eigen::Isometry3d& pose : poses_)
  {
    const Eigen::Vector3d shaft_Tracker = pose.linear() * shaft_Stylus;
    const Eigen::Vector3d shaft_Dome = upright * shaft_Tracker;
    const double lean = std::atan2(std::hypot(shaft_Dome.x(), shaft_Dome.y()), shaft_Dome.z());
    const int ring = int(std::min(2.0, 3 * lean / options_.domeAngle));
    const double heading = std::atan2(shaft_Dome.y(), shaft_Dome.x()) + EIGEN_PI;
    const int sector = std::min(DomeCoverage::Sectors - 1, int(heading / (2 * EIGEN_PI) * DomeCoverage::Sectors));
    ++coverage.poses[std::size_t(ring == 0 ? 0 : 1 + (ring - 1) * DomeCoverage::Sectors + sector)];
  }
  return coverage;
}

}  // namespace handeye
