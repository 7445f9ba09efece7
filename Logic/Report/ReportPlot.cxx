// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PlotChart.h"

#include <opencv2/imgproc.hpp>
#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextActor.h>
#include <vtkContextScene.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlotLine.h>
#include <vtkPlotPoints.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace handeye::report
{

namespace
{

constexpr int BesidePlotPx = 90;  ///< what ticks and margins take beside a title, at least

void check(const Plot& plot)
{
  bool hasPoints = false;
  for (const PlotSeries& series : plot.series)
  {
    if (series.x.size() != series.y.size())
    {
      throw std::invalid_argument("plot series '" + series.label + "' has not as many x as y");
    }
    for (std::size_t i = 0; i < series.x.size(); ++i)
    {
      if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i]))
      {
        throw std::invalid_argument("point " + std::to_string(i) + " of plot series '" + series.label + "' is not finite");
      }
      hasPoints = hasPoints || !plot.isLogarithmic || series.y[i] > 0;
    }
  }
  if (!hasPoints)
  {
    throw std::invalid_argument("the plot '" + plot.title + "' has no points");
  }
}

struct Range
{
  double lowest = std::numeric_limits<double>::max(), highest = std::numeric_limits<double>::lowest();
  void add(double value)
  {
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
};

vtkSmartPointer<vtkTable> tableOf(const PlotSeries& series, bool isLogarithmic, Range& rangeX, Range& rangeY)
{
  vtkNew<vtkDoubleArray> x, y;
  x->SetName("x");
  y->SetName(series.label.c_str());
  for (std::size_t i = 0; i < series.x.size(); ++i)
  {
    if (isLogarithmic && series.y[i] <= 0)
    {
      continue;
    }
    // A chart with its own logarithm draws nothing at all where one number is not positive.
    const double value = isLogarithmic ? std::log10(series.y[i]) : series.y[i];
    x->InsertNextValue(series.x[i]);
    y->InsertNextValue(value);
    rangeX.add(series.x[i]);
    rangeY.add(value);
  }
  auto table = vtkSmartPointer<vtkTable>::New();
  table->AddColumn(x);
  table->AddColumn(y);
  return table;
}

void addSeries(vtkChartXY* chart, const PlotSeries& series, vtkTable* table)
{
  if (table->GetNumberOfRows() == 0)
  {
    return;
  }
  const int markers[] = { vtkPlotPoints::CIRCLE, vtkPlotPoints::SQUARE, vtkPlotPoints::DIAMOND, vtkPlotPoints::PLUS };
  const bool isLine = series.style == PlotSeries::Style::LineAndDots && table->GetNumberOfRows() > 1;
  auto* points = vtkPlotPoints::SafeDownCast(chart->AddPlot(isLine ? vtkChart::LINE : vtkChart::POINTS));
  points->SetInputData(table, 0, 1);
  points->SetLabel(series.label);
  points->SetColor(series.color[0], series.color[1], series.color[2], 255);
  points->GetBrush()->SetColor(series.color[0], series.color[1], series.color[2], 255);
  points->SetWidth(isLine ? 2.5F : 1.5F);
  points->GetPen()->SetLineType(isLine && series.isDashed ? vtkPen::DASH_LINE : vtkPen::SOLID_LINE);
  points->SetMarkerStyle(markers[series.marker % 4]);
  points->SetMarkerSize(isLine ? 9.0F : 11.0F);
}

/// Ticks 1, 2, 5 of each power of ten, those that are in the range.
void setLogarithmicTicks(vtkAxis* axis, double lowest, double highest)
{
  vtkNew<vtkDoubleArray> positions;
  vtkNew<vtkStringArray> labels;
  const bool isWide = highest - lowest > 3;
  for (int power = int(std::floor(lowest)); power <= int(std::ceil(highest)); ++power)
  {
    for (const double digit : { 1.0, 2.0, 5.0 })
    {
      const double position = power + std::log10(digit);
      if (position >= lowest && position <= highest && (!isWide || digit == 1.0))
      {
        char label[32];
        std::snprintf(label, sizeof(label), "%g", digit * std::pow(10.0, power));
        positions->InsertNextValue(position);
        labels->InsertNextValue(label);
      }
    }
  }
  axis->SetCustomTickPositions(positions, labels);
}

/// Ticks at whole numbers, about a dozen.
void setWholeTicks(vtkAxis* axis, double lowest, double highest)
{
  const int step = std::max(1, int(std::ceil((highest - lowest) / 15)));
  vtkNew<vtkDoubleArray> positions;
  vtkNew<vtkStringArray> labels;
  for (int tick = int(std::ceil(lowest / step)) * step; tick <= highest; tick += step)
  {
    positions->InsertNextValue(tick);
    labels->InsertNextValue(std::to_string(tick));
  }
  axis->SetCustomTickPositions(positions, labels);
}

/// By VTK's own fonts, which are one for the program and not guarded.
int widthByVtk(const std::string& text, vtkTextProperty* look)
{
  constexpr int Dpi = 72;  // a window's, in which a chart's sizes are pixels
  int box[4] = { 0, -1, 0, -1 };
  vtkNew<vtkTextProperty> level;
  level->ShallowCopy(look);
  level->SetOrientation(0);
  vtkTextRenderer* renderer = vtkTextRenderer::GetInstance();
  const bool isKnown = renderer != nullptr && renderer->GetBoundingBox(level, text, box, Dpi);
  return isKnown ? box[1] - box[0] + 1 : 0;
}

/// A text in as many lines as it needs; a chart cuts off what does not fit.
std::string wrapped(const std::string& text, vtkTextProperty* look, int room, const TextWidth& widthOf)
{
  std::istringstream words(text);
  std::string lines, line, word;
  while (words >> word)
  {
    const std::string longer = line.empty() ? word : line + " " + word;
    if (!line.empty() && widthOf(longer, look) > room)
    {
      lines += line + "\n";
      line = word;
    }
    else
    {
      line = longer;
    }
  }
  return lines + line;
}

void setUpAxis(vtkAxis* axis, const std::string& title, double lowest, double highest, int room, const TextWidth& widthOf)
{
  axis->SetBehavior(vtkAxis::FIXED);
  axis->SetRange(lowest, highest);
  axis->SetMinimumLimit(lowest);
  axis->SetMaximumLimit(highest);
  axis->GetTitleProperties()->SetFontSize(24);
  axis->GetTitleProperties()->BoldOff();
  axis->SetTitle(wrapped(title, axis->GetTitleProperties(), room, widthOf));
  axis->GetLabelProperties()->SetFontSize(21);
  axis->GetGridPen()->SetColor(225, 225, 225, 255);
}

void setUpAxes(vtkChartXY* chart, const Plot& plot, const Range& rangeX, const Range& rangeY, const TextWidth& widthOf)
{
  const double marginX = std::max(0.03 * (rangeX.highest - rangeX.lowest), 1e-3 * std::max(1.0, std::abs(rangeX.highest)));
  const int roomX = plot.width - BesidePlotPx, roomY = plot.height - BesidePlotPx;
  setUpAxis(chart->GetAxis(vtkAxis::BOTTOM), plot.xLabel, rangeX.lowest - marginX, rangeX.highest + marginX, roomX, widthOf);
  if (plot.hasWholeX)
  {
    setWholeTicks(chart->GetAxis(vtkAxis::BOTTOM), rangeX.lowest, rangeX.highest);
  }
  vtkAxis* left = chart->GetAxis(vtkAxis::LEFT);
  if (plot.isLogarithmic)
  {
    const double lowest = rangeY.lowest - 0.1, highest = std::max(rangeY.highest + 0.1, rangeY.lowest + 0.5);
    setUpAxis(left, plot.yLabel, lowest, highest, roomY, widthOf);
    setLogarithmicTicks(left, lowest, highest);
    return;
  }
  const double lowest = std::min(0.0, rangeY.lowest * 1.05);
  setUpAxis(left, plot.yLabel, lowest, rangeY.highest > lowest ? rangeY.highest * 1.08 : lowest + 1, roomY, widthOf);
}

void setUpChart(vtkChartXY* chart, const Plot& plot, const TextWidth& widthOf)
{
  chart->GetTitleProperties()->SetFontSize(26);
  chart->SetTitle(wrapped(plot.title, chart->GetTitleProperties(), plot.width - BesidePlotPx, widthOf));
  chart->SetShowLegend(plot.hasLegend && plot.series.size() > 1);
  vtkChartLegend* legend = chart->GetLegend();
  legend->SetInline(false);
  legend->SetHorizontalAlignment(vtkChartLegend::RIGHT);
  legend->SetVerticalAlignment(vtkChartLegend::TOP);
  legend->SetLabelSize(20);
  chart->SetAutoSize(true);
}

/// VTK's window for X11 ends the program where there is no X server.
void needDisplay(vtkRenderWindow* window)
{
  const char* display = std::getenv("DISPLAY");
  if (window->IsA("vtkXOpenGLRenderWindow") && (display == nullptr || *display == '\0'))
  {
    throw std::runtime_error("there is no display to render with");
  }
}

cv::Mat readPixels(vtkRenderWindow* window, int width, int height)
{
  vtkNew<vtkUnsignedCharArray> pixels;
  window->GetPixelData(0, 0, width - 1, height - 1, 0, pixels);
  if (pixels->GetNumberOfTuples() != vtkIdType(width) * height || pixels->GetNumberOfComponents() != 3)
  {
    throw std::runtime_error("the plot could not be rendered: there is no OpenGL here");
  }
  const cv::Mat rgb(height, width, CV_8UC3, pixels->GetPointer(0));
  cv::Mat picture;
  cv::cvtColor(rgb, picture, cv::COLOR_RGB2BGR);
  cv::flip(picture, picture, 0);
  return picture;
}

}  // namespace

Color seriesColor(std::size_t index)
{
  static const Color colors[] = { { 0, 90, 181 }, { 213, 70, 0 }, { 0, 140, 105 }, { 204, 100, 160 }, { 0, 0, 0 }, { 225, 150, 0 },
    { 70, 165, 220 }, { 130, 130, 130 }, { 125, 100, 0 } };
  return colors[index % (sizeof(colors) / sizeof(colors[0]))];
}

vtkSmartPointer<vtkChartXY> plotChart(const Plot& plot, const TextWidth& widthOf)
{
  check(plot);
  auto chart = vtkSmartPointer<vtkChartXY>::New();
  setUpChart(chart, plot, widthOf);
  Range rangeX, rangeY;
  for (const PlotSeries& series : plot.series)
  {
    addSeries(chart, series, tableOf(series, plot.isLogarithmic, rangeX, rangeY));
  }
  setUpAxes(chart, plot, rangeX, rangeY, widthOf);
  return chart;
}

cv::Mat drawPlot(const Plot& plot)
{
  const vtkSmartPointer<vtkChartXY> chart = plotChart(plot, widthByVtk);
  vtkNew<vtkContextActor> actor;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkRenderWindow> window;
  needDisplay(window);
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(4);
  window->SetSize(plot.width, plot.height);
  window->AddRenderer(renderer);
  renderer->SetBackground(1, 1, 1);
  renderer->AddActor(actor);
  actor->GetScene()->SetRenderer(renderer);
  actor->GetScene()->AddItem(chart);
  window->Render();
  return readPixels(window, plot.width, plot.height);
}

}  // namespace handeye::report
