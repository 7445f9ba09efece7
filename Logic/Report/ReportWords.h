// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ReportDocument.h"
#include "ReportPlot.h"
#include "Statistics.h"

#include <optional>
#include <string>
#include <vector>

namespace handeye::report
{

/// What the reports have in common. Internal.

/// Good below 1 px mean, fair below 3, poor otherwise; none without errors. The same limits as `handeye validate`.
ReportDocument::Verdict verdictOf(const Summary& errorPx);

/// Draws a plot, if there is one, and adds it with its caption; a sentence where nothing can be rendered.
void addPlot(
  ReportDocument& document, const std::optional<Plot>& plot, const std::string& caption, const PlotDrawer& draw = drawPlot);

/// At most so many of a list: the first, the last, and evenly those between.
template<typename T> std::vector<T> spreadOut(const std::vector<T>& all, std::size_t most)
{
  if (all.size() <= most)
  {
    return all;
  }
  std::vector<T> some;
  for (std::size_t i = 0; i < most; ++i)
  {
    some.push_back(all[i * (all.size() - 1) / (most - 1)]);
  }
  return some;
}

}  // namespace handeye::report
