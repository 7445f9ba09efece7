// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeConsensus.h"

#include "MinimalSets.h"
#include "Statistics.h"

#include <algorithm>
#include <limits>

namespace handeye
{

namespace
{

constexpr int RejectionRounds = 10;
/// However much the samples scatter, the limit is not drawn further than this: a set that contradicts itself must not excuse
/// itself.
constexpr double LargestScale = 2;

/// The scatter of samples in multiples of what is expected of them, for the limit of agreement.
double scaleOf(const std::vector<double>& normalized)
{
  return std::clamp(median(normalized) / MedianOfChi2, 1.0, LargestScale);
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
