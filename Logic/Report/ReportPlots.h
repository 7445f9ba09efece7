// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "MethodComparison.h"
#include "ReportPlot.h"
#include "ValidationStep.h"

#include <optional>
#include <string>
#include <vector>

namespace handeye::report
{

/// The plots of the reports, ready for drawPlot(); nothing where there is nothing to show. Each usable method has the colour of its
/// place in the comparison in all of them.

struct MethodLook
{
  int color = 0;  ///< of seriesColor(), or of a window's colours in the same order
  int marker = 0;
  bool isDashed = false;
};

/// The look of a method, which is the same in all plots and tables: solid lines and filled marks for the methods with the ball,
/// dashed lines and a plus for those with a board; a colour each within its kind.
[[nodiscard]] MethodLook lookOf(const std::vector<MethodResult>& methods, std::size_t index);

/// A series with that look.
[[nodiscard]] PlotSeries seriesOf(const std::vector<MethodResult>& methods, std::size_t index, PlotSeries::Style style);

/// Projection error against the ball's distance, a dot a validation sample.
[[nodiscard]] std::optional<Plot> errorAgainstDistance(const std::vector<MethodResult>& methods);
/// The median of the mean error of random subsets against their size.
[[nodiscard]] std::optional<Plot> errorAgainstSamples(const std::vector<MethodResult>& methods);
/// Which share of the validation samples has at most this error.
[[nodiscard]] std::optional<Plot> shareBelowError(const std::vector<MethodResult>& methods);
/// Of one validation: error against distance.
[[nodiscard]] std::optional<Plot> errorAgainstDistance(const ValidationStepResult& validation);
/// Of one validation: the error along x and y, a dot a frame; a cloud beside (0, 0) is a bias.
[[nodiscard]] std::optional<Plot> errorDirections(const ValidationStepResult& validation);

/// The fewest samples from which on the medians of a method stay within 10 % of what its largest subsets reach; nothing where it
/// does not level out.
[[nodiscard]] std::optional<int> plateauOf(const MethodResult& method);

}  // namespace handeye::report
