// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace handeye
{

/// Median of |x| for x ~ N(0, 1); of the length of a vector of 2 or 3 such numbers. Divide a median by it to have sigma per axis.
constexpr double MedianOfChi1 = 0.6745;
constexpr double MedianOfChi2 = 1.1774;
constexpr double MedianOfChi3 = 1.5382;

/// The median of some numbers, the lower of the two middle ones for an even count; @throws std::invalid_argument if there are none.
double median(std::vector<double> values);

/// What is said of a set of errors; all zero for an empty set.
struct Summary
{
  int count = 0;
  double mean = 0;
  double standardDeviation = 0;  ///< of the sample (n - 1); 0 for one value
  double minimum = 0;
  double maximum = 0;
  double rms = 0;  ///< root of the mean square, not the mean
};

Summary summarize(const std::vector<double>& values);

}  // namespace handeye
