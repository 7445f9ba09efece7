// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PivotCalibration.h"

#include "NumberWords.h"
#include "Statistics.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace handeye
{

namespace
{

using Poses = std::vector<Eigen::Isometry3d>;
using Status = PivotCalibrationResult::Status;

constexpr int ConsensusDraws = 400;
constexpr int RejectionRounds = 20;
/// Below this residual (mm) nothing is thrown out: no optical tracker resolves it.
constexpr double ResolutionMm = 0.01;

/// The centred normal equations: with R' = R - mean(R), p' = p - mean(p), the tip minimises sum |R' tip + p'|^2.
struct NormalEquations
{
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d tip_Stylus = Eigen::Vector3d::Zero();
  Eigen::Vector3d pivot_Tracker = Eigen::Vector3d::Zero();
};

NormalEquations solve(const Poses& poses, const std::vector<int>& subset)
{
  Eigen::Matrix3d meanRotation = Eigen::Matrix3d::Zero();
  Eigen::Vector3d meanPosition = Eigen::Vector3d::Zero();
  for (int i : subset)
  {
    meanRotation += poses[i].linear() / double(subset.size());
    meanPosition += poses[i].translation() / double(subset.size());
  }
  NormalEquations normal;
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (int i : subset)
  {
    const Eigen::Matrix3d centred = poses[i].linear() - meanRotation;
    normal.matrix += centred.transpose() * centred;
    right -= centred.transpose() * (poses[i].translation() - meanPosition);
  }
  normal.tip_Stylus = normal.matrix.completeOrthogonalDecomposition().solve(right);
  normal.pivot_Tracker = meanRotation * normal.tip_Stylus + meanPosition;
  return normal;
}

std::vector<double> residuals(const Poses& poses, const NormalEquations& solution)
{
  std::vector<double> lengths;
  lengths.reserve(poses.size());
  for (const Eigen::Isometry3d& stylusToTracker : poses)
  {
    lengths.push_back((stylusToTracker * solution.tip_Stylus - solution.pivot_Tracker).norm());
  }
  return lengths;
}

/// The triple of poses whose tip leaves the smallest median residual over all poses.
NormalEquations consensus(const Poses& poses)
{
  std::mt19937 random(20170420);
  std::uniform_int_distribution<int> any(0, int(poses.size()) - 1);
  NormalEquations best;
  double bestMedian = std::numeric_limits<double>::infinity();
  for (int draw = 0; draw < ConsensusDraws; ++draw)
  {
    const std::vector<int> triple = { any(random), any(random), any(random) };
    const NormalEquations candidate = solve(poses, triple);
    const double typical = median(residuals(poses, candidate));
    if (typical < bestMedian)
    {
      bestMedian = typical;
      best = candidate;
    }
  }
  return best;
}

std::vector<int> inliers(const std::vector<double>& lengths, double factor)
{
  const double sigma = median(lengths) / MedianOfChi3;
  const double limit = std::max(factor * sigma, ResolutionMm);
  std::vector<int> kept;
  for (std::size_t i = 0; i < lengths.size(); ++i)
  {
    if (lengths[i] <= limit)
    {
      kept.push_back(int(i));
    }
  }
  return kept;
}

/// How far the tip moved between the two halves of the used poses: the difference of where it stood on average.
double tipMotion(const Poses& poses, const PivotCalibrationResult& result)
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

void judge(PivotCalibrationResult& result, std::size_t poseCount, double tipMotionMm, const PivotCalibrationOptions& options)
{
  const double degrees = 180 / EIGEN_PI;
  const double rejectedShare = double(result.rejected.size()) / double(poseCount);
  if (result.rotationSpread(1) < options.minimumRotation)
  {
    result.status = Status::TooLittleRotation;
    result.message = "the stylus was hardly turned (" + fixedDigits(result.rotationSpread(2) * degrees, 1) +
      " deg at most): tilt it by 30 deg or more in all directions while its tip rests in the divot";
  }
  else if (result.rotationSpread(0) < options.minimumRotation)
  {
    result.status = Status::RotationAboutOneAxis;
    result.message = "the stylus was turned about one axis only: tilt it forwards and backwards as well as left and right";
  }
  else if (rejectedShare > options.maximumRejectedShare)
  {
    result.status = Status::TooManyRejected;
    result.message = "no tip explains " + std::to_string(result.rejected.size()) + " of " + std::to_string(poseCount) +
      " poses: the tip left its divot, or another tool was recorded";
  }
  else if (!(result.tip_Stylus.norm() >= options.nearestTipMm && result.tip_Stylus.norm() <= options.furthestTipMm))
  {
    result.status = Status::ImplausibleTip;
    result.message = "the tip came out " + fixedDigits(result.tip_Stylus.norm(), 1) + " mm from the marker, expected " +
      fixedDigits(options.nearestTipMm, 0) + " to " + fixedDigits(options.furthestTipMm, 0) +
      " mm: are the poses in mm, and do they map the stylus to the tracker?";
  }
  else if (!(tipMotionMm <= options.maximumTipMotionMm))
  {
    result.status = Status::TipMoved;
    result.message = "the tip moved by " + fixedDigits(tipMotionMm, 2) +
      " mm between the first and the second half of the recording, more than the " + fixedDigits(options.maximumTipMotionMm, 1) +
      " mm that a usable result allows: it slipped in the divot, or the divot moved";
  }
  else if (result.rmsMm > options.maximumRmsMm)
  {
    result.status = Status::TooNoisy;
    result.message = "the tip moved by " + fixedDigits(result.rmsMm, 2) + " mm (RMS) while pivoting, more than the " +
      fixedDigits(options.maximumRmsMm, 1) + " mm that a usable result allows";
  }
  else
  {
    result.status = Status::Ok;
    result.message = "tip found with " + fixedDigits(result.rmsMm, 2) + " mm RMS over " + std::to_string(result.used.size()) +
      " poses, " + std::to_string(result.rejected.size()) + " left out";
  }
}

}  // namespace

void PivotCalibrationOptions::check() const
{
  if (minimumPoses < 3 || !(rejectionFactor > 1) || !(minimumRotation > 0) || !(maximumRejectedShare > 0) || !(maximumRmsMm > 0))
  {
    throw std::invalid_argument(
      "pivot calibration options: at least 3 poses, a rejection factor above 1 and positive limits are expected");
  }
}

PivotCalibrationResult calibratePivot(const Poses& stylusToTracker, const PivotCalibrationOptions& options)
{
  options.check();
  for (const Eigen::Isometry3d& pose : stylusToTracker)
  {
    if (!pose.matrix().allFinite())
    {
      throw std::invalid_argument("pivot calibration: a pose holds a number that is not finite");
    }
  }
  PivotCalibrationResult result;
  if (int(stylusToTracker.size()) < options.minimumPoses)
  {
    result.message = "only " + std::to_string(stylusToTracker.size()) + " valid poses, at least " +
      std::to_string(options.minimumPoses) + " are needed";
    return result;
  }

  NormalEquations solution = consensus(stylusToTracker);
  result.residualsMm = residuals(stylusToTracker, solution);
  result.used = inliers(result.residualsMm, options.rejectionFactor);
  for (int round = 0; round < RejectionRounds; ++round)
  {
    solution = solve(stylusToTracker, result.used);
    result.residualsMm = residuals(stylusToTracker, solution);
    const std::vector<int> kept = inliers(result.residualsMm, options.rejectionFactor);
    if (kept == result.used)
    {
      break;
    }
    result.used = kept;
  }

  result.tip_Stylus = solution.tip_Stylus;
  result.pivot_Tracker = solution.pivot_Tracker;
  double squares = 0;
  for (int i = 0, next = 0; i < int(stylusToTracker.size()); ++i)
  {
    if (next < int(result.used.size()) && result.used[next] == i)
    {
      ++next;
      squares += result.residualsMm[i] * result.residualsMm[i];
      result.maximumMm = std::max(result.maximumMm, result.residualsMm[i]);
    }
    else
    {
      result.rejected.push_back(i);
    }
  }
  const double count = double(result.used.size());
  result.rmsMm = std::sqrt(squares / count);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(solution.matrix / count);
  result.rotationSpread = spread.eigenvalues().cwiseMax(0).cwiseSqrt();
  if (result.rotationSpread(0) > 0)
  {
    result.tipCovariance = squares / std::max(1.0, 3 * count - 6) * solution.matrix.inverse();
  }
  judge(result, stylusToTracker.size(), tipMotion(stylusToTracker, result), options);
  return result;
}

std::string toString(Status status)
{
  switch (status)
  {
    case Status::Ok:
      return "ok";
    case Status::TooFewPoses:
      return "too_few_poses";
    case Status::RotationAboutOneAxis:
      return "rotation_about_one_axis";
    case Status::TooLittleRotation:
      return "too_little_rotation";
    case Status::TooManyRejected:
      return "too_many_rejected";
    case Status::TipMoved:
      return "tip_moved";
    case Status::ImplausibleTip:
      return "implausible_tip";
    case Status::TooNoisy:
      return "too_noisy";
  }
  return "unknown";
}

}  // namespace handeye
