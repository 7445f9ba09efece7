// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeConsensus.h"

#include "Statistics.h"

#include <algorithm>
#include <limits>
#include <random>

namespace handeye
{

namespace
{

constexpr std::size_t MinimalSet = 4;
constexpr int MostDraws = 300;
constexpr int RejectionRounds = 10;
/// However much the samples scatter, the limit is not drawn further than this: a set that contradicts itself must not excuse
/// itself.
constexpr double LargestScale = 2;

/// The scatter of samples in multiples of what is expected of them, for the limit of agreement.
double scaleOf(const std::vector<double>& normalized)
{
  return std::clamp(median(normalized) / MedianOfChi2, 1.0, LargestScale);
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

}  // namespace

std::vector<int> findConsensus(const HandEyeSamples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options)
{
  std::vector<double> best;
  double bestScore = std::numeric_limits<double>::infinity();
  for (const std::vector<int>& set : minimalSets(int(samples.size())))
  {
    const PointLineResult candidate = solveHandEye(samples, set, eyes, options, PointLineOptions::Method::Global, 0);
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
  std::vector<int> kept = agreeing(best, 3 * options.rejectionFactor * scaleOf(best));
  for (int round = 0; round < RejectionRounds && kept.size() >= MinimalSet; ++round)
  {
    const PointLineResult solution = solveHandEye(samples, kept, eyes, options, PointLineOptions::Method::Global, 2);
    if (!solution.isUsable())
    {
      return kept;
    }
    const std::vector<double> normalized = normalizedResiduals(samples, eyes, solution.pointsToLines, options);
    std::vector<int> next = agreeing(normalized, options.rejectionFactor * scaleOf(normalized));
    if (next == kept)
    {
      break;
    }
    kept = std::move(next);
  }
  return kept;
}

}  // namespace handeye
