// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComparisonReport.h"

#include "CaptureSimulation.h"
#include "ComparedMethods.h"
#include "ComparisonFiles.h"
#include "OffscreenRendering.h"
#include "ReportPlots.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

using namespace handeye;
using namespace handeye::test;
using handeye::io::test::readBytes;
using handeye::io::test::TemporaryFolder;

namespace
{

int countOf(const std::string& text, const std::string& word)
{
  int count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
  {
    ++count;
  }
  return count;
}

/// Calibrations from a simulated capture with noise, validated on five frames with pictures; one method always fails.
class ComparisonReport : public testing::Test
{
protected:
  void SetUp() override
  {
    registerOffscreenRendering();
    const SimulatedSession capture(15, 1);
    const auto path = session.write(folder.path() / "validation", session.trackAll());
    recording.emplace(io::Recording::open(path));
    input.frames = readCapture(*recording, {}, session.camera, session.tip_Stylus, session.ballRadiusMm);
    input.validation = toSamples(input.frames);
    input.recording = &*recording;
    input.facts = { "Lens: <made up>" };
    std::vector<ComparedMethod> methods = ballMethods({ { toSamples(capture.captured(0.3, 0.3)), {} } }, session.camera);
    ComparedMethod failing = methods[0];
    failing.name = "classical";
    failing.target = ComparedMethod::Target::Board;
    failing.subsetPool = 0;
    failing.calibrateSome = {};
    failing.calibrate = [](int)
    {
      MethodAnswer answer;
      answer.status = "parallel_motions";
      answer.message = "all motions turn about one axis";
      return answer;
    };
    methods.push_back(failing);
    ComparisonOptions options;
    options.subsetRepetitions = 3;
    result = compareMethods(methods, input.validation, session.camera, options);
  }

  const SimulatedSession session{ 5, 6 };
  const TemporaryFolder folder;
  std::optional<io::Recording> recording;
  ComparisonReportInput input;
  ComparisonResult result;
};

}  // namespace

TEST_F(ComparisonReport, Folder_HoldsPagePdfAndData)
{
  ASSERT_EQ(input.validation.size(), 5U);
  writeComparisonReport(folder.path() / "report", result, input);
  const std::string html = readBytes(folder.path() / "report" / "report.html");
  EXPECT_NE(html.find(report::escapeHtml(result.message)), std::string::npos);
  EXPECT_NE(html.find("Lens: &lt;made up&gt;"), std::string::npos);
  EXPECT_EQ(countOf(html, "data:image/png"), 3) << "against distance, shares, against samples";
  EXPECT_EQ(countOf(html, "data:image/jpeg"), 5) << "a picture a frame";
  EXPECT_NE(html.find("all motions turn about one axis"), std::string::npos) << "the row of the method that failed says why";
  EXPECT_EQ(html.find("nan"), std::string::npos);
  EXPECT_EQ(readBytes(folder.path() / "report" / "methods.csv"), methodsCsv(result));
  EXPECT_EQ(countOf(readBytes(folder.path() / "report" / "errors.csv"), "\n"), 1 + 8 * 5);
  EXPECT_EQ(countOf(readBytes(folder.path() / "report" / "subsets.csv"), "\n"), 1 + 8 * 13) << "3 to 15 samples";
  EXPECT_EQ(countOf(readBytes(folder.path() / "report" / "repeatability.csv"), "\n"), 1 + 9);
  EXPECT_EQ(readBytes(folder.path() / "report" / "report.pdf").rfind("%PDF-", 0), 0U);
}

TEST_F(ComparisonReport, Tables_HoldTheResultsNumbers)
{
  const report::Table table = report::methodsTable(result, "");
  ASSERT_EQ(table.rows.size(), 9U);
  char mean[16];
  std::snprintf(mean, sizeof(mean), "%.2f", result.methods[0].errorPx.mean);
  EXPECT_EQ(table.rows[0][0], "ml");
  EXPECT_EQ(table.rows[std::size_t(result.ranking[0])][3], "1");
  EXPECT_EQ(table.rows[0][4], mean);
  EXPECT_EQ(table.rows[8][2], "parallel_motions");
  EXPECT_EQ(table.rows[8][3], "") << "no rank";
  EXPECT_EQ(table.rows[8][4], "") << "no number for a method that failed";
  EXPECT_EQ(table.rows[8][10], "0 of 1");
  const report::Table subsets = report::subsetsTable(result.methods);
  EXPECT_EQ(subsets.headings.back(), "15");
  EXPECT_EQ(subsets.rows[0][1], "none") << "three points have no single answer";
}

TEST_F(ComparisonReport, Plots_HaveAColourAMethod)
{
  const auto plot = report::errorAgainstDistance(result.methods);
  ASSERT_TRUE(plot);
  ASSERT_EQ(plot->series.size(), 8U) << "those that gave a calibration";
  EXPECT_EQ(plot->series[0].x.size(), 5U);
  EXPECT_EQ(plot->series[2].color, report::seriesColor(2));
  EXPECT_EQ(report::errorAgainstSamples(result.methods)->series[2].color, report::seriesColor(2));
  EXPECT_EQ(report::shareBelowError(result.methods)->series[0].y.back(), 100);
}

TEST_F(ComparisonReport, MethodThatIsRankedApart_IsMarked)
{
  ComparisonResult apart = result;
  apart.incomplete = { result.ranking.back() };
  const report::Table table = report::methodsTable(apart, "");
  EXPECT_EQ(table.rows[std::size_t(result.ranking.back())][3], "apart");
  EXPECT_NE(table.caption.find("apart: failed where others did not"), std::string::npos);
}

TEST_F(ComparisonReport, SixteenMethods_LookDifferent)
{
  std::vector<MethodResult> methods(16, result.methods.front());
  for (std::size_t i = 9; i < methods.size(); ++i)
  {
    methods[i].target = ComparedMethod::Target::Board;
  }
  std::set<std::tuple<report::Color, int, bool>> looks;
  for (std::size_t i = 0; i < methods.size(); ++i)
  {
    const report::PlotSeries series = report::seriesOf(methods, i, report::PlotSeries::Style::LineAndDots);
    EXPECT_EQ(series.isDashed, i >= 9);
    looks.insert({ series.color, series.marker, series.isDashed });
  }
  EXPECT_EQ(looks.size(), methods.size());
}

TEST_F(ComparisonReport, MethodsInAPicture_HaveColoursOfTheirOwn)
{
  // With a board, place 0 of its kind, as `ml` is of the ball's.
  ComparisonResult both = result;
  for (const char* const name : { "tsai", "branch-and-bound" })
  {
    both.methods.push_back(result.methods.front());
    both.methods.back().name = name;
    both.methods.back().target = ComparedMethod::Target::Board;
  }
  both.methods[1].name = "as-published";
  judgeComparison(both);
  const std::vector<report::PredictedCenter> predicted = report::predictedCenters(both, 0);
  ASSERT_GE(predicted.size(), 5U);
  std::set<report::Color> colours;
  std::set<std::string> names;
  for (const report::PredictedCenter& center : predicted)
  {
    colours.insert(center.color);
    names.insert(center.label);
  }
  EXPECT_EQ(colours.size(), predicted.size());
  EXPECT_EQ(colours.count(report::seriesColor(2)), 0U) << "green is the segmented ball";
  for (const char* const name : { "ml", "tsai", "branch-and-bound", "as-published" })
  {
    EXPECT_EQ(names.count(name), 1U) << name;
  }
}

TEST_F(ComparisonReport, WithoutPictures_StillAReport)
{
  input.recording = nullptr;
  const report::ReportDocument document = comparisonDocument(result, input);
  for (const report::Block& block : document.blocks)
  {
    EXPECT_FALSE(std::holds_alternative<report::Gallery>(block));
  }
}

TEST_F(ComparisonReport, NothingWorked_SaysSo)
{
  ComparisonResult none = result;
  none.methods.erase(none.methods.begin(), none.methods.begin() + 8);
  judgeComparison(none);
  writeComparisonReport(folder.path() / "none", none, input);
  const std::string html = readBytes(folder.path() / "none" / "report.html");
  EXPECT_NE(html.find("No method gave a calibration"), std::string::npos);
  EXPECT_NE(html.find("class='verdict poor'"), std::string::npos);
  EXPECT_EQ(countOf(html, "<img"), 0);
}

TEST(ReportPlots, Plateau_IsWhereMoreSamplesStopHelping)
{
  MethodResult method;
  for (int count = 4; count <= 20; ++count)
  {
    SubsetErrors errors;
    errors.sampleCount = count;
    errors.repetitions = errors.usable = 10;
    errors.medianPx = count < 12 ? 3 - 0.15 * count : 1;
    method.subsets.push_back(errors);
  }
  EXPECT_EQ(report::plateauOf(method), 12);
  method.subsets.back().medianPx = 0.5;
  EXPECT_FALSE(report::plateauOf(method)) << "still falling at the end";
}
