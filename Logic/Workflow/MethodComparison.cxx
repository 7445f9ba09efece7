// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MethodComparison.h"

#include "ComparisonSpread.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

namespace handeye
{

namespace
{

using Random = std::mt19937;

/// The first `count` of a random order of 0 ... total - 1; the same with every standard library.
std::vector<int> drawSome(int total, int count, Random& random)
{
  std::vector<int> all(static_cast<std::size_t>(total));
  std::iota(all.begin(), all.end(), 0);
  for (int i = 0; i < count; ++i)
  {
    std::swap(all[std::size_t(i)], all[std::size_t(i) + random() % std::size_t(total - i)]);
  }
  all.resize(std::size_t(count));
  return all;
}

double percentile(const std::vector<double>& sorted, double share)
{
  return sorted[std::size_t(std::lround(share * double(sorted.size() - 1)))];
}

/// Counts steps and asks whether to go on.
class Steps
{
public:
  Steps(const ComparisonOptions& options, int total)
    : options_(options)
    , total_(total)
  {
  }
  bool next(const std::string& what)
  {
    isStopped_ = isStopped_ || (options_.progress && !options_.progress(what, ++done_, total_));
    return !isStopped_;
  }
  bool isStopped() const { return isStopped_; }

private:
  const ComparisonOptions& options_;
  int total_ = 0, done_ = 0;
  bool isStopped_ = false;
};

class Comparer
{
public:
  Comparer(const ComparedMethod& method, const std::vector<HandEyeSample>& validation, const CameraModel& camera,
    const ComparisonOptions& options)
    : method_(method)
    , validation_(validation)
    , camera_(camera)
    , options_(options)
  {
  }

  ComparedCapture compareCapture(int capture) const
  {
    ComparedCapture compared;
    compared.answer = method_.calibrate(capture);
    if (compared.answer.isUsable())
    {
      compared.validation = validateHandEye(validation_, camera_, *compared.answer.markerToCamera);
    }
    return compared;
  }

  SubsetErrors compareSubsets(int sampleCount) const
  {
    SubsetErrors errors;
    errors.sampleCount = sampleCount;
    // The same subsets for every method with as many samples.
    Random random(options_.seed * 1000003U + unsigned(sampleCount));
    std::vector<double> means;
    for (; errors.repetitions < options_.subsetRepetitions; ++errors.repetitions)
    {
      const std::vector<int> samples = drawSome(method_.subsetPool, sampleCount, random);
      const MethodAnswer answer = method_.calibrateSome(samples);
      if (answer.isUsable())
      {
        const Summary error = validateHandEye(validation_, camera_, *answer.markerToCamera).projectionErrorPx;
        if (error.count > 0)
        {
          means.push_back(error.mean);
        }
      }
    }
    errors.summarize(std::move(means));
    return errors;
  }

  Repeatability repeatability(const std::vector<ComparedCapture>& captures) const
  {
    std::vector<Eigen::Isometry3d> calibrations;
    Repeatability result;
    if (captures.size() > 1)
    {
      result.attempts = int(captures.size());
      for (const ComparedCapture& capture : captures)
      {
        addUsable(capture.answer, calibrations);
      }
    }
    else if (method_.calibrateSome)
    {
      result.areHalves = true;
      Random random(options_.seed + 77U);
      const int total = method_.subsetPool;
      for (int i = 0; i < options_.halvings && total >= 2; ++i)
      {
        const std::vector<int> order = drawSome(total, total, random);
        const auto middle = order.begin() + total / 2;
        addUsable(method_.calibrateSome({ order.begin(), middle }), calibrations);
        addUsable(method_.calibrateSome({ middle, order.end() }), calibrations);
        result.attempts += 2;
      }
    }
    measureSpread(calibrations, validation_, camera_, result);
    return result;
  }

private:
  static void addUsable(const MethodAnswer& answer, std::vector<Eigen::Isometry3d>& calibrations)
  {
    if (answer.isUsable())
    {
      calibrations.push_back(*answer.markerToCamera);
    }
  }

  const ComparedMethod& method_;
  const std::vector<HandEyeSample>& validation_;
  const CameraModel& camera_;
  const ComparisonOptions& options_;
};

/// The sizes of subsets that a capture allows; the whole capture is the last.
std::vector<int> subsetSizes(const ComparedMethod& method, const ComparisonOptions& options)
{
  std::vector<int> sizes;
  if (method.calibrateSome && options.subsetRepetitions > 0)
  {
    for (int size = options.fewestSamples; size <= std::min(options.mostSamples, method.subsetPool); ++size)
    {
      sizes.push_back(size);
    }
  }
  return sizes;
}

int countSteps(const std::vector<ComparedMethod>& methods, const ComparisonOptions& options)
{
  int steps = 0;
  for (const ComparedMethod& method : methods)
  {
    steps += int(method.sampleCounts.size()) + int(subsetSizes(method, options).size()) + 1;
  }
  return steps;
}

MethodResult compareMethod(const ComparedMethod& method, const Comparer& comparer, const ComparisonOptions& options, Steps& steps)
{
  MethodResult result;
  result.name = method.name;
  result.title = method.title;
  result.reference = method.reference;
  result.target = method.target;
  result.isOurs = method.isOurs;
  for (int capture = 0; capture < int(method.sampleCounts.size()); ++capture)
  {
    result.captures.push_back(comparer.compareCapture(capture));
    if (!steps.next(method.name))
    {
      return result;
    }
  }
  for (const int size : subsetSizes(method, options))
  {
    result.subsets.push_back(comparer.compareSubsets(size));
    if (!steps.next(method.name + " from " + std::to_string(size) + " samples"))
    {
      return result;
    }
  }
  result.repeatability = comparer.repeatability(result.captures);
  steps.next(method.name + ", repeatability");
  return result;
}

}  // namespace

void SubsetErrors::summarize(std::vector<double> means)
{
  usable = int(means.size());
  means.resize(std::size_t(std::max(repetitions, usable)), std::numeric_limits<double>::infinity());
  if (!means.empty())
  {
    std::sort(means.begin(), means.end());
    // Between a number and infinity there is no middle.
    medianPx = std::isfinite(means[means.size() / 2]) ? median(means) : std::numeric_limits<double>::infinity();
    lowestPx = percentile(means, 0.1);
    highestPx = percentile(means, 0.9);
  }
}

void ComparisonOptions::check() const
{
  if (fewestSamples < 1 || mostSamples < fewestSamples)
  {
    throw std::invalid_argument("the sizes of the random subsets make no sense: at least 1, and the largest not below the least");
  }
  if (subsetRepetitions < 0 || halvings < 0)
  {
    throw std::invalid_argument("the number of repetitions must not be negative");
  }
}

ComparisonResult compareMethods(const std::vector<ComparedMethod>& methods, const std::vector<HandEyeSample>& validation,
  const CameraModel& camera, const ComparisonOptions& options)
{
  options.check();
  ComparisonResult result;
  result.validationCount = int(validation.size());
  Steps steps(options, countSteps(methods, options));
  for (const ComparedMethod& method : methods)
  {
    if (steps.isStopped())
    {
      break;
    }
    result.methods.push_back(compareMethod(method, Comparer(method, validation, camera, options), options, steps));
    summarizeMethod(result.methods.back());
  }
  result.wasStopped = steps.isStopped();
  judgeComparison(result);
  return result;
}

std::string toString(ComparedMethod::Target target)
{
  return target == ComparedMethod::Target::Ball ? "ball" : "board";
}

}  // namespace handeye
