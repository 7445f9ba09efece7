// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardDescription.h"

#include <CLI/CLI.hpp>

#include <string>

namespace handeye::cli
{

/// `--board BOARD`; a text that is no board is wrong usage, with what was expected.
void addBoardOption(CLI::App& command, std::string& board);

/// A board as a positional argument.
void addBoardArgument(CLI::App& command, std::string& board);

/// The subcommand group `camera`, made by whoever comes first.
CLI::App* cameraGroup(CLI::App& app);

}  // namespace handeye::cli
