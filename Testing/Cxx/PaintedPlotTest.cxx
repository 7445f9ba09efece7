// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PaintedPlot.h"
#include "WidgetTestSupport.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <thread>
#include <vector>

using handeye::paintPlot;
using handeye::report::Plot;
using handeye::report::PlotSeries;

namespace
{

constexpr int LegendFrom = 620;  ///< px; what is left of it are the points

Plot twoSeries()
{
  Plot plot;
  plot.title = "Errors";
  plot.xLabel = "distance (mm)";
  plot.yLabel = "error (px)";
  plot.width = 800;
  plot.height = 450;
  for (int i = 0; i < 2; ++i)
  {
    PlotSeries series;
    series.label = i == 0 ? "low" : "high";
    series.color = i == 0 ? handeye::report::Color{ 255, 0, 0 } : handeye::report::Color{ 0, 0, 255 };
    series.marker = 1;
    for (int k = 0; k < 5; ++k)
    {
      series.x.push_back(100 + 50 * k);
      series.y.push_back(i == 0 ? 2 : 9);
    }
    plot.series.push_back(series);
  }
  return plot;
}

/// Mean place of the pixels of this colour (BGR).
cv::Point2d placeOf(const cv::Mat& picture, const cv::Scalar& color)
{
  cv::Mat is;
  cv::inRange(picture.colRange(0, LegendFrom), color - cv::Scalar::all(25), color + cv::Scalar::all(25), is);
  const cv::Moments moments = cv::moments(is, true);
  return moments.m00 > 50 ? cv::Point2d(moments.m10 / moments.m00, moments.m01 / moments.m00) : cv::Point2d(-1, -1);
}

/// Dark pixels of the upper edge: the title.
int inkOfTitle(const cv::Mat& picture)
{
  cv::Mat grey;
  cv::cvtColor(picture.rowRange(0, 40), grey, cv::COLOR_BGR2GRAY);
  return cv::countNonZero(grey < 128);
}

}  // namespace

class PaintedPlotTest : public QObject
{
  Q_OBJECT

private slots:
  void painted_IsWhereVtkDrawsIt();
  void threads_PaintAtOnce();
  void nothingToDraw_IsRefused();
};

void PaintedPlotTest::painted_IsWhereVtkDrawsIt()
{
  const cv::Mat painted = paintPlot(twoSeries()), drawn = handeye::report::drawPlot(twoSeries());
  cv::imwrite(HANDEYE_TEST_OUTPUT_DIR "/PaintedPlot.png", painted);
  QCOMPARE(painted.size(), drawn.size());
  for (const cv::Scalar& color : { cv::Scalar(0, 0, 255), cv::Scalar(255, 0, 0) })
  {
    const cv::Point2d ours = placeOf(painted, color), theirs = placeOf(drawn, color);
    QVERIFY(ours.x > 0 && theirs.x > 0);
    // Axes begin where their labels end, which depends on the letters.
    QVERIFY2(cv::norm(ours - theirs) < 20, qPrintable(QString::number(cv::norm(ours - theirs))));
  }
  QVERIFY(placeOf(painted, { 255, 0, 0 }).y < placeOf(painted, { 0, 0, 255 }).y - 100);
  QVERIFY(inkOfTitle(painted) > 50);
}

void PaintedPlotTest::threads_PaintAtOnce()
{
  const cv::Mat alone = paintPlot(twoSeries());
  std::vector<cv::Mat> pictures(3);
  std::vector<std::thread> threads;
  for (cv::Mat& picture : pictures)
  {
    threads.emplace_back(
      [&picture]
      {
        for (int i = 0; i < 10; ++i)
        {
          picture = paintPlot(twoSeries());
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  for (const cv::Mat& picture : pictures)
  {
    QCOMPARE(cv::norm(picture, alone, cv::NORM_INF), 0.0);
  }
}

void PaintedPlotTest::nothingToDraw_IsRefused()
{
  Plot plot = twoSeries();
  plot.series[0].y[1] = std::nan("");
  QVERIFY_EXCEPTION_THROWN((void)paintPlot(plot), std::invalid_argument);
}

HANDEYE_WIDGET_TEST_MAIN(PaintedPlotTest)

#include "PaintedPlotTest.moc"
