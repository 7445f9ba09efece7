// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Capture.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <functional>
#include <string>
#include <vector>

namespace handeye::cli
{

/// What all commands share: `--json`, `-o FILE`, and where text goes. With --json the result is one JSON object on standard output
/// and all messages go to standard error; otherwise the messages are the output.
struct CommandOutput
{
  bool json = false;
  std::string file;

  /// Adds --json and, unless the command has its own, -o FILE.
  void addTo(CLI::App& command, bool withFile = true);

  /// A line for the person.
  void say(const std::string& line) const;

  /// Warnings of a file that was read, on standard error.
  void warn(const std::vector<std::string>& warnings) const;

  /// Prints and stores a result. A result whose status is not "ok" is printed but not stored, so that a good file is not lost.
  /// @return the exit code
  int finish(const nlohmann::json& result) const;

  /// The same for a result that is stored otherwise. @param write is given the file's name
  int finish(const nlohmann::json& result, const std::function<void(const std::string&)>& write) const;

  /// A line on standard error that counts frames, only if that is a terminal.
  Progress progress(const std::string& what) const;
};

/// printf for short texts.
std::string format(const char* pattern, double a, double b = 0, double c = 0);

/// "0.123  -4.500  99.000"
std::string numbers(const Eigen::VectorXd& values, int digits);

/// A 4x4 matrix, one row a line, indented.
std::string matrixLines(const Eigen::Matrix4d& matrix, const std::string& indent, int digits);

/// "3, 7, 9", or "none"
std::string list(const std::vector<int>& values);

}  // namespace handeye::cli
