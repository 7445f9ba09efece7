// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraFileWriter.h"
#include "CommandOutput.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace handeye::cli
{

/// The words for the kinds of camera file: "opencv", "ros", ...
const std::map<std::string, io::CameraFormat>& cameraFormats();

/// Says what was written, in words or as JSON. @return the exit code
int finishExport(const CommandOutput& output, const std::string& format, const std::vector<std::filesystem::path>& written);

}  // namespace handeye::cli
