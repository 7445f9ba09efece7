// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PlotAxes.h"

#include <QLocale>
#include <vtkAxis.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <cmath>

namespace handeye
{

PlotRanges PlotRanges::of(const QVector<ErrorSeries>& series, bool isLogarithmic, double leastAir)
{
  PlotRanges ranges;
  for (const ErrorSeries& one : series)
  {
    for (const QPointF& point : one.points)
    {
      const double y = isLogarithmic ? std::log10(point.y()) : point.y();
      if (std::isfinite(point.x()) && std::isfinite(y))
      {
        ranges.left = ranges.isEmpty ? point.x() : std::min(ranges.left, point.x());
        ranges.right = ranges.isEmpty ? point.x() : std::max(ranges.right, point.x());
        ranges.bottom = ranges.isEmpty ? y : std::min(ranges.bottom, y);
        ranges.top = ranges.isEmpty ? y : std::max(ranges.top, y);
        ranges.isEmpty = false;
      }
    }
  }
  const double air = std::max(leastAir, 0.05 * (ranges.right - ranges.left));
  ranges.left = std::max(0.0, ranges.left - air);
  ranges.right += air;
  ranges.bottom = isLogarithmic ? ranges.bottom - 0.08 : 0;
  ranges.top = isLogarithmic ? std::max(ranges.top + 0.08, ranges.bottom + 0.5) : std::max(0.1, 1.12 * ranges.top);
  return ranges;
}

void setPlainTicks(vtkAxis* axis, double begin, double end)
{
  const double rough = (end - begin) / 5;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  const double step = power * (rough / power < 1.5 ? 1 : rough / power < 3.5 ? 2 : rough / power < 7.5 ? 5 : 10);
  vtkNew<vtkDoubleArray> positions;
  vtkNew<vtkStringArray> labels;
  const int digits = std::max(0, int(-std::floor(std::log10(step) + 1e-9)));
  // A label at the very end would be cut off.
  for (double tick = step * std::ceil(begin / step - 1e-9); tick < end - 0.15 * step; tick += step)
  {
    positions->InsertNextValue(tick);
    labels->InsertNextValue(QLocale().toString(tick, 'f', digits).toStdString());
  }
  axis->SetCustomTickPositions(positions, labels);
}

void setLogarithmicTicks(vtkAxis* axis, double begin, double end)
{
  vtkNew<vtkDoubleArray> positions;
  vtkNew<vtkStringArray> labels;
  for (int power = int(std::floor(begin)); power <= int(std::ceil(end)); ++power)
  {
    for (const double digit : { 1.0, 2.0, 5.0 })
    {
      const double tick = power + std::log10(digit);
      if (tick >= begin && tick < end - 0.03 * (end - begin) && (digit == 1 || end - begin < 2.5))
      {
        positions->InsertNextValue(tick);
        labels->InsertNextValue(QLocale().toString(digit * std::pow(10, power), 'f', std::max(0, -power)).toStdString());
      }
    }
  }
  axis->SetCustomTickPositions(positions, labels);
}

}  // namespace handeye
