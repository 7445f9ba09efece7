// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PivotCalibration.h"

#include "NumberWords.h"
#include "PivotJudgement.h"
#include "PivotMethods.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace handeye
{

namespace
{

using Status = PivotCalibrationResult::Status;

void checkPoses(const PivotPoses& poses)
{
  for (std::size_t i = 0; i < poses.size(); ++i)
  {
    if (!poses[i].matrix().allFinite())
    {
      throw std::invalid_argument("pivot calibration: pose " + std::to_string(i) + " holds a number that is not finite");
    }
  }
}

void solveBy(const PivotPoses& poses, const std::vector<int>& different, const PivotCalibrationOptions& options,
  PivotCalibrationResult& result)
{
  PivotSolution solution;
  result.used = different;
  switch (options.method)
  {
    case PivotMethod::Robust:
    {
      RobustPivot robust = solveRobust(poses, different, options);
      solution = robust.solution;
      result.used = std::move(robust.used);
      break;
    }
    case PivotMethod::AlgebraicOneStep:
      solution = solveOneStep(poses, different);
      break;
    case PivotMethod::AlgebraicTwoStep:
      solution = solveTwoStep(poses, different);
      break;
    case PivotMethod::SphereFit:
      solution = solveSphereFit(poses, different);
      break;
  }
  result.tip_Stylus = solution.tip_Stylus;
  result.pivot_Tracker = solution.pivot_Tracker;
  result.tipCovariance = solution.tipCovariance;
}

/// Residuals of all poses, and what they come to over the used ones.
void measureResiduals(const PivotPoses& poses, const TrackerNoise& noise, PivotCalibrationResult& result)
{
  const double length = result.tip_Stylus.norm();
  const ResidualVariance expected = residualVariance(noise, length);
  double sum = 0, squares = 0, whitened = 0;
  std::size_t next = 0;
  result.residualsMm.resize(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
  {
    const Eigen::Vector3d lever = poses[i].linear() * result.tip_Stylus;
    const Eigen::Vector3d residual = lever + poses[i].translation() - result.pivot_Tracker;
    const double square = residual.squaredNorm(), size = std::sqrt(square);
    result.residualsMm[i] = size;
    if (next < result.used.size() && result.used[next] == int(i))
    {
      ++next;
      const double along = length > 0 ? lever.dot(residual) / length : 0;
      sum += size;
      squares += square;
      whitened += along * along / expected.along + (square - along * along) / expected.across;
      result.maximumMm = std::max(result.maximumMm, size);
    }
  }
  const double count = double(result.used.size());
  result.meanMm = sum / count;
  result.rmsMm = std::sqrt(squares / count);
  result.noiseFactor = std::sqrt(whitened / std::max(1.0, 3 * count - 6));
}

void measureRotation(const PivotPoses& poses, PivotCalibrationResult& result)
{
  PivotSums sums;
  for (int i : result.used)
  {
    sums.add(poses[std::size_t(i)]);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(sums.spread());
  result.rotationSpread = spread.eigenvalues().cwiseMax(0).cwiseSqrt();
  result.weakAxis_Stylus = spread.eigenvectors().col(0);
  const double along = result.tip_Stylus.dot(result.weakAxis_Stylus);
  result.weakAxisDistanceMm = (result.tip_Stylus - along * result.weakAxis_Stylus).norm();
  result.angularRange = leaningRange(poses, result.used, result.tip_Stylus);
}

void listRejections(const std::vector<int>& different, PivotCalibrationResult& result)
{
  std::set_difference(
    different.begin(), different.end(), result.used.begin(), result.used.end(), std::back_inserter(result.rejected));
  for (int i : result.rejected)
  {
    result.rejections.push_back({ i, PivotRejection::Reason::Disagrees, result.residualsMm[std::size_t(i)] });
  }
  for (int i : result.repeated)
  {
    result.rejections.push_back({ i, PivotRejection::Reason::Repeated, result.residualsMm[std::size_t(i)] });
  }
  std::sort(result.rejections.begin(), result.rejections.end(),
    [](const PivotRejection& a, const PivotRejection& b) { return a.index < b.index; });
}

/// @return whether there are too few poses; the result then says so
bool refuseCount(std::size_t different, const PivotCalibrationOptions& options, PivotCalibrationResult& result)
{
  if (int(different) >= options.minimumPoses)
  {
    return false;
  }
  const std::string needed = ", at least " + std::to_string(options.minimumPoses) + " are needed";
  if (result.repeated.empty())
  {
    result.message = "only " + std::to_string(different) + " valid poses" + needed;
    return true;
  }
  const std::size_t all = different + result.repeated.size();
  result.status = int(all) >= options.minimumPoses ? Status::TooLittleRotation : Status::TooFewPoses;
  result.message = "only " + std::to_string(different) + " of " + std::to_string(all) + " poses differ from one another" + needed +
    ": the stylus was hardly turned, or the tracker repeated itself";
  return true;
}

}  // namespace

void PivotCalibrationOptions::check() const
{
  if (minimumPoses < 3 || !(rejectionFactor > 1) || !(minimumRotation > 0) || !(maximumRejectedShare > 0) || !(maximumRmsMm > 0))
  {
    throw std::invalid_argument(
      "pivot calibration options: at least 3 poses, a rejection factor above 1 and positive limits are expected");
  }
  if (!(noise.positionMm > 0 && noise.rotation >= 0 && std::isfinite(noise.positionMm) && std::isfinite(noise.rotation)))
  {
    throw std::invalid_argument(
      "pivot calibration options: a positive noise of the position (mm) and one of the rotation that is not negative are expected");
  }
}

PivotCalibrationResult calibratePivot(const PivotPoses& stylusToTracker, const PivotCalibrationOptions& options)
{
  options.check();
  checkPoses(stylusToTracker);
  PivotCalibrationResult result;
  result.method = options.method;
  std::vector<int> different;
  findRepeated(stylusToTracker, different, result.repeated);
  if (refuseCount(different.size(), options, result))
  {
    return result;
  }
  solveBy(stylusToTracker, different, options, result);
  measureResiduals(stylusToTracker, options.noise, result);
  measureRotation(stylusToTracker, result);
  listRejections(different, result);
  judgePivot(stylusToTracker, different, options, result);
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

std::string toString(PivotMethod method)
{
  switch (method)
  {
    case PivotMethod::Robust:
      return "robust";
    case PivotMethod::AlgebraicOneStep:
      return "algebraic-one-step";
    case PivotMethod::AlgebraicTwoStep:
      return "algebraic-two-step";
    case PivotMethod::SphereFit:
      return "sphere-fit";
  }
  return "unknown";
}

std::string toString(PivotRejection::Reason reason)
{
  return reason == PivotRejection::Reason::Repeated ? "repeated" : "disagrees";
}

}  // namespace handeye
