// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PivotJudgement.h"

#include "NumberWords.h"
#include "Statistics.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

using Status = PivotCalibrationResult::Status;

constexpr double Degrees = 180 / EIGEN_PI;
/// Fewer poses in a row are no place where the tip stood.
constexpr std::size_t ShortestStay = 10;
/// Share of the poses of a stay that agree on where the tip then stood, and how closely (mm, or multiples of the RMS).
constexpr double StayAgreement = 0.7;
constexpr double StayRadiusMm = 0.5;

/// A part of the recording during which the tip stood somewhere else.
struct Stay
{
  int first = 0, last = 0;  ///< poses
  std::size_t count = 0;
  double distanceMm = 0;  ///< from where it stood otherwise
};

/// The run of poses in which the rejected ones prevail; empty if there is none. One used pose outweighs nine rejected ones.
std::pair<std::size_t, std::size_t> longestRejectedRun(const std::vector<int>& different, const std::vector<int>& used)
{
  std::pair<std::size_t, std::size_t> best{ 0, 0 };
  int sum = 0, bestSum = 0;
  std::size_t begin = 0, next = 0;
  for (std::size_t k = 0; k < different.size(); ++k)
  {
    const bool isUsed = next < used.size() && used[next] == different[k];
    next += isUsed ? 1 : 0;
    sum += isUsed ? -9 : 1;
    if (sum <= 0)
    {
      sum = 0;
      begin = k + 1;
    }
    else if (sum > bestSum)
    {
      bestSum = sum;
      best = { begin, k + 1 };
    }
  }
  return best;
}

std::optional<Stay> findStayElsewhere(
  const PivotPoses& poses, const std::vector<int>& different, const PivotCalibrationResult& result)
{
  const auto [begin, end] = longestRejectedRun(different, result.used);
  if (end - begin < ShortestStay)
  {
    return std::nullopt;
  }
  std::vector<double> coordinates[3];
  for (std::size_t k = begin; k < end; ++k)
  {
    const Eigen::Vector3d tip_Tracker = poses[std::size_t(different[k])] * result.tip_Stylus;
    for (int axis = 0; axis < 3; ++axis)
    {
      coordinates[axis].push_back(tip_Tracker(axis));
    }
  }
  const Eigen::Vector3d center(median(coordinates[0]), median(coordinates[1]), median(coordinates[2]));
  const double radius = std::max(StayRadiusMm, 3 * result.rmsMm);
  std::size_t agreeing = 0;
  for (std::size_t k = begin; k < end; ++k)
  {
    agreeing += (poses[std::size_t(different[k])] * result.tip_Stylus - center).norm() < radius ? 1 : 0;
  }
  if (double(agreeing) < StayAgreement * double(end - begin))
  {
    return std::nullopt;
  }
  return Stay{ different[begin], different[end - 1], end - begin, (center - result.pivot_Tracker).norm() };
}

std::string describe(const Stay& stay)
{
  return "the tip stood " + fixedDigits(stay.distanceMm, 1) + " mm away in poses " + std::to_string(stay.first) + " to " +
    std::to_string(stay.last);
}

/// How far the tip moved between the two halves of the used poses: the difference of where it stood on average.
double tipMotion(const PivotPoses& poses, const PivotCalibrationResult& result)
{
  Eigen::Vector3d halves[2] = { Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero() };
  const std::size_t middle = result.used.size() / 2;
  for (std::size_t k = 0; k < result.used.size(); ++k)
  {
    const double count = double(k < middle ? middle : result.used.size() - middle);
    halves[k < middle ? 0 : 1] += poses[std::size_t(result.used[k])] * result.tip_Stylus / count;
  }
  return (halves[1] - halves[0]).norm();
}

/// Which axis: in the stylus' own frame, with its nearest coordinate axis named, and where it runs.
std::string describeAxis(const PivotCalibrationResult& result)
{
  Eigen::Vector3d axis = result.weakAxis_Stylus;
  Eigen::Index largest = 0;
  const double nearness = axis.cwiseAbs().maxCoeff(&largest);
  axis *= axis(largest) < 0 ? -1 : 1;
  const std::string name =
    nearness > std::cos(20 / Degrees) ? std::string("near its ") + "xyz"[largest] + " axis, " : std::string();
  return name + "direction (" + fixedDigits(axis.x(), 2) + ", " + fixedDigits(axis.y(), 2) + ", " + fixedDigits(axis.z(), 2) +
    ") in the stylus' frame, " + fixedDigits(result.weakAxisDistanceMm, 0) + " mm from its marker";
}

void refuse(PivotCalibrationResult& result, Status status, const std::string& message)
{
  result.status = status;
  result.message = message;
}

bool refuseRotation(PivotCalibrationResult& result, const PivotCalibrationOptions& options)
{
  if (result.rotationSpread(1) < options.minimumRotation)
  {
    refuse(result, Status::TooLittleRotation,
      "the stylus was hardly turned (" + fixedDigits(result.rotationSpread(2) * Degrees, 1) +
        " deg at most): tilt it by 30 deg or more in all directions while its tip rests in the divot");
    return true;
  }
  if (result.rotationSpread(0) < options.minimumRotation)
  {
    refuse(result, Status::RotationAboutOneAxis,
      "the stylus was turned about one axis only (" + describeAxis(result) +
        "): tilt it forwards and backwards as well as left and right");
    return true;
  }
  return false;
}

}  // namespace

Eigen::Vector2d leaningRange(const PivotPoses& poses, const std::vector<int>& used, const Eigen::Vector3d& tip_Stylus)
{
  if (used.empty() || tip_Stylus.norm() == 0)
  {
    return Eigen::Vector2d::Zero();
  }
  const Eigen::Vector3d shaft_Stylus = -tip_Stylus.normalized();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (int i : used)
  {
    const Eigen::Vector3d shaft_Tracker = poses[std::size_t(i)].linear() * shaft_Stylus;
    mean += shaft_Tracker;
    squares += shaft_Tracker * shaft_Tracker.transpose();
  }
  mean.normalize();
  // The principal directions across the mean: what is along it gets the largest eigenvalue and goes last.
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - mean * mean.transpose();
  const Eigen::Matrix3d projected = across * squares;
  const Eigen::Matrix3d lifted = projected * across + 2 * squares.trace() * (mean * mean.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(lifted);
  Eigen::Vector2d range;
  for (int k = 0; k < 2; ++k)
  {
    const Eigen::Vector3d direction = axes.eigenvectors().col(1 - k);
    double least = 10, most = -10;
    for (int i : used)
    {
      const Eigen::Vector3d shaft_Tracker = poses[std::size_t(i)].linear() * shaft_Stylus;
      const double lean = std::asin(std::clamp(shaft_Tracker.dot(direction), -1.0, 1.0));
      least = std::min(least, lean);
      most = std::max(most, lean);
    }
    range(k) = most - least;
  }
  return range;
}

void judgePivot(const PivotPoses& poses, const std::vector<int>& different, const PivotCalibrationOptions& options,
  PivotCalibrationResult& result)
{
  if (refuseRotation(result, options))
  {
    return;
  }
  const std::string ofPoses = std::to_string(result.rejected.size()) + " of " + std::to_string(different.size()) + " poses";
  const std::optional<Stay> stay = findStayElsewhere(poses, different, result);
  const double distance = result.tip_Stylus.norm(), motionMm = tipMotion(poses, result);
  if (double(result.rejected.size()) > options.maximumRejectedShare * double(different.size()))
  {
    refuse(result, Status::TooManyRejected,
      "no tip explains " + ofPoses + ": the tip left its divot, or another tool was recorded" +
        (stay ? "; " + describe(*stay) : ""));
  }
  else if (!(distance >= options.nearestTipMm && distance <= options.furthestTipMm))
  {
    refuse(result, Status::ImplausibleTip,
      "the tip came out " + fixedDigits(distance, 1) + " mm from the marker, expected " + fixedDigits(options.nearestTipMm, 0) +
        " to " + fixedDigits(options.furthestTipMm, 0) + " mm: are the poses in mm, and do they map the stylus to the tracker?");
  }
  else if (stay && double(stay->count) >= options.movedShare * double(different.size()))
  {
    refuse(result, Status::TipMoved, describe(*stay) + ": it slipped in the divot, or the divot moved");
  }
  else if (!(motionMm <= options.maximumTipMotionMm))
  {
    refuse(result, Status::TipMoved,
      "the tip moved by " + fixedDigits(motionMm, 2) +
        " mm between the first and the second half of the recording, more than the " + fixedDigits(options.maximumTipMotionMm, 1) +
        " mm that a usable result allows: it slipped in the divot, or the divot moved");
  }
  else if (result.rmsMm > options.maximumRmsMm)
  {
    refuse(result, Status::TooNoisy,
      "the tip moved by " + fixedDigits(result.rmsMm, 2) + " mm (RMS) while pivoting, more than the " +
        fixedDigits(options.maximumRmsMm, 1) + " mm that a usable result allows");
  }
  else
  {
    result.status = Status::Ok;
    result.message = "tip found with " + fixedDigits(result.rmsMm, 2) + " mm RMS over " + std::to_string(result.used.size()) +
      " poses, " + std::to_string(result.rejected.size()) + " left out";
  }
}

}  // namespace handeye
