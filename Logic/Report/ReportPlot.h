// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace handeye::report
{

using Color = std::array<unsigned char, 3>;  ///< red, green, blue

/// Nine colours (Okabe and Ito's and a grey, darker where white paper asks for it) that people who confuse red and green can tell apart,
/// then again from the first.
Color seriesColor(std::size_t index);

struct PlotSeries
{
  enum class Style
  {
    Dots,
    LineAndDots
  };
  std::string label;
  Color color = { 0, 0, 0 };
  Style style = Style::Dots;
  int marker = 0;            ///< 0 to 3: circle, square, diamond, plus; no cross, which stands for failure
  bool isDashed = false;     ///< of a line
  std::vector<double> x, y;  ///< of the same length
};

struct Plot
{
  std::string title, xLabel, yLabel;
  std::vector<PlotSeries> series;
  bool isLogarithmic = false;  ///< of y; values that are not positive are left out then
  bool hasWholeX = false;      ///< x counts something: ticks at whole numbers only
  bool hasLegend = true;       ///< where there are several series
  int width = 1400, height = 720;
};

/// Draws a plot with vtkChartXY, off screen, legend at the right.
///
/// Renders with OpenGL as every VTK window does: a program without a display calls registerOffscreenRendering() first; with one,
/// the window is never shown. All plots of a process are to be drawn in one thread.
///
/// @return BGR, 8 bits
/// @throws std::invalid_argument where lists differ in length, a number is not finite or there is nothing to draw;
///         std::runtime_error where nothing can be rendered
[[nodiscard]] cv::Mat drawPlot(const Plot& plot);

/// Who draws a report's plots: drawPlot(), or a painter of one's own; see PlotChart.h.
using PlotDrawer = std::function<cv::Mat(const Plot&)>;

}  // namespace handeye::report
