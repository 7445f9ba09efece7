// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReportPlot.h"

#include "OffscreenRendering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

using namespace handeye;
using namespace handeye::report;

namespace
{

class ReportPlot : public testing::Test
{
protected:
  static void SetUpTestSuite() { registerOffscreenRendering(); }

  static Plot twoSeries()
  {
    Plot plot;
    plot.title = "Errors";
    plot.xLabel = "distance (mm)";
    plot.yLabel = "error (px)";
    plot.width = 600;
    plot.height = 400;
    for (int i = 0; i < 2; ++i)
    {
      PlotSeries series;
      series.label = i == 0 ? "low" : "high";
      series.color = i == 0 ? Color{ 255, 0, 0 } : Color{ 0, 0, 255 };
      series.marker = 1;
      for (int k = 0; k < 5; ++k)
      {
        series.x.push_back(100 + 50 * k);
        series.y.push_back(i == 0 ? 1 : 9);
      }
      plot.series.push_back(series);
    }
    return plot;
  }
};

/// Mean row and number of the pixels of about this colour (BGR), left of the legend.
std::pair<double, int> find(const cv::Mat& picture, const cv::Vec3b& color)
{
  double sum = 0;
  int count = 0;
  for (int row = 0; row < picture.rows; ++row)
  {
    for (int column = 0; column < picture.cols * 3 / 4; ++column)
    {
      const cv::Vec3b pixel = picture.at<cv::Vec3b>(row, column);
      const int distance = std::abs(pixel[0] - color[0]) + std::abs(pixel[1] - color[1]) + std::abs(pixel[2] - color[2]);
      if (distance < 40)
      {
        sum += row;
        ++count;
      }
    }
  }
  return { count > 0 ? sum / count : -1, count };
}

}  // namespace

TEST_F(ReportPlot, Series_AreWhereTheirNumbersAre)
{
  const cv::Mat picture = drawPlot(twoSeries());
  ASSERT_EQ(picture.size(), cv::Size(600, 400));
  EXPECT_EQ(picture.at<cv::Vec3b>(2, 2), cv::Vec3b(255, 255, 255));
  const auto [low, lowCount] = find(picture, { 0, 0, 255 });
  const auto [high, highCount] = find(picture, { 255, 0, 0 });
  EXPECT_GT(lowCount, 5 * 20) << "five red dots";
  EXPECT_GT(highCount, 5 * 20) << "five blue dots";
  EXPECT_GT(low, 250) << "1 of 10 is near the bottom";
  EXPECT_LT(high, 150) << "9 of 10 is near the top";
}

TEST_F(ReportPlot, Logarithm_PutsTheGeometricMeanInTheMiddle)
{
  Plot plot = twoSeries();
  plot.isLogarithmic = true;
  PlotSeries middle = plot.series[0];
  middle.label = "middle";
  middle.color = { 0, 255, 0 };
  middle.y.assign(5, 3);
  middle.y[4] = 0;  // has no logarithm: left out
  plot.series.push_back(middle);
  const cv::Mat picture = drawPlot(plot);
  const double low = find(picture, { 0, 0, 255 }).first, high = find(picture, { 255, 0, 0 }).first;
  EXPECT_NEAR(find(picture, { 0, 255, 0 }).first, (low + high) / 2, 2);
}

TEST_F(ReportPlot, Line_IsDrawnBetweenTheDots)
{
  Plot plot = twoSeries();
  const int dots = find(drawPlot(plot), { 0, 0, 255 }).second;
  plot.series[0].style = PlotSeries::Style::LineAndDots;
  EXPECT_GT(find(drawPlot(plot), { 0, 0, 255 }).second, dots);
}

TEST_F(ReportPlot, LongTitles_AreNotCutOff)
{
  Plot plot = twoSeries();
  plot.title = plot.xLabel = plot.yLabel = "a title of many more words than there is room for in one line of such a small picture";
  const cv::Mat picture = drawPlot(plot);
  const cv::Rect all(0, 0, picture.cols, picture.rows);
  for (const cv::Rect& edge : { cv::Rect(0, 0, all.width, 2), cv::Rect(0, all.height - 2, all.width, 2),
         cv::Rect(0, 0, 2, all.height), cv::Rect(all.width - 2, 0, 2, all.height) })
  {
    double least = 0;
    cv::minMaxLoc(picture(edge).clone().reshape(1), &least);
    EXPECT_GT(least, 200) << "something is drawn at the edge " << edge;
  }
}

TEST_F(ReportPlot, NothingToDraw_IsRefused)
{
  Plot plot = twoSeries();
  plot.series[1].y.pop_back();
  EXPECT_THROW((void)drawPlot(plot), std::invalid_argument);
  plot = twoSeries();
  plot.series[0].y[2] = std::nan("");
  EXPECT_THROW((void)drawPlot(plot), std::invalid_argument);
  plot.series.clear();
  EXPECT_THROW((void)drawPlot(plot), std::invalid_argument);
  plot = twoSeries();
  plot.isLogarithmic = true;
  plot.series[0].y.assign(5, 0);
  plot.series[1].y.assign(5, -1);
  EXPECT_THROW((void)drawPlot(plot), std::invalid_argument);
}

// More methods than colours are told apart by marks and lines, too: ComparisonReport.FourteenMethods_LookDifferent.
TEST_F(ReportPlot, Colours_NineDiffer_ThenAgainFromTheFirst)
{
  for (std::size_t i = 0; i < 9; ++i)
  {
    for (std::size_t k = 0; k < i; ++k)
    {
      EXPECT_NE(seriesColor(i), seriesColor(k)) << i << " and " << k;
    }
    EXPECT_EQ(seriesColor(i + 9), seriesColor(i));
  }
}
