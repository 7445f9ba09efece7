// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ReportPlot.h"

#include <vtkSmartPointer.h>

#include <functional>
#include <string>

class vtkChartXY;
class vtkTextProperty;

namespace handeye::report
{

/// How wide a line of text becomes in this look, px, without its orientation.
using TextWidth = std::function<int(const std::string& line, vtkTextProperty* look)>;

/// A plot as a chart, to be painted in plot.width x plot.height px by whoever says how wide texts become there.
/// @throws std::invalid_argument as drawPlot()
[[nodiscard]] vtkSmartPointer<vtkChartXY> plotChart(const Plot& plot, const TextWidth& widthOf);

}  // namespace handeye::report
