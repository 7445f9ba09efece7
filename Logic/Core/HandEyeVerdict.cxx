// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeVerdict.h"

#include "HandEyeConsensus.h"
#include "HandEyeLens.h"
#include "NumberWords.h"
#include "Statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace handeye
{

namespace
{

using Samples = HandEyeSamples;
using Status = HandEyeCalibrationResult::Status;

/// A predicted error (px) from which on a calibration is poor.
constexpr double PoorPx = 3;
/// Balls within this share of the image's width and of its height are all in one spot.
constexpr double CrampedShare = 0.25;

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
  const PointLineResult other = solveHandEye(samples, run, eyes, options, PointLineOptions::Method::Global, HandEyeWeightRounds);
  if (!other.isUsable())
  {
    return false;
  }
  const std::vector<double> normalized = normalizedResiduals(samples, eyes, other.pointsToLines, options);
  return std::all_of(run.begin(), run.end(), [&](int i) { return normalized[std::size_t(i)] < options.rejectionFactor; });
}

std::string scaleWords(double scale)
{
  return "by its apparent size the ball is " + significantDigits(scale, 3) +
    " times as far away as by tracking: check the ball's radius (mm) and the focal length of the camera file";
}

/// A lens that is not this camera's, in words; empty if it is not to be blamed. Sets the result's flag.
std::string lensWords(
  const Samples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, HandEyeCalibrationResult& result)
{
  const std::optional<double> focalScale = betterFocalScale(samples, eyes, options);
  result.isLensSuspect = focalScale.has_value();
  return focalScale ? "; with a focal length of " + significantDigits(*focalScale, 2) +
      " times that of the camera file the samples fit much better: is the file of this camera, and of this zoom and focus?"
                    : "";
}

/// What lies near for a calibration that is worse than it should be.
std::string reasonForPoor(const HandEyeCalibrationResult& result, double scale, const std::string& ofLens)
{
  if (!ofLens.empty())
  {
    return ofLens;
  }
  constexpr double OddScale = 0.05;  // a shaded limb makes 0.01 to 0.04
  return std::abs(std::log(scale)) > std::log(1 + OddScale) ? "; " + scaleWords(scale)
                                                            : "; what they determine least is " + result.weakestFreedom;
}

}  // namespace

void blameLens(
  const HandEyeSamples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, HandEyeCalibrationResult& result)
{
  if (result.status == Status::NoConsensus || result.status == Status::NotConverged || result.status == Status::PoorFit)
  {
    result.message += lensWords(samples, eyes, options, result);
  }
}

void giveVerdict(const Samples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, double misfit,
  HandEyeCalibrationResult& result)
{
  if (!result.isUsable())
  {
    blameLens(samples, eyes, options, result);
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
      " mm (RMS): some of them show something else than the ball, or the stylus' tip is wrong" +
      lensWords(samples, eyes, options, result);
  }
  else if (std::abs(std::log(scale)) > std::log(1 + options.maximumScaleError))
  {
    result.status = Status::WrongScale;
    result.message = scaleWords(scale);
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
      (result.predicted.meanPx < PoorPx ? "" : reasonForPoor(result, scale, lensWords(samples, eyes, options, result)));
  }
}
}  // namespace handeye
