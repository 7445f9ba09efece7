// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ReportPlot.h"

namespace handeye
{

/// Draws a plot of a report as report::drawPlot() does, with Qt's painter (vtkHandEyePainterDevice): without OpenGL and without VTK's
/// fonts, which are one for the program and not guarded. So it may be called beside the window, whose thread is left alone.
///
/// @return BGR, 8 bits
/// @throws std::invalid_argument as report::drawPlot()
[[nodiscard]] cv::Mat paintPlot(const report::Plot& plot);

}  // namespace handeye
