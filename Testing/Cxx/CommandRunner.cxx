// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CommandRunner.h"

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace handeye::testing
{

namespace
{

std::string quoted(const std::string& word)
{
  std::string text = "'";
  for (char c : word)
  {
    text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return text + "'";
}

}  // namespace

std::string readText(const std::filesystem::path& path)
{
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

CommandResult runCommand(
  const std::filesystem::path& program, const std::vector<std::string>& arguments, const std::filesystem::path& folder)
{
  std::filesystem::create_directories(folder);
  const std::filesystem::path out = folder / "stdout.txt", err = folder / "stderr.txt";
  std::string line = "env -u DISPLAY " + quoted(program.string());
  for (const std::string& argument : arguments)
  {
    line += " " + quoted(argument);
  }
  line += " >" + quoted(out.string()) + " 2>" + quoted(err.string()) + " </dev/null";
  const int status = std::system(line.c_str());
  CommandResult result;
  result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = readText(out);
  result.err = readText(err);
  return result;
}

}  // namespace handeye::testing
