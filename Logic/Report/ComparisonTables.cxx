// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComparisonReport.h"
#include "NumberWords.h"

#include <algorithm>
#include <cmath>

namespace handeye::report
{

std::vector<std::string> ranksOf(const ComparisonResult& result)
{
  std::vector<std::string> ranks(result.methods.size());
  for (std::size_t i = 0; i < result.ranking.size(); ++i)
  {
    ranks[std::size_t(result.ranking[i])] = std::to_string(i + 1);
  }
  for (const int index : result.notToldApart)
  {
    ranks[std::size_t(index)] += " ~";
  }
  for (const int index : result.incomplete)
  {
    ranks[std::size_t(index)] = "apart";
  }
  return ranks;
}

Table methodsTable(const ComparisonResult& result, const std::string& caption)
{
  const bool hasGaps = std::any_of(result.methods.begin(), result.methods.end(),
    [](const MethodResult& method) { return method.commonErrorPx.count > 0 && method.commonErrorPx.count < method.errorPx.count; });
  Table table;
  table.caption = caption + ". Rank: ~ is not told apart from the first by these data" +
    (result.incomplete.empty() ? "" : "; apart: failed where others did not, its errors are of easier cases") +
    (hasGaps ? ". Common mean: over the samples for which every ranked method has a result, which the ranking compares" : "");
  table.headings = { "method", "target", "status", "rank", "mean", "std", "min", "max", "RMS", "samples", "calibrations",
    "time (s)", "what it is" };
  if (hasGaps)
  {
    table.headings.insert(table.headings.begin() + 5, "common mean");
  }
  table.textColumns = 3;
  table.endsWithText = true;
  const std::vector<std::string> ranks = ranksOf(result);
  for (std::size_t i = 0; i < result.methods.size(); ++i)
  {
    const MethodResult& method = result.methods[i];
    const Summary& error = method.errorPx;
    const bool ok = method.isUsable();
    const auto px = [&](double value) { return ok ? fixedDigits(value, 2) : std::string(); };
    const bool allUsable = method.usableCount() == int(method.captures.size());
    std::vector<std::string> row = { method.name, toString(method.target), method.status, ranks[i], px(error.mean),
      px(error.standardDeviation), px(error.minimum), px(error.maximum), px(error.rms), std::to_string(error.count),
      std::to_string(method.usableCount()) + " of " + std::to_string(method.captures.size()),
      significantDigits(method.medianSeconds(), 2),
      method.title + " (" + method.reference + ")" + (ok && allUsable ? "" : ". " + method.message) };
    if (hasGaps)
    {
      row.insert(row.begin() + 5, method.commonErrorPx.count > 0 ? px(method.commonErrorPx.mean) : std::string());
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table subsetsTable(const std::vector<MethodResult>& methods)
{
  const std::vector<int> sizes = { 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30 };
  Table table;
  table.caption =
    "Median of the mean projection errors (px) by the number of samples, subsets without a calibration counting as the worst; in "
    "brackets the share of subsets that gave a calibration, where not all did";
  table.headings = { "method" };
  int largest = 0;
  for (const MethodResult& method : methods)
  {
    largest = std::max(largest, method.subsets.empty() ? 0 : method.subsets.back().sampleCount);
  }
  for (const int size : sizes)
  {
    if (size <= largest)
    {
      table.headings.push_back(std::to_string(size));
    }
  }
  for (const MethodResult& method : methods)
  {
    if (method.subsets.empty())
    {
      continue;
    }
    std::vector<std::string> row(table.headings.size());
    row[0] = method.name;
    for (const SubsetErrors& subset : method.subsets)
    {
      for (std::size_t column = 1; column < row.size(); ++column)
      {
        if (sizes[column - 1] == subset.sampleCount && subset.repetitions > 0)
        {
          const int share = 100 * subset.usable / subset.repetitions;
          row[column] = (std::isfinite(subset.medianPx) ? fixedDigits(subset.medianPx, 2) : std::string("none")) +
            (share < 100 && share > 0 ? " (" + std::to_string(share) + " %)" : "");
        }
      }
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table repeatabilityTable(const std::vector<MethodResult>& methods)
{
  Table table;
  table.headings = { "method", "of", "calibrations", "rotation (deg)", "translation (mm)", "projection (px)", "worst (px)" };
  table.textColumns = 2;
  for (const MethodResult& method : methods)
  {
    const Repeatability& spread = method.repeatability;
    if (spread.attempts == 0)
    {
      continue;
    }
    const bool ok = spread.calibrations > 1;
    const auto number = [&](double value, int digits) { return ok ? fixedDigits(value, digits) : std::string(); };
    table.rows.push_back({ method.name, spread.areHalves ? "random halves" : "captures",
      std::to_string(spread.calibrations) + " of " + std::to_string(spread.attempts), number(spread.rotationDeg, 3),
      number(spread.translationMm, 2), number(spread.projectionPx, 2), number(spread.worstPx, 2) });
  }
  return table;
}

}  // namespace handeye::report
