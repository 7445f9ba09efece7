// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ReportPlot.h"

#include <QObject>

#include <functional>

namespace handeye
{

/// Draws plots of reports for a thread beside the window, in the window's own: VTK keeps fonts for the whole program and does not
/// guard them, and the window's charts use them, too.
///
/// @param inWindowThread lives there; nothing is drawn after its end
/// @param isEnding whether nobody waits for the plot any more; asked in the thread beside
/// @return for the thread beside only; it throws std::runtime_error where isEnding() says so, and whatever drawing throws
report::PlotDrawer drawInWindowThread(QObject& inWindowThread, std::function<bool()> isEnding);

}  // namespace handeye
