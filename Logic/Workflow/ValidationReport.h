// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Recording.h"
#include "ValidationStep.h"

#include <filesystem>

namespace handeye
{

/// Writes what a validation is judged by with the eyes: `report.html` with the verdict, the figures and the plot of error against
/// distance, and one picture a frame with the segmented (green) and the projected (yellow) centre drawn on it.
///
/// @param folder made if it is not there
/// @throws io::FileError where something cannot be written
void writeValidationReport(const std::filesystem::path& folder, const ValidationStepResult& result, const io::Recording& recording);

}  // namespace handeye
