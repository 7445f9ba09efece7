// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallDetection.h"
#include "CommandOutput.h"
#include "PivotCalibration.h"
#include "PointLineRegistration.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace handeye::cli
{

/// Options that several commands have, so that they read alike everywhere.

void addRecordingArgument(CLI::App& command, std::string& recording, const std::string& what);
void addCameraOption(CLI::App& command, std::string& camera);
void addBallRadiusOption(CLI::App& command, double& ballRadiusMm);
void addSegmentationOption(CLI::App& command, BallDetectionOptions::Method& method);
void addSolverOption(CLI::App& command, PointLineOptions::Method& method);
/// A standard deviation of at least 0.
void addSigmaOption(CLI::App& command, const std::string& option, double& sigma, const std::string& what);
void addPivotMethodOption(CLI::App& command, PivotMethod& method);
/// `--latency MS`, in milliseconds; `latencySec` is in seconds.
void addLatencyOption(CLI::App& command, double& latencySec);

/// The same where a calibration has one of its own: nothing unless it is given.
void addLatencyOption(CLI::App& command, std::optional<double>& latencySec);

/// The latency of `--latency`, of the calibration otherwise; a warning where they differ.
double chooseLatency(const std::optional<double>& asked, double ofCalibrationSec, const CommandOutput& output);
void addCalibrationOption(CLI::App& command, std::string& calibration);

/// @param what "stylus", "camera's marker", ...; an empty `name` is said to be the calibration's
CLI::Option* addTransformOption(CLI::App& command, const std::string& option, std::string& name, const std::string& what);

}  // namespace handeye::cli
