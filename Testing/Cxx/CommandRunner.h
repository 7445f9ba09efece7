// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace handeye::testing
{

struct CommandResult
{
  int exitCode = -1;
  std::string out;
  std::string err;

  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

/// Runs a program with no display and waits for it; its output is kept in `folder`.
CommandResult runCommand(
  const std::filesystem::path& program, const std::vector<std::string>& arguments, const std::filesystem::path& folder);

std::string readText(const std::filesystem::path& path);

}  // namespace handeye::testing
