// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MinimalSets.h"
#include "PointLineMethods.h"
#include "Statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace handeye
{

namespace
{

/// With fewer pairs there is no telling which are wrong.
constexpr std::size_t FewestPairs = 8;
/// A pair disagrees when its distance is this many times the scatter of the others.
constexpr double RejectionFactor = 4.5;
/// Leaving pairs out must pay: the scatter falls by this factor at least ...
constexpr double WorthIt = 2.5;
/// ... or each that is left out is far off on its own account. Few pairs do not tell their own scatter well, and look closer together
/// than they are after the furthest are gone: both limits are larger for them by this share over the freedoms that they leave.
constexpr double FewFreedoms = 15;
constexpr int Rounds = 10;

std::vector<double> distances(const PointLinePairs& pairs, const Eigen::Isometry3d& pointsToLines)
{
  std::vector<double> lengths;
  for (const PointLinePair& pair : pairs)
  {
    lengths.push_back(offsetFromLine(pair, pointsToLines).norm());
  }
  return lengths;
}

struct Fit
{
  bool usable = false;
  std::vector<double> lengths;  ///< of all pairs
  double sigma = 0;             ///< scatter per axis of those that were fitted
};

Fit fit(const PointLinePairs& pairs, const std::vector<int>& kept, const PointLineOptions& options)
{
  PointLinePairs subset;
  for (int i : kept)
  {
    subset.push_back(pairs[std::size_t(i)]);
  }
  const PointLineResult solution = registerPointsToLines(subset, options);
  Fit fitted;
  fitted.usable = solution.isUsable();
  if (fitted.usable)
  {
    fitted.lengths = distances(pairs, solution.pointsToLines);
    const double freedoms = std::max(1.0, 2.0 * double(kept.size()) - 6);
    fitted.sigma = solution.rmsMm * std::sqrt(double(kept.size()) / freedoms);
  }
  return fitted;
}

std::vector<int> within(const std::vector<double>& lengths, double limit)
{
  std::vector<int> kept;
  for (std::size_t i = 0; i < lengths.size(); ++i)
  {
    if (lengths[i] <= limit)
    {
      kept.push_back(int(i));
    }
  }
  return kept;
}

/// The distances of all pairs from the minimal set that most of them agree with: least median.
std::vector<double> bestOfMinimalSets(const PointLinePairs& pairs, const PointLineOptions& options)
{
  std::vector<double> best;
  double lowest = std::numeric_limits<double>::infinity();
  for (const std::vector<int>& set : minimalSets(int(pairs.size())))
  {
    const Fit candidate = fit(pairs, set, options);
    const double score = candidate.usable ? median(candidate.lengths) : std::numeric_limits<double>::infinity();
    if (score < lowest)
    {
      lowest = score;
      best = candidate.lengths;
    }
  }
  return best;
}

}  // namespace

std::vector<int> findAgreeingPairs(const PointLinePairs& pairs, const PointLineOptions& given)
{
  std::vector<int> all;
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    all.push_back(int(i));
  }
  PointLineOptions options = given;
  options.method = PointLineOptions::Method::Global;
  options.rejectOutliers = false;
  options.findRivals = false;
  if (pairs.size() < FewestPairs)
  {
    return all;
  }
  const std::vector<double> lengths = bestOfMinimalSets(pairs, options);
  if (lengths.empty())
  {
    return all;
  }
  const double rounding = 1e-9 * (pairs.front().point_Points.norm() + pairs.front().origin_Lines.norm() + 1e-300);
  // A minimal set is noisy: the first limit is generous.
  std::vector<int> kept = within(lengths, 3 * RejectionFactor * median(lengths) / MedianOfChi2 + rounding);
  Fit fitted;
  for (int round = 0; round < Rounds; ++round)
  {
    fitted = fit(pairs, kept, options);
    if (!fitted.usable)
    {
      return all;
    }
    std::vector<int> next = within(fitted.lengths, RejectionFactor * fitted.sigma + rounding);
    if (next == kept || 2 * next.size() <= pairs.size())
    {
      break;
    }
    kept = std::move(next);
  }
  const PointLineOptions judging = [&]
  {
    PointLineOptions any = options;
    any.maximumRelativeRms = std::numeric_limits<double>::infinity();
    return any;
  }();
  const Fit withAll = fit(pairs, all, judging);
  const double freedoms = std::max(1.0, 2.0 * double(kept.size()) - 6);
  const double few = 1 + FewFreedoms / freedoms, farOff = few * RejectionFactor * fitted.sigma + rounding;
  double nearestLeftOut = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    if (!std::binary_search(kept.begin(), kept.end(), int(i)))
    {
      nearestLeftOut = std::min(nearestLeftOut, fitted.lengths[i]);
    }
  }
  const bool pays = !withAll.usable || withAll.sigma > few * WorthIt * fitted.sigma + rounding || nearestLeftOut > farOff;
  return pays && 2 * kept.size() > pairs.size() ? kept : all;
}

}  // namespace handeye
