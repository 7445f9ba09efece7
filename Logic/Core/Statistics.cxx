// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Statistics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace handeye
{

double median(std::vector<double> values)
{
  if (values.empty())
  {
    throw std::invalid_argument("the median of no numbers was asked for");
  }
  const auto middle = values.begin() + (values.size() - 1) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Summary summarize(const std::vector<double>& values)
{
  Summary summary;
  summary.count = int(values.size());
  if (values.empty())
  {
    return summary;
  }
  double sum = 0, squares = 0;
  for (double value : values)
  {
    sum += value;
    squares += value * value;
  }
  summary.mean = sum / values.size();
  summary.rms = std::sqrt(squares / values.size());
  summary.minimum = *std::min_element(values.begin(), values.end());
  summary.maximum = *std::max_element(values.begin(), values.end());
  double deviations = 0;
  for (double value : values)
  {
    deviations += (value - summary.mean) * (value - summary.mean);
  }
  summary.standardDeviation = values.size() > 1 ? std::sqrt(deviations / (values.size() - 1)) : 0;
  return summary;
}

}  // namespace handeye
