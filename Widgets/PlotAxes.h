// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ErrorSeries.h"

#include <QVector>

class vtkAxis;

namespace handeye
{

/// The ends of the axes of errors (px) over something, and their ticks. Internal to the plots.
struct PlotRanges
{
  double left = 0, right = 1;
  double bottom = 0, top = 1;  ///< of a logarithmic axis the logarithms
  bool isEmpty = true;

  /// All points that can be drawn, with some air; a plain axis of errors begins at none.
  /// @param leastAir left and right, in the unit of x
  static PlotRanges of(const QVector<ErrorSeries>& series, bool isLogarithmic, double leastAir);
};

/// About five round numbers (1, 2, 5 times a power of ten) for an axis. VTK's own choice does not ask how large the labels are.
void setPlainTicks(vtkAxis* axis, double begin, double end);

/// 1, 2 and 5 times the powers of ten, or the powers alone where they are many.
/// @param begin,end logarithms to the base of 10
void setLogarithmicTicks(vtkAxis* axis, double begin, double end);

}  // namespace handeye
