// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CommandOutput.h"
#include "Commands.h"
#include "CommonOptions.h"
#include "PointLineRegistration.h"
#include "ResultFiles.h"
#include "TextTables.h"

#include <iostream>
#include <memory>

namespace handeye::cli
{

namespace
{

struct RegisterArguments
{
  std::string table;
  PointLineOptions options;
  CommandOutput output;
};

int runRegister(const RegisterArguments& arguments)
{
  std::vector<PointLinePair> pairs;
  for (const io::PointAndLine& row : io::readPointsAndLines(arguments.table))
  {
    pairs.push_back({ row.point, row.lineOrigin, row.lineDirection, 1 });
  }
  const PointLineResult registration = registerPointsToLines(pairs, arguments.options);
  if (registration.isUsable())
  {
    arguments.output.say(matrixLines(registration.pointsToLines.matrix(), "", 12));
    std::cerr << format("residual %.6g mm RMS over %.0f points\n", registration.rmsMm, double(pairs.size()));
  }
  return arguments.output.finish(registrationJson(registration));
}

}  // namespace

void addRegisterCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<RegisterArguments>();
  CLI::App* command =
    app.add_subcommand("register", "Bring points onto lines: prints the 4x4 that maps the points' frame to the lines'");
  command->add_option("table", arguments->table, "Nine columns: point xyz, line origin xyz, line direction xyz; mm")
    ->required()
    ->type_name("POINTS-AND-LINES.txt");
  addSolverOption(*command, arguments->options.method);
  command->add_flag("--rays", arguments->options.linesAreRays, "The lines are rays: points must lie on the side they point to");
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runRegister(*arguments); });
}

}  // namespace handeye::cli
