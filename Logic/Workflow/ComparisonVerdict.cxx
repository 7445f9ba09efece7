// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MethodComparison.h"
#include "NumberWords.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

namespace handeye
{

namespace
{

/// A method with fewer than this share of what the most reliable one has is not ranked with the others.
constexpr double LeastSuccess = 0.9;

/// Errors (px) by capture and sample.
using ErrorMap = std::map<std::pair<int, int>, double>;

/// For pairing methods.
ErrorMap errorsOf(const MethodResult& method)
{
  ErrorMap errors;
  for (std::size_t capture = 0; capture < method.captures.size(); ++capture)
  {
    const std::vector<HandEyeValidationSample>& samples = method.captures[capture].validation.samples;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      if (samples[i].status == CameraModel::Status::Ok)
      {
        errors[{ int(capture), int(i) }] = samples[i].errorPx;
      }
    }
  }
  return errors;
}

/// The mean error over the captures at each validation sample.
ErrorMap averagedOverCaptures(const ErrorMap& errors)
{
  std::map<int, std::vector<double>> bySample;
  for (const auto& [key, error] : errors)
  {
    bySample[key.second].push_back(error);
  }
  ErrorMap averaged;
  for (const auto& [sample, values] : bySample)
  {
    averaged[{ 0, sample }] = summarize(values).mean;
  }
  return averaged;
}

bool shareCaptures(const ComparisonResult& result, const MethodResult& a, const MethodResult& b)
{
  return result.hasPairedCaptures || a.target == b.target;
}

/// How far (px) another capture would have moved the method's calibration, where that is known.
double expectedShift(const MethodResult& method)
{
  const Repeatability& spread = method.repeatability;
  const double oneCapture = spread.areHalves ? spread.projectionPx / std::sqrt(2.0) : spread.projectionPx;
  return spread.calibrations > 1 ? oneCapture / std::sqrt(std::max(1.0, double(method.usableCount()))) : 0;
}

/// Whether the mean of the paired differences is within twice its standard error. The errors of one calibration go together, so the
/// capture is the unit from 5 captures on; below that the samples are, and a difference must exceed what another capture would have
/// changed as well.
/// Methods with different targets have captures of their own, each of which might have been another.
bool areAlike(const ComparisonResult& result, const MethodResult& a, const MethodResult& b)
{
  const bool share = shareCaptures(result, a, b);
  std::map<int, std::vector<double>> byCapture;
  const ErrorMap ofA = share ? errorsOf(a) : averagedOverCaptures(errorsOf(a));
  const ErrorMap ofB = share ? errorsOf(b) : averagedOverCaptures(errorsOf(b));
  for (const auto& [key, error] : ofA)
  {
    const auto other = ofB.find(key);
    if (other != ofB.end())
    {
      byCapture[key.first].push_back(other->second - error);
    }
  }
  std::vector<double> differences;
  for (const auto& [capture, values] : byCapture)
  {
    if (byCapture.size() >= 5)
    {
      differences.push_back(summarize(values).mean);
    }
    else
    {
      differences.insert(differences.end(), values.begin(), values.end());
    }
  }
  if (differences.size() < 2)
  {
    return true;
  }
  const Summary summary = summarize(differences);
  const double noise = 2 * summary.standardDeviation / std::sqrt(double(summary.count));
  const double shift = share ? expectedShift(a) : std::hypot(expectedShift(a), expectedShift(b));
  return std::abs(summary.mean) <= std::max(noise, byCapture.size() >= 5 ? 0.0 : shift);
}

std::string errorWords(const MethodResult& method)
{
  return fixedDigits(method.commonErrorPx.mean, 2) + " px mean, " + fixedDigits(method.commonErrorPx.maximum, 2) + " px at most";
}

/// Of `errors` those that the method has as well; and the method's there.
ErrorMap alsoIn(const ErrorMap& errors, const ErrorMap& method)
{
  ErrorMap both;
  for (const auto& [key, error] : errors)
  {
    if (method.count(key) > 0)
    {
      both[key] = error;
    }
  }
  return both;
}

Summary summaryOf(const ErrorMap& errors)
{
  std::vector<double> values;
  for (const auto& [key, error] : errors)
  {
    values.push_back(error);
  }
  return summarize(values);
}

/// Of the errors of a method those where all of `others` that share its captures have one, at samples for which the rest has one in
/// any capture.
ErrorMap commonErrors(const ComparisonResult& result, const MethodResult& method, const std::vector<int>& others)
{
  ErrorMap common = errorsOf(method);
  std::map<ComparedMethod::Target, ErrorMap> elsewhere;
  for (const int index : others)
  {
    const MethodResult& other = result.methods[std::size_t(index)];
    if (shareCaptures(result, method, other))
    {
      common = alsoIn(common, errorsOf(other));
      continue;
    }
    const auto [found, isFirst] = elsewhere.emplace(other.target, errorsOf(other));
    found->second = isFirst ? found->second : alsoIn(found->second, errorsOf(other));
  }
  for (const auto& [target, errors] : elsewhere)
  {
    const ErrorMap seen = averagedOverCaptures(errors);
    for (auto one = common.begin(); one != common.end();)
    {
      one = seen.count({ 0, one->first.second }) > 0 ? std::next(one) : common.erase(one);
    }
  }
  return common;
}

/// What a method compares with others by; its own errors where they have nothing in common. Each validation sample has the same
/// weight for methods whose captures differ.
void findCommonErrors(ComparisonResult& result, const std::vector<int>& ranked)
{
  const auto target = [&](int index) { return result.methods[std::size_t(index)].target; };
  const bool areMixed =
    std::any_of(ranked.begin(), ranked.end(), [&](int index) { return target(index) != target(ranked.front()); });
  for (const int index : ranked)
  {
    MethodResult& method = result.methods[std::size_t(index)];
    const ErrorMap common = commonErrors(result, method, ranked);
    method.commonErrorPx = common.empty() ? method.errorPx : summaryOf(common);
    if (areMixed && !result.hasPairedCaptures && !common.empty())
    {
      method.commonErrorPx.mean = summaryOf(averagedOverCaptures(common)).mean;
    }
  }
}

/// Whose results are complete enough to be ranked; the others go into `incomplete`, those with most results first.
std::vector<int> sortOutIncomplete(ComparisonResult& result)
{
  double best = 0;
  for (const MethodResult& method : result.methods)
  {
    best = std::max(best, method.isUsable() ? method.successShare : 0);
  }
  std::vector<int> ranked;
  for (std::size_t i = 0; i < result.methods.size(); ++i)
  {
    MethodResult& method = result.methods[i];
    method.commonErrorPx = {};
    if (method.isUsable())
    {
      (method.successShare >= LeastSuccess * best ? ranked : result.incomplete).push_back(int(i));
    }
  }
  const auto share = [&](int index) { return result.methods[std::size_t(index)].successShare; };
  std::stable_sort(result.incomplete.begin(), result.incomplete.end(), [&](int a, int b) { return share(a) > share(b); });
  return ranked;
}

/// The best method of a target among those that are ranked with the others; null where there is none.
const MethodResult* bestOf(const ComparisonResult& result, ComparedMethod::Target target)
{
  for (const int index : result.ranking)
  {
    const bool isComplete = std::find(result.incomplete.begin(), result.incomplete.end(), index) == result.incomplete.end();
    if (isComplete && result.methods[std::size_t(index)].target == target)
    {
      return &result.methods[std::size_t(index)];
    }
  }
  return nullptr;
}

std::string describeRivals(const ComparisonResult& result)
{
  std::string names;
  for (const int index : result.notToldApart)
  {
    names += (names.empty() ? "" : ", ") + result.methods[std::size_t(index)].name;
  }
  return names.empty() ? std::string() : " Not told apart from it by these data: " + names + ".";
}

/// Those that are not ranked with the others, each beside the best one on the same cases.
std::string describeIncomplete(const ComparisonResult& result)
{
  std::string text;
  const MethodResult& best = result.methods[std::size_t(result.ranking.front())];
  for (const int index : result.incomplete)
  {
    const MethodResult& method = result.methods[std::size_t(index)];
    const bool share = shareCaptures(result, method, best);
    const ErrorMap own = share ? errorsOf(method) : averagedOverCaptures(errorsOf(method));
    const ErrorMap same = alsoIn(share ? errorsOf(best) : averagedOverCaptures(errorsOf(best)), own);
    text += (text.empty() ? " Not ranked with the others, having no result where they have one: " : "; ") + method.name + " (" +
      std::to_string(method.usableCount()) + " of " + std::to_string(method.captures.size()) + " calibrations, " +
      fixedDigits(method.errorPx.mean, 2) + " px mean over what it has" +
      (same.empty() ? "" : ", where " + best.name + " has " + fixedDigits(summaryOf(same).mean, 2) + " px") + ")";
  }
  return text.empty() ? text : text + ".";
}

std::string describeFailures(const ComparisonResult& result)
{
  std::string names;
  int count = 0;
  for (const MethodResult& method : result.methods)
  {
    if (!method.isUsable())
    {
      names += (names.empty() ? "" : ", ") + method.name + " (" + statusWords(method.status) + ")";
      ++count;
    }
  }
  return count == 0 ? std::string()
                    : " " + std::to_string(count) + (count == 1 ? " method" : " methods") + " gave no calibration: " + names + ".";
}

std::string describe(const ComparisonResult& result)
{
  const MethodResult& best = result.methods[std::size_t(result.ranking.front())];
  std::string text = "Lowest mean projection error: " + best.name + " (" + best.title + "), " + errorWords(best) + ", over " +
    std::to_string(best.commonErrorPx.count) + " validation samples" +
    (best.commonErrorPx.count < best.errorPx.count ? " that every ranked method has a result for." : ".");
  text += describeRivals(result);
  const auto other = best.target == ComparedMethod::Target::Ball ? ComparedMethod::Target::Board : ComparedMethod::Target::Ball;
  if (const MethodResult* second = bestOf(result, other))
  {
    text += std::string(" The best of the methods with a ") + toString(other) + " is " + second->name + ": " + errorWords(*second) +
      ", " + fixedDigits(second->commonErrorPx.mean / best.commonErrorPx.mean, 1) + " times the mean.";
  }
  return text + describeIncomplete(result) + describeFailures(result);
}

}  // namespace

std::string statusWords(std::string status)
{
  std::replace(status.begin(), status.end(), '_', ' ');
  return status;
}

int MethodResult::usableCount() const
{
  return int(
    std::count_if(captures.begin(), captures.end(), [](const ComparedCapture& capture) { return capture.answer.isUsable(); }));
}

double MethodResult::medianSeconds() const
{
  std::vector<double> seconds;
  for (const ComparedCapture& capture : captures)
  {
    seconds.push_back(capture.answer.seconds);
  }
  return seconds.empty() ? 0 : median(seconds);
}

void summarizeMethod(MethodResult& method)
{
  std::vector<double> errors;
  const MethodAnswer* failure = nullptr;
  std::size_t balls = 0;
  for (const ComparedCapture& capture : method.captures)
  {
    failure = failure == nullptr && !capture.answer.isUsable() ? &capture.answer : failure;
    balls = std::max(balls, capture.validation.samples.size());
    for (const HandEyeValidationSample& sample : capture.validation.samples)
    {
      if (sample.status == CameraModel::Status::Ok)
      {
        errors.push_back(sample.errorPx);
      }
    }
  }
  method.errorPx = summarize(errors);
  method.successShare = balls > 0 ? double(errors.size()) / double(balls * method.captures.size()) : 0;
  const int usable = method.usableCount(), total = int(method.captures.size());
  if (usable == 0)
  {
    method.status = failure == nullptr ? "no_capture" : failure->status;
    method.message = failure == nullptr ? "there is no capture for it" : failure->message;
    return;
  }
  method.status = errors.empty() ? "not_in_view" : "ok";
  method.message = errors.empty() ? "its calibrations put no ball of the validation set into view"
    : failure != nullptr          ? std::to_string(total - usable) + " of " + std::to_string(total) +
      " captures failed, the first: " + failure->status + ", " + failure->message
                         : method.captures.front().answer.message;
}

void judgeComparison(ComparisonResult& result)
{
  result.notToldApart.clear();
  result.incomplete.clear();
  result.ranking = sortOutIncomplete(result);
  findCommonErrors(result, result.ranking);
  const auto mean = [&](int index) { return result.methods[std::size_t(index)].commonErrorPx.mean; };
  std::stable_sort(result.ranking.begin(), result.ranking.end(), [&](int a, int b) { return mean(a) < mean(b); });
  const std::size_t complete = result.ranking.size();
  result.ranking.insert(result.ranking.end(), result.incomplete.begin(), result.incomplete.end());
  for (std::size_t i = 1; i < complete; ++i)
  {
    const MethodResult& best = result.methods[std::size_t(result.ranking.front())];
    if (areAlike(result, best, result.methods[std::size_t(result.ranking[i])]))
    {
      result.notToldApart.push_back(result.ranking[i]);
    }
  }
  if (result.wasStopped)
  {
    result.status = "stopped";
    result.message = "stopped before all methods were compared";
  }
  else if (result.validationCount == 0)
  {
    result.status = "no_validation";
    result.message = "the ball was found and tracked in no frame of the validation: nothing can be compared";
  }
  else if (result.ranking.empty())
  {
    result.status = "no_method";
    result.message = "No method gave a calibration." + describeFailures(result);
  }
  else
  {
    result.status = "ok";
    result.message = describe(result);
  }
}

}  // namespace handeye
