// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CommandOutput.h"

#include "Commands.h"
#include "ResultFiles.h"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <iostream>

namespace handeye::cli
{

void CommandOutput::addTo(CLI::App& command, bool withFile)
{
  command.add_flag("--json", this->json, "Print the result as one JSON object on standard output, messages on standard error");
  if (withFile)
  {
    // Found out before the work is done, not after it.
    const auto hasFolder = [](const std::string& path)
    {
      if (std::filesystem::is_directory(path))
      {
        return "'" + path + "' is a folder, a file is expected";
      }
      const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
      return std::filesystem::is_directory(folder)
        ? std::string()
        : "'" + path + "' cannot be written, there is no folder '" + folder.string() + "'";
    };
    command.add_option("-o,--output", this->file, "Write the result to this file")
      ->check(CLI::Validator(hasFolder, std::string()))
      ->type_name("FILE");
  }
}

void CommandOutput::say(const std::string& line) const
{
  (this->json ? std::cerr : std::cout) << line << '\n';
}

void CommandOutput::warn(const std::vector<std::string>& warnings) const
{
  for (const std::string& warning : warnings)
  {
    std::cerr << "warning: " << warning << '\n';
  }
}

int CommandOutput::finish(const nlohmann::json& result) const
{
  return this->finish(result, [&](const std::string& path) { writeJson(path, result); });
}

int CommandOutput::finish(const nlohmann::json& result, const std::function<void(const std::string&)>& write) const
{
  const bool usable = result.at("status") == "ok";
  if (usable && !this->file.empty())
  {
    write(this->file);
  }
  if (this->json)
  {
    std::cout << result.dump(2) << std::endl;
  }
  if (usable && !this->file.empty())
  {
    this->say("written to " + this->file);
  }
  if (!usable)
  {
    std::cerr << "no usable result: " << result.at("status").get<std::string>() << ": " << result.at("message").get<std::string>()
              << '\n';
    if (!this->file.empty())
    {
      std::cerr << this->file << " was not written\n";
    }
  }
  return usable ? Good : NotUsable;
}

Progress CommandOutput::progress(const std::string& what) const
{
  if (isatty(STDERR_FILENO) == 0)
  {
    return {};
  }
  return [what](int done, int total)
  {
    std::cerr << '\r' << what << ' ' << done << " of " << total << (done == total ? "\n" : "") << std::flush;
    return true;
  };
}

std::string format(const char* pattern, double a, double b, double c)
{
  char text[256];
  std::snprintf(text, sizeof(text), pattern, a, b, c);
  return text;
}

std::string numbers(const Eigen::VectorXd& values, int digits)
{
  std::string text;
  for (Eigen::Index i = 0; i < values.size(); ++i)
  {
    char number[64];
    std::snprintf(number, sizeof(number), "%s%*.*f", i > 0 ? " " : "", digits + 6, digits, values(i));
    text += number;
  }
  return text;
}

std::string matrixLines(const Eigen::Matrix4d& matrix, const std::string& indent, int digits)
{
  std::string text;
  for (int row = 0; row < 4; ++row)
  {
    text += indent + numbers(matrix.row(row).transpose(), digits) + (row < 3 ? "\n" : "");
  }
  return text;
}

std::string list(const std::vector<int>& values)
{
  std::string text;
  for (int value : values)
  {
    text += (text.empty() ? "" : ", ") + std::to_string(value);
  }
  return text.empty() ? "none" : text;
}

}  // namespace handeye::cli
