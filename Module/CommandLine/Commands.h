// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace handeye::cli
{

/// What the process returns.
enum ExitCode
{
  Good = 0,
  NotUsable = 1,  ///< the data do not allow a usable result; the status and its reason are printed
  WrongUse = 2    ///< wrong usage, or a file that cannot be read or written
};

/// Each adds one command with its options to the program. Its callback runs the command and stores the exit code.
void addPivotCommand(CLI::App& app, int& exitCode);
void addSpinCommand(CLI::App& app, int& exitCode);
void addCalibrateCommand(CLI::App& app, int& exitCode);
void addValidateCommand(CLI::App& app, int& exitCode);
void addCompareCommand(CLI::App& app, int& exitCode);
void addDetectCommand(CLI::App& app, int& exitCode);
void addRegisterCommand(CLI::App& app, int& exitCode);
void addLandmarksCommand(CLI::App& app, int& exitCode);
void addOverlayCommand(CLI::App& app, int& exitCode);
void addExportCommand(CLI::App& app, int& exitCode);
void addCameraConvertCommand(CLI::App& app, int& exitCode);
void addSimulateCommand(CLI::App& app, int& exitCode);
void addRecordCommand(CLI::App& app, int& exitCode);
void addCaptureCommand(CLI::App& app, int& exitCode);
void addStreamsCommand(CLI::App& app, int& exitCode);
void addLatencyCommand(CLI::App& app, int& exitCode);
void addStudyCommand(CLI::App& app, int& exitCode);

}  // namespace handeye::cli
