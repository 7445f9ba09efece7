// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ReportPlot.h"

#include <functional>

namespace handeye
{

/// Draws a plot of a report as report::drawPlot() does, with Qt's painter (vtkHandEyePainterDevice): without OpenGL and without VTK's
/// fonts, which are one for the program and not guarded. So it may be called beside the window, whose thread is left alone.
///
/// @return BGR, 8 bits
/// @throws std::invalid_argument as report::drawPlot()
[[nodiscard]] cv::Mat paintPlot(const report::Plot& plot);

/// The same for a report that may be unwanted before it is done: nothing more is drawn then (std::runtime_error).
[[nodiscard]] report::PlotDrawer paintUnless(std::function<bool()> isUnwanted);

}  // namespace handeye
