// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReportPlots.h"

#include <algorithm>
#include <cmath>

namespace handeye::report
{

namespace
{

/// Beyond this ratio of the largest to the least, a linear axis hides the small ones.
constexpr double LogarithmicFrom = 15;

/// By the methods' medians: single lucky samples near 0 do not ask for a logarithm.
bool needsLogarithm(const std::vector<PlotSeries>& all)
{
  double least = 1e300, largest = 0;
  for (const PlotSeries& series : all)
  {
    const double middle = median(series.y);
    least = std::min(least, middle);
    largest = std::max(largest, *std::max_element(series.y.begin(), series.y.end()));
  }
  return least > 0 && largest > LogarithmicFrom * least;
}

std::optional<Plot> plotOf(std::vector<PlotSeries> series, const char* title, const char* x, const char* y)
{
  series.erase(std::remove_if(series.begin(), series.end(), [](const PlotSeries& one) { return one.x.empty(); }), series.end());
  if (series.empty())
  {
    return {};
  }
  Plot plot;
  plot.title = title;
  plot.xLabel = x;
  plot.yLabel = y;
  plot.series = std::move(series);
  return plot;
}

void addErrors(const MethodResult& method, PlotSeries& series)
{
  for (const ComparedCapture& capture : method.captures)
  {
    for (const HandEyeValidationSample& sample : capture.validation.samples)
    {
      if (sample.status == CameraModel::Status::Ok)
      {
        series.x.push_back(sample.distanceMm);
        series.y.push_back(sample.errorPx);
      }
    }
  }
}

}  // namespace

MethodLook lookOf(const std::vector<MethodResult>& methods, std::size_t index)
{
  const MethodResult& method = methods.at(index);
  const auto place = std::size_t(std::count_if(methods.begin(), methods.begin() + std::ptrdiff_t(index),
    [&](const MethodResult& earlier) { return earlier.target == method.target; }));
  const bool isBoard = method.target == ComparedMethod::Target::Board;
  // After the ninth the colours come again, with other marks.
  return { int(place), isBoard ? 3 : int((place + place / 9) % 3), isBoard };
}

PlotSeries seriesOf(const std::vector<MethodResult>& methods, std::size_t index, PlotSeries::Style style)
{
  const MethodLook look = lookOf(methods, index);
  PlotSeries series;
  series.label = methods[index].name;
  series.color = seriesColor(std::size_t(look.color));
  series.marker = look.marker;
  series.isDashed = look.isDashed;
  series.style = style;
  return series;
}

std::optional<Plot> errorAgainstDistance(const std::vector<MethodResult>& methods)
{
  std::vector<PlotSeries> all;
  for (std::size_t i = 0; i < methods.size(); ++i)
  {
    PlotSeries series = seriesOf(methods, i, PlotSeries::Style::Dots);
    addErrors(methods[i], series);
    all.push_back(std::move(series));
  }
  std::optional<Plot> plot = plotOf(
    std::move(all), "Projection error against distance", "distance of the ball from the camera (mm)", "projection error (px)");
  if (plot)
  {
    plot->isLogarithmic = needsLogarithm(plot->series);
  }
  return plot;
}

std::optional<Plot> errorAgainstSamples(const std::vector<MethodResult>& methods)
{
  std::vector<PlotSeries> all;
  for (std::size_t i = 0; i < methods.size(); ++i)
  {
    PlotSeries series = seriesOf(methods, i, PlotSeries::Style::LineAndDots);
    for (const SubsetErrors& subset : methods[i].subsets)
    {
      // With the failures as the worst, the median is none where half of the subsets failed.
      if (std::isfinite(subset.medianPx))
      {
        series.x.push_back(subset.sampleCount);
        series.y.push_back(subset.medianPx);
      }
    }
    all.push_back(std::move(series));
  }
  std::optional<Plot> plot = plotOf(std::move(all), "Mean projection error against the number of samples",
    "samples in the random subsets", "mean projection error, median of the subsets (px)");
  if (plot)
  {
    plot->hasWholeX = true;
    plot->isLogarithmic = needsLogarithm(plot->series);
  }
  return plot;
}

std::optional<Plot> shareBelowError(const std::vector<MethodResult>& methods)
{
  constexpr int steps = 40;
  std::vector<PlotSeries> all;
  for (std::size_t i = 0; i < methods.size(); ++i)
  {
    PlotSeries errors = seriesOf(methods, i, PlotSeries::Style::LineAndDots);
    addErrors(methods[i], errors);
    std::sort(errors.y.begin(), errors.y.end());
    PlotSeries series = seriesOf(methods, i, PlotSeries::Style::LineAndDots);
    for (int k = 0; k <= steps && !errors.y.empty(); ++k)
    {
      const std::size_t last = std::size_t(std::lround(double(k) / steps * double(errors.y.size() - 1)));
      series.x.push_back(errors.y[last]);
      series.y.push_back(100.0 * double(last + 1) / double(errors.y.size()));
    }
    all.push_back(std::move(series));
  }
  return plotOf(std::move(all), "Share of the validation samples below an error", "projection error (px)",
    "samples with at most this error (%)");
}

std::optional<Plot> errorAgainstDistance(const ValidationStepResult& validation)
{
  PlotSeries series;
  series.color = seriesColor(0);
  for (const ValidatedFrame& frame : validation.frames)
  {
    if (frame.status == "ok")
    {
      series.x.push_back(frame.validated->distanceMm);
      series.y.push_back(frame.validated->errorPx);
    }
  }
  return plotOf(
    { series }, "Projection error against distance", "distance of the ball from the camera (mm)", "projection error (px)");
}

std::optional<Plot> errorDirections(const ValidationStepResult& validation)
{
  PlotSeries series;
  series.color = seriesColor(0);
  double reach = 0;
  for (const ValidatedFrame& frame : validation.frames)
  {
    if (frame.status == "ok")
    {
      const Eigen::Vector2d error = frame.validated->projected_Image - frame.captured.ball.ball_Image;
      series.x.push_back(error.x());
      series.y.push_back(-error.y());  // up in the plot is up in the image
      reach = std::max(reach, error.cwiseAbs().maxCoeff());
    }
  }
  series.label = "frames";
  std::optional<Plot> plot =
    plotOf({ series }, "Where the projected centre lies, seen from the segmented one", "to the right (px)", "upwards (px)");
  if (plot)
  {
    plot->width = plot->height = 720;
    // A cross through (0, 0), as wide as high.
    const double arm = std::max(0.1, 1.1 * reach);
    PlotSeries across, up;
    across.color = up.color = { 120, 120, 120 };
    across.style = up.style = PlotSeries::Style::LineAndDots;
    across.label = "no error";
    up.label = " ";
    across.marker = up.marker = 3;
    across.x = { -arm, arm };
    across.y = up.x = { 0, 0 };
    up.y = { -arm, arm };
    plot->series.push_back(across);
    plot->series.push_back(up);
    plot->hasLegend = false;
  }
  return plot;
}

std::optional<int> plateauOf(const MethodResult& method)
{
  std::optional<int> plateau;
  if (method.subsets.size() < 3 || method.subsets.back().usable == 0 || !std::isfinite(method.subsets.back().medianPx))
  {
    return plateau;
  }
  const double reached = method.subsets.back().medianPx;
  for (auto subset = method.subsets.rbegin(); subset != method.subsets.rend(); ++subset)
  {
    if (subset->medianPx > 1.1 * reached)
    {
      break;
    }
    plateau = subset->sampleCount;
  }
  // The last two alone are no plateau.
  return plateau && *plateau + 2 <= method.subsets.back().sampleCount ? plateau : std::nullopt;
}

}  // namespace handeye::report
