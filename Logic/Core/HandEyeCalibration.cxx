// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeCalibration.h"

#include "HandEyeConsensus.h"
#include "HandEyePrediction.h"
#include "HandEyeResiduals.h"
#include "HandEyeTip.h"
#include "HandEyeUncertainty.h"
#include "HandEyeVerdict.h"
#include "Statistics.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace handeye
{

namespace
{

using Samples = HandEyeSamples;
using Status = HandEyeCalibrationResult::Status;

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
    case PointLineResult::Status::PoorFit:
      return Status::PoorFit;
    case PointLineResult::Status::NotApplicable:
      return Status::NotApplicable;
  }
  return Status::NotObservable;
}

/// Residuals of every sample, sums over the used ones, covariance and verdict.
void conclude(const Samples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, HandEyeCalibrationResult& result)
{
  double squaresPx = 0, squaresMm = 0;
  double nearest = std::numeric_limits<double>::infinity(), furthest = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    const PointLinePair pair = toPair(samples[i], eyes, 1);
    const Eigen::Vector3d offset = result.markerToCamera * pair.point_Points - pair.origin_Lines;
    HandEyeCalibrationResult::Sample& sample = result.samples[i];
    sample.residualMm = offset.cross(pair.direction_Lines.normalized()).norm();
    sample.residualPx = residualPx(samples[i], eyes, result.markerToCamera);
    sample.deviation =
      sample.residualPx / expectedPx(samples[i], distanceMm(samples[i], eyes, result.markerToCamera), eyes, options);
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
  for (const Eye& eye : eyes)
  {
    result.predictedByEye.push_back(predictError(result.covariance, eye, nearest, furthest));
  }
  result.predicted = result.predictedByEye.front();
  result.weakestFreedom = describeWeakestFreedom(result.covariance, (nearest + furthest) / 2);
  giveVerdict(samples, eyes, options, misfit, result);
}

/// Goes on with the noise that the residuals showed.
void takeEstimatedNoise(const PointLineResult& solution, Samples& samples, HandEyeCalibrationOptions& options)
{
  // A capture without any noise is not known to be without any.
  constexpr double least = 1e-3;
  options.trackingSigmaMm *= std::max(solution.sigmaMm, least);
  options.segmentationSigmaPx *= std::max(solution.sigmaRad, least);
  for (HandEyeSample& sample : samples)
  {
    sample.sigmaPx *= std::max(solution.sigmaRad, least);
  }
}

/// Goes on with the tip that fits best, if it was found.
void takeRefinedTip(const HandEyeCalibrationResult& result, Samples& samples, HandEyeCalibrationOptions& options)
{
  if (!result.tipCorrection_Stylus)
  {
    return;
  }
  options.tipCovariance_Stylus = result.refinedTipCovariance_Stylus;
  for (HandEyeSample& sample : samples)
  {
    sample.tip_Marker += sample.stylusToMarker * *result.tipCorrection_Stylus;
  }
}

/// The median of the segmentation's sigma over the used samples.
double typicalSigmaPx(const Samples& samples, const std::vector<int>& used, const HandEyeCalibrationOptions& options)
{
  std::vector<double> sigmas;
  for (int i : used)
  {
    const double sigma = samples[std::size_t(i)].sigmaPx;
    sigmas.push_back(sigma > 0 ? sigma : options.segmentationSigmaPx);
  }
  return median(sigmas);
}

void checkSamples(const Samples& samples, const Eyes& eyes)
{
  if (eyes.empty())
  {
    throw std::invalid_argument("hand-eye calibration: no camera is given");
  }
  for (const HandEyeSample& sample : samples)
  {
    const bool finite = sample.tip_Marker.allFinite() && sample.ball_Image.allFinite() && sample.ray_Eye.allFinite() &&
      sample.stylusToMarker.allFinite() && std::isfinite(sample.sigmaPx) && std::isfinite(sample.apparentDistanceMm);
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
    !(maximumMisfit > 0) || !(maximumScaleError > 0) || !(maximumPredictedErrorPx > 0) || !tipCovariance_Stylus.allFinite() ||
    (estimateNoise && !(trackingSigmaMm > 0 && segmentationSigmaPx > 0)))
  {
    throw std::invalid_argument(
      "hand-eye calibration options: noise of at least 0, at least 4 samples, a rejection factor above 1 are expected");
  }
}

HandEyeCalibrationResult calibrateHandEye(const Samples& givenSamples, const Eyes& eyes, const HandEyeCalibrationOptions& given)
{
  Samples samples = givenSamples;
  HandEyeCalibrationOptions options = given;
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
        std::to_string(samples.size()) + " samples: check the stylus' tip, the names of the tools, and that no marker has slipped";
      blameLens(samples, eyes, options, result);
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
  const PointLineResult solution =
    solveHandEye(samples, used, eyes, options, options.method, weighted ? HandEyeWeightRounds : 0, true);
  result.status = translate(solution.status);
  result.message = solution.message;
  result.iterations = solution.iterations;
  result.conditionNumber = solution.conditionNumber;
  result.rank = solution.rank;
  if (result.status == Status::NotObservable || result.status == Status::Mirrored || result.status == Status::NotApplicable)
  {
    return result;
  }
  result.markerToCamera = solution.pointsToLines;
  result.usedCount = int(used.size());
  for (int i : used)
  {
    result.samples[std::size_t(i)].used = true;
  }
  if (options.estimateNoise && options.method == PointLineOptions::Method::MaximumLikelihood && result.isUsable())
  {
    takeEstimatedNoise(solution, samples, options);
  }
  result.trackingSigmaMm = options.trackingSigmaMm;
  result.segmentationSigmaPx = typicalSigmaPx(samples, used, options);
  if (options.refineTip && result.isUsable())
  {
    refineTip(samples, eyes, options, result);
    takeRefinedTip(result, samples, options);
  }
  conclude(samples, eyes, options, result);
  return result;
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
    case Status::NotApplicable:
      return "not_applicable";
    case Status::WrongScale:
      return "wrong_scale";
    case Status::MarkerMoved:
      return "marker_moved";
    case Status::PoorFit:
      return "poor_fit";
    case Status::TooUncertain:
      return "too_uncertain";
  }
  return "unknown";
}

}  // namespace handeye
