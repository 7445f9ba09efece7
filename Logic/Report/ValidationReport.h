// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Recording.h"
#include "ReportPlot.h"
#include "ValidationStep.h"

#include <filesystem>

namespace handeye
{

/// Writes what a validation is judged by with the eyes: `report.html` (one file) and `report.pdf` with the verdict, the figures,
/// the plots of error against distance and of the errors' direction, every frame's row, and pictures of the frames in which errors
/// of a pixel can be seen (all of them up to 12, otherwise the worst, the best and those between); `errors.csv`; and one PNG a
/// frame with the segmented (green) and the projected (yellow) centre drawn on it, in the frame's own pixels.
///
/// @param folder made if it is not there
/// @throws io::FileError where something cannot be written
/// Plots and pages as report::drawPlot() and report::writeReport(): one thread, the application's.
void writeValidationReport(const std::filesystem::path& folder, const ValidationStepResult& result, const io::Recording& recording,
  const report::PlotDrawer& drawPlot = report::drawPlot);

}  // namespace handeye
