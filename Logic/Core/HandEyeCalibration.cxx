// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeCalibration.h"

#include "HandEyeConsensus.h"
#include "HandEyePrediction.h"
#include "HandEyeResiduals.h"
#include "HandEyeTip.h"
#include "HandEyeUncertainty.h"
#include "NumberWords.h"
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

constexpr int WeightRounds = 4;
/// A predicted error (px) from which on a calibration is poor.
constexpr double PoorPx = 3;
/// Balls within this share of the image's width and of its height are all in one spot.
constexpr double CrampedShare = 0.25;

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

/// The median of (distance by apparent size / distance by tracking) of the used samples; 1 where sizes are not known.
double apparentScale(const Samples& samples, const Eyes& eyes, const HandEyeCalibrationResult& result)
{
  std::vector<double> ratios;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    if (result.samples[i].used && samples[i].apparentDistanceMm > 0)
    {
      ratios.push_back(samples[i].apparentDistanceMm / std::max(1e-9, distanceMm(samples[i], eyes, result.markerToCamera)));
    }
  }
  return ratios.empty() ? 1 : median(ratios);
}

/// Where the used balls are, if they are all in one spot of each eye's image: ", all balls being in the upper left of the image".
std::string crampedSpot(const Samples& samples, const Eyes& eyes, const HandEyeCalibrationResult& result)
{
  std::string where;
  for (std::size_t eye = 0; eye < eyes.size(); ++eye)
  {
    const CameraModel& camera = eyes[eye].camera;
    Eigen::AlignedBox2d box;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      if (result.samples[i].used && samples[i].eye == int(eye))
      {
        box.extend(samples[i].ball_Image);
      }
    }
    const Eigen::Vector2d image(
      camera.hasImageSize() ? camera.width() : 2 * camera.cx() + 1, camera.hasImageSize() ? camera.height() : 2 * camera.cy() + 1);
    if (!box.isEmpty() && (box.sizes().array() > CrampedShare * image.array()).any())
    {
      return {};
    }
    if (!box.isEmpty() && where.empty())
    {
      const Eigen::Vector2d share = box.center().cwiseQuotient(image);
      const std::string down = share.y() < 0.4 ? "upper " : share.y() > 0.6 ? "lower " : "";
      const std::string across = share.x() < 0.4 ? "left" : share.x() > 0.6 ? "right" : "middle";
      where = ", all balls being in the " + down + across + " of the image";
    }
  }
  return where;
}

/// The samples that were left out, if they are a run of four or more at the beginning or the end of the capture; otherwise none.
std::vector<int> leftOutRun(const Samples& samples, const HandEyeCalibrationResult& result)
{
  constexpr std::size_t fewest = 4;
  const std::size_t leftOut = samples.size() - std::size_t(result.usedCount);
  if (leftOut < fewest)
  {
    return {};
  }
  // As they are given, one eye after the other: an eye as a whole may be wrong. And by frames: a marker slips for both eyes.
  std::vector<int> asGiven(samples.size());
  std::iota(asGiven.begin(), asGiven.end(), 0);
  std::vector<int> byFrame = asGiven;
  std::stable_sort(
    byFrame.begin(), byFrame.end(), [&](int a, int b) { return samples[std::size_t(a)].frame < samples[std::size_t(b)].frame; });
  const auto isLeftOut = [&](int i) { return !result.samples[std::size_t(i)].used; };
  for (const std::vector<int>& order : { asGiven, byFrame })
  {
    const auto first = order.begin() + std::ptrdiff_t(leftOut), last = order.end() - std::ptrdiff_t(leftOut);
    if (std::all_of(order.begin(), first, isLeftOut))
    {
      return { order.begin(), first };
    }
    if (std::all_of(last, order.end(), isLeftOut))
    {
      return { last, order.end() };
    }
  }
  return {};
}

/// Whether something slipped: what was left out is one run, and agrees with itself on another solution.
bool hasSlipped(
  const Samples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, const HandEyeCalibrationResult& result)
{
  const std::vector<int> run = leftOutRun(samples, result);
  if (run.empty())
  {
    return false;
  }
  const PointLineResult other = solveHandEye(samples, run, eyes, options, PointLineOptions::Method::Global, WeightRounds);
  if (!other.isUsable())
  {
    return false;
  }
  const std::vector<double> normalized = normalizedResiduals(samples, eyes, other.pointsToLines, options);
  return std::all_of(run.begin(), run.end(), [&](int i) { return normalized[std::size_t(i)] < options.rejectionFactor; });
}

/// What is to be said of a solution, and whether it is usable at all.
/// @param misfit the residuals over what their noise explains
void giveVerdict(const Samples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, double misfit,
  HandEyeCalibrationResult& result)
{
  if (!result.isUsable())
  {
    return;
  }
  const std::string spot = crampedSpot(samples, eyes, result);
  const double scale = apparentScale(samples, eyes, result);
  if (result.placeCount < options.minimumSamples)
  {
    result.status = Status::TooFewSamples;
    result.message = "the ball was at " + std::to_string(result.placeCount) + " places only, at least " +
      std::to_string(options.minimumSamples) + " are needed (12 to 15 are recommended)";
  }
  else if (!(misfit <= options.maximumMisfit))
  {
    result.status = Status::PoorFit;
    result.message = "the solution misses its own samples by " + fixedDigits(result.pointToLineRmsMm, 1) +
      " mm (RMS): some of them show something else than the ball, or the stylus' tip is wrong";
  }
  else if (std::abs(std::log(scale)) > std::log(1 + options.maximumScaleError))
  {
    result.status = Status::WrongScale;
    result.message = "by its apparent size the ball is " + significantDigits(scale, 3) +
      " times as far away as by tracking: check the ball's radius (mm) and the focal length of the camera file";
  }
  else if (hasSlipped(samples, eyes, options, result))
  {
    result.status = Status::MarkerMoved;
    result.message = std::to_string(samples.size() - std::size_t(result.usedCount)) +
      " samples in a row, at one end of the capture, agree with each other but not with the rest: " +
      (eyes.size() > 1 ? "the relation of the eyes is wrong, or a marker has slipped" : "a marker has slipped");
  }
  else if (!(result.predicted.meanPx <= options.maximumPredictedErrorPx))
  {
    result.status = Status::TooUncertain;
    result.message = "the placements leave " + fixedDigits(result.predicted.meanPx, 1) +
      " px of predicted error over the working volume" + spot + ": spread them over the image and in depth; what they determine " +
      "least is " + result.weakestFreedom;
  }
  else if (!(result.predicted.meanPx < PoorPx) && !spot.empty())
  {
    result.status = Status::TooUncertain;
    result.message = "poor: " + fixedDigits(result.predicted.meanPx, 1) + " px predicted over the working volume" + spot +
      ": spread them over the image and in depth; what they determine least is " + result.weakestFreedom;
  }
  else
  {
    const char* verdict = result.predicted.meanPx < 1 ? "good: " : result.predicted.meanPx < PoorPx ? "fair: " : "poor: ";
    result.message = verdict + fixedDigits(result.predicted.meanPx, 1) + " px predicted over the working volume (" +
      fixedDigits(result.predicted.maximumPx, 1) + " px at worst), " + std::to_string(result.usedCount) + " of " +
      std::to_string(samples.size()) + " samples used" +
      (result.predicted.meanPx < PoorPx ? "" : "; what they determine least is " + result.weakestFreedom);
  }
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
  const PointLineResult solution = solveHandEye(samples, used, eyes, options, options.method, weighted ? WeightRounds : 0, true);
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
