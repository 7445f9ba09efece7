// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReportWords.h"

#include <stdexcept>

namespace handeye::report
{

ReportDocument::Verdict verdictOf(const Summary& errorPx)
{
  return errorPx.count == 0 ? ReportDocument::Verdict::Poor
    : errorPx.mean < 1      ? ReportDocument::Verdict::Good
    : errorPx.mean < 3      ? ReportDocument::Verdict::Fair
                            : ReportDocument::Verdict::Poor;
}

void addPlot(ReportDocument& document, const std::optional<Plot>& plot, const std::string& caption, const PlotDrawer& draw)
{
  if (!plot)
  {
    return;
  }
  try
  {
    Figure figure;
    figure.caption = plot->title + ". " + caption;
    figure.picture = draw(*plot);
    document.blocks.push_back(std::move(figure));
  }
  catch (const std::runtime_error& error)
  {
    // The numbers are in the tables all the same.
    document.blocks.push_back(Paragraph{ "Not drawn: " + plot->title + " (" + error.what() + ")." });
  }
}

}  // namespace handeye::report
