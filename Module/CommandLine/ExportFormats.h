// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CommandOutput.h"

#include <filesystem>
#include <string>
#include <vector>

namespace handeye::cli
{

/// Says what was written, in words or as JSON. @return the exit code
int finishExport(const CommandOutput& output, const std::string& format, const std::vector<std::filesystem::path>& written);

}  // namespace handeye::cli
