// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeStudy.h"
#include "NumberWords.h"
#include "StudyConditions.h"
#include "StudyMethods.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace handeye::study
{

namespace
{

/// The paper's factor between branch and bound and point-to-line on the laparoscope.
constexpr double ReportedFactor = 3;
constexpr std::size_t MostRivalsNamed = 2;

std::string px(double value)
{
  return fixedDigits(value, 2) + " px";
}

using Predicate = bool (*)(const MethodResult&);

using Quantity = double (*)(const MethodResult&);

double meanOf(const MethodResult& method)
{
  return method.errorPx.mean;
}

double maximumOf(const MethodResult& method)
{
  return method.errorPx.maximum;
}

/// Others that have no more of something than `ours`, the least first; at least the best of them.
std::vector<const MethodResult*> rivalsIn(
  const ComparisonResult& comparison, const MethodResult& ours, Quantity quantity, Predicate isRival = isOfThePaper)
{
  std::vector<const MethodResult*> rivals;
  for (const MethodResult& method : comparison.methods)
  {
    if (isRival(method) && method.isUsable())
    {
      rivals.push_back(&method);
    }
  }
  std::stable_sort(
    rivals.begin(), rivals.end(), [&](const MethodResult* a, const MethodResult* b) { return quantity(*a) < quantity(*b); });
  while (rivals.size() > 1 && quantity(*rivals.back()) > quantity(ours))
  {
    rivals.pop_back();
  }
  return rivals;
}

struct Place
{
  std::size_t capture = 0, sample = 0;
  double errorPx = 0;
};

/// Where a method has its largest error.
std::optional<Place> worstOf(const MethodResult& method)
{
  std::optional<Place> worst;
  for (std::size_t capture = 0; capture < method.captures.size(); ++capture)
  {
    const std::vector<HandEyeValidationSample>& samples = method.captures[capture].validation.samples;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      if (samples[i].status == CameraModel::Status::Ok && (!worst || samples[i].errorPx > worst->errorPx))
      {
        worst = Place{ capture, i, samples[i].errorPx };
      }
    }
  }
  return worst;
}

std::optional<double> errorAt(const MethodResult& method, const Place& place)
{
  if (place.capture >= method.captures.size() || place.sample >= method.captures[place.capture].validation.samples.size())
  {
    return std::nullopt;
  }
  const HandEyeValidationSample& sample = method.captures[place.capture].validation.samples[place.sample];
  return sample.status == CameraModel::Status::Ok ? std::make_optional(sample.errorPx) : std::nullopt;
}

double quantileOf(const MethodResult& method, double share)
{
  std::vector<double> errors;
  for (const ComparedCapture& capture : method.captures)
  {
    for (const HandEyeValidationSample& sample : capture.validation.samples)
    {
      if (sample.status == CameraModel::Status::Ok)
      {
        errors.push_back(sample.errorPx);
      }
    }
  }
  std::sort(errors.begin(), errors.end());
  return errors.empty() ? 0 : errors[std::size_t(share * double(errors.size() - 1))];
}

/// A maximum is one sample: how much of it is the calibration's, how much the noise of the moment at which it was validated.
std::string reasonOfMaximum(const StudyCameraResult& result, const MethodResult& ours, const MethodResult& rival)
{
  const std::optional<Place> worst = worstOf(ours);
  const MethodResult *trueOurs = findMethod(result.truth, ours.name), *trueRival = findMethod(result.truth, rival.name);
  if (!worst || trueOurs == nullptr || trueRival == nullptr)
  {
    return {};
  }
  std::string text = "A maximum is one sample of " + std::to_string(ours.errorPx.count) + ".";
  if (const std::optional<double> own = errorAt(*trueOurs, *worst))
  {
    text += " At that ball the calibration is off by " + px(*own) + " itself; the rest of the " + px(worst->errorPx) +
      " is the tracker's noise while it was validated, which alone reaches " + px(result.floorPx.maximum) + ".";
  }
  const double oursQuantile = quantileOf(ours, 0.99), rivalQuantile = quantileOf(rival, 0.99);
  return text + " 99 % of the samples are below " + px(oursQuantile) + " (" + rival.name + " " + px(rivalQuantile) +
    "); without the validation's noise the largest errors are " + px(trueOurs->errorPx.maximum) + " and " +
    px(trueRival->errorPx.maximum) + ".";
}

/// What of a board is better in this study than in practice; empty where nothing is.
std::string favourWords(const StudyNoise& noise)
{
  std::string text;
  const std::pair<const char*, bool> parts[] = { { "print", noise.boardScaleShare < BoardScaleOfPractice },
    { "corners", noise.cornerSigmaPx < CornerPxOfPractice },
    { "lens", noise.lensFocalShare < LensFocalOfPractice && noise.lensCenterPx < LensCenterPxOfPractice } };
  for (const auto& [part, isBetter] : parts)
  {
    text += !isBetter ? "" : (text.empty() ? " Better here than in practice, which favours the board: " : ", ") + std::string(part);
  }
  return text.empty() ? text : text + ".";
}

/// What becomes of the two under the study's conditions; empty where they were not looked into.
std::string conditionWords(const StudyCameraResult& result, const MethodResult& ours, const MethodResult& rival)
{
  std::string text;
  for (const StudyConditionResult& condition : result.byCondition)
  {
    const MethodResult *trueOurs = findMethod(condition.truth, ours.name), *trueRival = findMethod(condition.truth, rival.name);
    if (trueOurs != nullptr && trueRival != nullptr)
    {
      text += (text.empty() ? "" : "; ") + condition.words + ": " + fixedDigits(trueOurs->errorPx.mean, 2) + " and " +
        px(trueRival->errorPx.mean);
    }
  }
  return text.empty()
    ? text
    : favourWords(result.noise) + " Own mean errors of " + ours.name + " and " + rival.name + " by condition: " + text + ".";
}

/// What one sample gives to a method with a ball and one with a board.
std::string sampleWords(const StudyCameraResult& result)
{
  return "A ball takes two tracked markers a sample and gives one point; a view of a board that stands still takes one and gives " +
    std::to_string(result.camera.board.pointCount()) + ".";
}

/// The calibrations' own means: the noise of what each was calibrated from.
std::string reasonOfOwnMean(const StudyCameraResult& result, const MethodResult& ours, const MethodResult& rival)
{
  return rival.name + " has " + px(rival.errorPx.mean) + " against " + px(ours.errorPx.mean) +
    ", without any noise of the validation. " + sampleWords(result) + conditionWords(result, ours, rival);
}

/// The calibrations' own maxima: each is one sample of one calibration, which the means and the bulk of the samples need not follow.
std::string reasonOfOwnMaximum(const MethodResult& ours, const MethodResult& rival)
{
  return rival.name + " has a mean of " + px(rival.errorPx.mean) + " against " + px(ours.errorPx.mean) +
    ", 99 % of the samples below " + px(quantileOf(rival, 0.99)) + " against " + px(quantileOf(ours, 0.99)) + ": the largest of " +
    std::to_string(ours.errorPx.count) + " errors is that of a single calibration.";
}

std::string reasonOfMean(const StudyCameraResult& result, const MethodResult& ours, const MethodResult& rival)
{
  return "A perfect calibration with the true lens would show " + px(result.floorPx.mean) + ". " + sampleWords(result) +
    conditionWords(result, ours, rival);
}

std::string reasonOfTrackedBoard(const StudyCameraResult& result)
{
  return "It is not one of the paper's five. Each of its views has " + std::to_string(result.camera.board.pointCount()) +
    " points, whose places on its marker are known exactly here" + (result.noise.boardScaleShare > 0 ? " but for the print" : "") +
    "; in practice they are touched with the stylus, and that error is added.";
}

StudyCheck compare(const std::string& what, const ComparisonResult& comparison, const MethodResult& ours, Quantity quantity,
  Predicate isRival = isOfThePaper)
{
  StudyCheck check;
  check.what = what;
  check.measured = ours.name + " " + px(quantity(ours));
  std::vector<const MethodResult*> rivals = rivalsIn(comparison, ours, quantity, isRival);
  check.holds =
    std::none_of(rivals.begin(), rivals.end(), [&](const MethodResult* rival) { return quantity(*rival) <= quantity(ours); });
  rivals.resize(std::min(rivals.size(), MostRivalsNamed));
  for (const MethodResult* rival : rivals)
  {
    check.measured += ", " + rival->name + " " + px(quantity(*rival));
  }
  return check;
}

/// How many times the error of branch and bound is by the range of the board's directions, in the same repetitions.
std::string tiltWords(const StudyCameraResult& result)
{
  std::string text;
  std::size_t repetitions = 0;
  for (const StudyTiltResult& tilt : result.byTilt)
  {
    const MethodResult *ours = findMethod(tilt.comparison, "ml"), *rival = findMethod(tilt.comparison, "branch-and-bound");
    const std::optional<double> ratio = ours != nullptr && rival != nullptr ? ratioOfMeans(*rival, *ours) : std::nullopt;
    if (ratio)
    {
      repetitions = std::min(ours->captures.size(), rival->captures.size());
      text += (text.empty() ? " By how far off its normal the board was looked at: " : ", ") + fixedDigits(*ratio, 1) +
        " times up to " + fixedDigits(tilt.tiltDeg, 0) + " degrees";
    }
  }
  return text.empty() ? text
                      : text + ", over the " + std::to_string(repetitions) +
      " repetitions that have a branch and bound: a still board gives the rotation through the camera's own turning only, and the "
      "factor is that of a camera that is hardly turned.";
}

std::optional<StudyCheck> checkFactor(const StudyCameraResult& result, const MethodResult& ours)
{
  const MethodResult* rival = findMethod(result.comparison, "branch-and-bound");
  const MethodResult *trueOurs = findMethod(result.truth, ours.name), *trueRival = findMethod(result.truth, "branch-and-bound");
  if (result.camera.name != "laparoscope" || rival == nullptr || trueOurs == nullptr || trueRival == nullptr)
  {
    return std::nullopt;
  }
  StudyCheck check;
  check.what = "branch-and-bound has at least " + fixedDigits(ReportedFactor, 0) + " times the mean";
  const double factor = rival->errorPx.mean / ours.errorPx.mean, own = trueRival->errorPx.mean / trueOurs->errorPx.mean;
  check.holds = factor >= ReportedFactor;
  check.measured = fixedDigits(factor, 2) + " times; own errors " + fixedDigits(own, 2) + " times";
  if (!check.holds)
  {
    check.reason = px(result.floorPx.mean) + " of the " + px(ours.errorPx.mean) +
      " are the tracker's noise while it was validated, which both methods show: three times would take a calibration that is " +
      px(std::sqrt(std::max(0.0, std::pow(ReportedFactor * ours.errorPx.mean, 2) - std::pow(result.floorPx.mean, 2)))) + " off." +
      tiltWords(result);
  }
  return check;
}

}  // namespace

std::vector<StudyCheck> checkClaims(const StudyCameraResult& result)
{
  const MethodResult *ours = findMethod(result.comparison, "ml"), *trueOurs = findMethod(result.truth, "ml");
  std::vector<StudyCheck> checks;
  if (ours == nullptr || trueOurs == nullptr || rivalsIn(result.comparison, *ours, meanOf).empty())
  {
    return checks;
  }
  StudyCheck mean = compare("lowest mean, as validated", result.comparison, *ours, meanOf);
  mean.reason = mean.holds ? "" : reasonOfMean(result, *ours, *rivalsIn(result.comparison, *ours, meanOf).front());
  StudyCheck maximum = compare("lowest maximum, as validated", result.comparison, *ours, maximumOf);
  maximum.reason = maximum.holds ? "" : reasonOfMaximum(result, *ours, *rivalsIn(result.comparison, *ours, maximumOf).front());
  StudyCheck ownMean = compare("lowest mean of the calibrations' own errors", result.truth, *trueOurs, meanOf);
  ownMean.reason = ownMean.holds ? "" : reasonOfOwnMean(result, *trueOurs, *rivalsIn(result.truth, *trueOurs, meanOf).front());
  StudyCheck ownMaximum = compare("lowest maximum of the calibrations' own errors", result.truth, *trueOurs, maximumOf);
  ownMaximum.reason = ownMaximum.holds ? "" : reasonOfOwnMaximum(*trueOurs, *rivalsIn(result.truth, *trueOurs, maximumOf).front());
  checks = { mean, maximum, ownMean, ownMaximum };
  if (!rivalsIn(result.comparison, *ours, meanOf, isWithTrackedBoard).empty())
  {
    checks.push_back(
      compare("lower mean than a board that is tracked itself", result.comparison, *ours, meanOf, isWithTrackedBoard));
    checks.back().isOfThePaper = false;
    checks.back().reason = checks.back().holds ? "" : reasonOfTrackedBoard(result);
  }
  if (const std::optional<StudyCheck> factor = checkFactor(result, *ours))
  {
    checks.push_back(*factor);
  }
  return checks;
}

}  // namespace handeye::study
