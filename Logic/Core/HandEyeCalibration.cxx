// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeCalibration.h"

#include "RigidTransform.h"
#include "Statistics.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <random>
#include <sstream>
#include <stdexcept>

namespace handeye
{

namespace
{

using Samples = std::vector<HandEyeSample>;
using Eyes = std::vector<Eye>;
using Status = HandEyeCalibrationResult::Status;

constexpr std::size_t MinimalSet = 4;
constexpr int MostDraws = 300;
constexpr int RejectionRounds = 10;
constexpr int WeightRounds = 4;
/// A residual (px) that stands for a point behind the camera or outside of the lens model.
constexpr double NotSeenPx = 1e4;

double focalLength(const CameraModel& camera)
{
  return (camera.fx() + camera.fy()) / 2;
}

/// A sample as point and line, the line in the head's camera frame.
PointLinePair toPair(const HandEyeSample& sample, const Eyes& eyes, double weight)
{
  const Eigen::Isometry3d eyeToCamera = eyes[std::size_t(sample.eye)].cameraToEye.inverse();
  return { sample.tip_Marker, eyeToCamera.translation(), eyeToCamera.linear() * sample.ray_Eye, weight };
}

double residualPx(const HandEyeSample& sample, const Eyes& eyes, const Eigen::Isometry3d& markerToCamera)
{
  const Eye& eye = eyes[std::size_t(sample.eye)];
  const Eigen::Vector3d tip_Camera = markerToCamera * sample.tip_Marker;
  const CameraModel::Projection seen = eye.camera.project(eye.cameraToEye * tip_Camera);
  return seen.isUsable() ? (seen.point_Image - sample.ball_Image).norm() : NotSeenPx;
}

double distanceMm(const HandEyeSample& sample, const Eyes& eyes, const Eigen::Isometry3d& markerToCamera)
{
  const Eigen::Vector3d tip_Camera = markerToCamera * sample.tip_Marker;
  return (eyes[std::size_t(sample.eye)].cameraToEye * tip_Camera).norm();
}

double segmentationSigmaPx(const HandEyeSample& sample, const HandEyeCalibrationOptions& options)
{
  return sample.sigmaPx > 0 ? sample.sigmaPx : options.segmentationSigmaPx;
}

/// The expected error (one standard deviation per axis) of a sample at this distance: at the ball (mm), and in the image (px).
double expectedMm(const HandEyeSample& sample, double distance, const Eyes& eyes, const HandEyeCalibrationOptions& options)
{
  const double focal = focalLength(eyes[std::size_t(sample.eye)].camera);
  return std::hypot(options.trackingSigmaMm, segmentationSigmaPx(sample, options) * distance / focal);
}

double expectedPx(const HandEyeSample& sample, double distance, const Eyes& eyes, const HandEyeCalibrationOptions& options)
{
  const double atLeast1Mm = std::max(distance, 1.0);
  return expectedMm(sample, atLeast1Mm, eyes, options) * focalLength(eyes[std::size_t(sample.eye)].camera) / atLeast1Mm;
}

/// The solution of some of the samples; weights follow the distances that the solution itself gives.
PointLineResult solve(const Samples& samples, const std::vector<int>& subset, const Eyes& eyes,
  const HandEyeCalibrationOptions& options, PointLineOptions::Method method, int weightRounds)
{
  PointLineOptions pointLine;
  pointLine.method = method;
  pointLine.linesAreRays = true;
  std::vector<PointLinePair> pairs;
  for (int i : subset)
  {
    pairs.push_back(toPair(samples[std::size_t(i)], eyes, 1));
  }
  PointLineResult result = registerPointsToLines(pairs, pointLine);
  for (int round = 0; round < weightRounds && result.isUsable(); ++round)
  {
    for (std::size_t k = 0; k < subset.size(); ++k)
    {
      const HandEyeSample& sample = samples[std::size_t(subset[k])];
      const double distance = distanceMm(sample, eyes, result.pointsToLines);
      const double sigmaMm = expectedMm(sample, distance, eyes, options);
      pairs[k].weight = 1 / (sigmaMm * sigmaMm);
    }
    result = registerPointsToLines(pairs, pointLine);
  }
  return result;
}

/// Residuals of all samples in multiples of what is expected of them.
std::vector<double> normalizedResiduals(
  const Samples& samples, const Eyes& eyes, const Eigen::Isometry3d& markerToCamera, const HandEyeCalibrationOptions& options)
{
  std::vector<double> normalized;
  for (const HandEyeSample& sample : samples)
  {
    const double expected = expectedPx(sample, distanceMm(sample, eyes, markerToCamera), eyes, options);
    normalized.push_back(residualPx(sample, eyes, markerToCamera) / expected);
  }
  return normalized;
}

/// The next set of `MinimalSet` indices: all combinations where they are few, otherwise random draws.
std::vector<std::vector<int>> minimalSets(int count)
{
  std::vector<std::vector<int>> sets;
  const double combinations = double(count) * (count - 1) * (count - 2) * (count - 3) / 24;
  if (combinations <= MostDraws)
  {
    for (int a = 0; a < count; ++a)
      for (int b = a + 1; b < count; ++b)
        for (int c = b + 1; c < count; ++c)
          for (int d = c + 1; d < count; ++d)
            sets.push_back({ a, b, c, d });
    return sets;
  }
  std::mt19937 random(1590);
  std::vector<int> order(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
  {
    order[std::size_t(i)] = i;
  }
  for (int draw = 0; draw < MostDraws; ++draw)
  {
    for (std::size_t k = 0; k < MinimalSet; ++k)
    {
      std::uniform_int_distribution<std::size_t> any(k, order.size() - 1);
      std::swap(order[k], order[any(random)]);
    }
    sets.emplace_back(order.begin(), order.begin() + MinimalSet);
  }
  return sets;
}

std::vector<int> agreeing(const std::vector<double>& normalized, double limit)
{
  std::vector<int> kept;
  for (std::size_t i = 0; i < normalized.size(); ++i)
  {
    if (normalized[i] <= limit)
    {
      kept.push_back(int(i));
    }
  }
  return kept;
}

/// Samples that belong together: those that agree with the best minimal set, then with their own common solution.
std::vector<int> findConsensus(const Samples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options)
{
  std::vector<double> best;
  double bestScore = std::numeric_limits<double>::infinity();
  for (const std::vector<int>& set : minimalSets(int(samples.size())))
  {
    const PointLineResult candidate = solve(samples, set, eyes, options, PointLineOptions::Method::Global, 0);
    if (!candidate.isUsable())
    {
      continue;
    }
    // A minimal set is noisy, so agreement is judged by a capped cost rather than by a count.
    const std::vector<double> normalized = normalizedResiduals(samples, eyes, candidate.pointsToLines, options);
    double score = 0;
    for (double value : normalized)
    {
      score += std::min(value, 10 * options.rejectionFactor);
    }
    if (score < bestScore)
    {
      bestScore = score;
      best = normalized;
    }
  }
  if (best.empty())
  {
    return {};
  }
  std::vector<int> kept = agreeing(best, 3 * options.rejectionFactor * std::max(1.0, median(best) / MedianOfChi2));
  for (int round = 0; round < RejectionRounds && kept.size() >= MinimalSet; ++round)
  {
    const PointLineResult solution = solve(samples, kept, eyes, options, PointLineOptions::Method::Global, 2);
    if (!solution.isUsable())
    {
      return kept;
    }
    const std::vector<double> normalized = normalizedResiduals(samples, eyes, solution.pointsToLines, options);
    const double scale = std::max(1.0, median(normalized) / MedianOfChi2);
    std::vector<int> next = agreeing(normalized, options.rejectionFactor * scale);
    if (next == kept)
    {
      break;
    }
    kept = std::move(next);
  }
  return kept;
}

/// The covariance from the noise that is expected of each used sample, scaled by the scatter that was found if that is more.
/// @return that scatter in multiples of what was expected
double estimateCovariance(
  const Samples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, HandEyeCalibrationResult& result)
{
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  double squares = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    if (!result.samples[i].used)
    {
      continue;
    }
    const Eye& eye = eyes[std::size_t(samples[i].eye)];
    const Eigen::Vector3d tip_Camera = result.markerToCamera * samples[i].tip_Marker;
    const double distance = distanceMm(samples[i], eyes, result.markerToCamera);
    const double misfit = result.samples[i].residualMm / expectedMm(samples[i], distance, eyes, options);
    squares += misfit * misfit;
    Eigen::Matrix<double, 2, 3> byPoint;
    if (!eye.camera.project(eye.cameraToEye * tip_Camera, &byPoint).isUsable())
    {
      continue;
    }
    Eigen::Matrix<double, 3, 6> motion;
    motion << -skew(tip_Camera), Eigen::Matrix3d::Identity();
    const Eigen::Matrix<double, 2, 6> byPose =
      byPoint * eye.cameraToEye.linear() * motion / expectedPx(samples[i], distance, eyes, options);
    information += byPose.transpose() * byPose;
  }
  const double freedoms = std::max(1.0, 2.0 * result.usedCount - 6);
  const double varianceFactor = std::max(1.0, squares / freedoms);
  result.covariance = varianceFactor * information.inverse();
  return std::sqrt(squares / freedoms);
}

std::string oneDigit(double value)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << value;
  return text.str();
}

Status translate(PointLineResult::Status status)
{
  switch (status)
  {
    case PointLineResult::Status::Ok:
      return Status::Ok;
    case PointLineResult::Status::TooFewPairs:
      return Status::TooFewSamples;
    case PointLineResult::Status::NotObservable:
      return Status::NotObservable;
    case PointLineResult::Status::NotConverged:
      return Status::NotConverged;
    case PointLineResult::Status::Mirrored:
      return Status::Mirrored;
    case PointLineResult::Status::Ambiguous:
      return Status::Ambiguous;
  }
  return Status::NotObservable;
}

/// Residuals of every sample, sums over the used ones, covariance and verdict.
void conclude(const Samples& samples, const std::vector<int>& used, const Eyes& eyes, const HandEyeCalibrationOptions& options,
  HandEyeCalibrationResult& result)
{
  for (int i : used)
  {
    result.samples[std::size_t(i)].used = true;
  }
  double squaresPx = 0, squaresMm = 0;
  double nearest = std::numeric_limits<double>::infinity(), furthest = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    const PointLinePair pair = toPair(samples[i], eyes, 1);
    const Eigen::Vector3d offset = result.markerToCamera * pair.point_Points - pair.origin_Lines;
    HandEyeCalibrationResult::Sample& sample = result.samples[i];
    sample.residualMm = offset.cross(pair.direction_Lines.normalized()).norm();
    sample.residualPx = residualPx(samples[i], eyes, result.markerToCamera);
    if (sample.used)
    {
      squaresPx += sample.residualPx * sample.residualPx;
      squaresMm += sample.residualMm * sample.residualMm;
      const double depth = (result.markerToCamera * samples[i].tip_Marker).z();
      nearest = std::min(nearest, depth);
      furthest = std::max(furthest, depth);
    }
  }
  result.reprojectionRmsPx = std::sqrt(squaresPx / result.usedCount);
  result.pointToLineRmsMm = std::sqrt(squaresMm / result.usedCount);
  const double misfit = estimateCovariance(samples, eyes, options, result);
  result.predicted = predictProjectionError(result.covariance, eyes.front(), nearest, furthest);
  if (result.isUsable() && !(misfit <= options.maximumMisfit))
  {
    result.status = Status::PoorFit;
    result.message = "the solution misses its own samples by " + oneDigit(result.pointToLineRmsMm) +
      " mm (RMS): some of them show something else than the ball, or the stylus' tip is wrong";
  }
  else if (result.isUsable() && !(result.predicted.meanPx <= options.maximumPredictedErrorPx))
  {
    result.status = Status::TooUncertain;
    result.message = "the placements leave " + oneDigit(result.predicted.meanPx) +
      " px of predicted error over the working volume: spread them over the image and in depth";
  }
  else if (result.isUsable())
  {
    const char* verdict = result.predicted.meanPx < 1 ? "good: " : result.predicted.meanPx < 3 ? "fair: " : "poor: ";
    result.message = verdict + oneDigit(result.predicted.meanPx) + " px predicted over the working volume (" +
      oneDigit(result.predicted.maximumPx) + " px at worst), " + std::to_string(result.usedCount) + " of " +
      std::to_string(samples.size()) + " samples used";
  }
}

void checkSamples(const Samples& samples, const Eyes& eyes)
{
  if (eyes.empty())
  {
    throw std::invalid_argument("hand-eye calibration: no camera is given");
  }
  for (const HandEyeSample& sample : samples)
  {
    const bool finite = sample.tip_Marker.allFinite() && sample.ball_Image.allFinite() && sample.ray_Eye.allFinite();
    if (!finite || sample.eye < 0 || sample.eye >= int(eyes.size()) || !(sample.ray_Eye.norm() > 0))
    {
      throw std::invalid_argument("hand-eye calibration: sample of frame " + std::to_string(sample.frame) +
        " holds a number that is not finite, an empty ray or an eye that is not there");
    }
  }
}

}  // namespace

void HandEyeCalibrationOptions::check() const
{
  if (!(trackingSigmaMm >= 0) || !(segmentationSigmaPx >= 0) || !(trackingSigmaMm + segmentationSigmaPx > 0) ||
    minimumSamples < 4 || !(rejectionFactor > 1) || !(maximumRejectedShare >= 0 && maximumRejectedShare < 1) ||
    !(maximumMisfit > 0) || !(maximumPredictedErrorPx > 0))
  {
    throw std::invalid_argument(
      "hand-eye calibration options: noise of at least 0, at least 4 samples, a rejection factor above 1 are expected");
  }
}

HandEyeCalibrationResult calibrateHandEye(const Samples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options)
{
  options.check();
  checkSamples(samples, eyes);
  HandEyeCalibrationResult result;
  result.samples.resize(samples.size());
  if (int(samples.size()) < options.minimumSamples)
  {
    result.message = "only " + std::to_string(samples.size()) + " usable samples, at least " +
      std::to_string(options.minimumSamples) + " are needed (12 to 15 are recommended)";
    return result;
  }
  std::vector<int> used(samples.size());
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    used[i] = int(i);
  }
  if (options.rejectOutliers)
  {
    const std::vector<int> kept = findConsensus(samples, eyes, options);
    const double rejectedShare = 1 - double(kept.size()) / double(samples.size());
    if (kept.empty() || rejectedShare > options.maximumRejectedShare)
    {
      result.status = Status::NoConsensus;
      result.message = "no solution agrees with more than " + std::to_string(kept.size()) + " of " +
        std::to_string(samples.size()) +
        " samples: check the stylus' tip, the ball's radius and that the marker on the camera has not moved";
      return result;
    }
    if (int(kept.size()) < options.minimumSamples)
    {
      result.message = "only " + std::to_string(kept.size()) + " samples agree with each other, at least " +
        std::to_string(options.minimumSamples) + " are needed";
      return result;
    }
    used = kept;
  }
  const bool weighted = options.method == PointLineOptions::Method::Global;
  const PointLineResult solution = solve(samples, used, eyes, options, options.method, weighted ? WeightRounds : 0);
  result.status = translate(solution.status);
  result.message = solution.message;
  result.iterations = solution.iterations;
  result.conditionNumber = solution.conditionNumber;
  if (result.status == Status::NotObservable || result.status == Status::Mirrored)
  {
    return result;
  }
  result.markerToCamera = solution.pointsToLines;
  result.usedCount = int(used.size());
  conclude(samples, used, eyes, options, result);
  return result;
}

PredictedError predictProjectionError(
  const Eigen::Matrix<double, 6, 6>& covariance, const Eye& eye, double nearestMm, double furthestMm)
{
  constexpr int columns = 9, rows = 7, depths = 5;
  PredictedError error;
  error.nearestMm = nearestMm;
  error.furthestMm = furthestMm;
  const double width = eye.camera.hasImageSize() ? eye.camera.width() : 2 * eye.camera.cx() + 1;
  const double height = eye.camera.hasImageSize() ? eye.camera.height() : 2 * eye.camera.cy() + 1;
  int count = 0;
  for (int k = 0; k < depths * rows * columns; ++k)
  {
    const Eigen::Vector2d pixel((width - 1) * (k % columns) / (columns - 1), (height - 1) * (k / columns % rows) / (rows - 1));
    const double depth = nearestMm + (furthestMm - nearestMm) * (k / columns / rows) / (depths - 1);
    const CameraModel::Unprojection ray = eye.camera.unproject(pixel);
    if (!ray.isUsable())
    {
      continue;
    }
    const Eigen::Vector3d point_Eye = ray.ray_Camera * depth / ray.ray_Camera.z();
    const Eigen::Vector3d point_Camera = eye.cameraToEye.inverse() * point_Eye;
    Eigen::Matrix<double, 2, 3> byPoint;
    if (!eye.camera.project(point_Eye, &byPoint).isUsable())
    {
      continue;
    }
    Eigen::Matrix<double, 3, 6> motion;
    motion << -skew(point_Camera), Eigen::Matrix3d::Identity();
    const Eigen::Matrix<double, 2, 6> byPose = byPoint * eye.cameraToEye.linear() * motion;
    const double rms = std::sqrt(std::max(0.0, (byPose * covariance * byPose.transpose()).trace()));
    error.meanPx += rms;
    error.maximumPx = std::max(error.maximumPx, rms);
    ++count;
  }
  error.meanPx = count > 0 ? error.meanPx / count : std::numeric_limits<double>::infinity();
  return error;
}

std::string toString(Status status)
{
  switch (status)
  {
    case Status::Ok:
      return "ok";
    case Status::TooFewSamples:
      return "too_few_samples";
    case Status::NoConsensus:
      return "no_consensus";
    case Status::NotObservable:
      return "not_observable";
    case Status::NotConverged:
      return "not_converged";
    case Status::Mirrored:
      return "mirrored";
    case Status::Ambiguous:
      return "ambiguous";
    case Status::PoorFit:
      return "poor_fit";
    case Status::TooUncertain:
      return "too_uncertain";
  }
  return "unknown";
}

}  // namespace handeye
