// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Capture.h"
#include "MarkedPicture.h"
#include "MethodComparison.h"
#include "Recording.h"
#include "ReportDocument.h"
#include "ReportPlot.h"

#include <filesystem>
#include <string>
#include <vector>

namespace handeye
{

/// What the report of a comparison needs besides its result.
struct ComparisonReportInput
{
  std::vector<HandEyeSample> validation;     ///< what was compared on
  std::vector<CapturedFrame> frames;         ///< the frames of the validation, for their pictures
  const io::Recording* recording = nullptr;  ///< of the validation; without it there are no pictures
  std::vector<std::string> facts;            ///< sentences about captures, lens and noise: what was compared, from which files
  report::PlotDrawer drawPlot = report::drawPlot;
};

/// The report of `handeye compare`: verdict, one row a method (the paper's tables 2-4), error against distance and against the
/// number of samples, repeatability, predicted and segmented centres on the pictures; with the data as CSV.
[[nodiscard]] report::ReportDocument comparisonDocument(const ComparisonResult& result, const ComparisonReportInput& input);

/// @throws as report::writeReport()
void writeComparisonReport(const std::filesystem::path& folder, const ComparisonResult& result, const ComparisonReportInput& input);

namespace report
{

/// Place of each method: "1", "2 ~" where it is not told apart from the first, "apart" where it is not ranked with the others, empty
/// where it gave nothing.
[[nodiscard]] std::vector<std::string> ranksOf(const ComparisonResult& result);

/// The tables of it, for whoever pools comparisons.
[[nodiscard]] Table methodsTable(const ComparisonResult& result, const std::string& caption);
[[nodiscard]] Table subsetsTable(const std::vector<MethodResult>& methods);
[[nodiscard]] Table repeatabilityTable(const std::vector<MethodResult>& methods);

/// Where the methods that its pictures show put the ball of a validation sample: the best one, the best with a board, those that
/// the paper is about. Each has a colour of its own, the same in all pictures: in a plot the mark and the dashes help to tell
/// methods apart, in a picture there is only the colour.
/// @param result with a ranking
[[nodiscard]] std::vector<PredictedCenter> predictedCenters(const ComparisonResult& result, std::size_t sample);

}  // namespace report

}  // namespace handeye
