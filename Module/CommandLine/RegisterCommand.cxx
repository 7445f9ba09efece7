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
  bool keepAll = false;
  CommandOutput output;
};

int runRegister(const RegisterArguments& arguments)
{
  std::vector<PointLinePair> pairs;
  for (const io::PointAndLine& row : io::readPointsAndLines(arguments.table))
  {
    pairs.push_back({ row.point, row.lineOrigin, row.lineDirection, 1 });
  }
  PointLineOptions options = arguments.options;
  options.maximumMisfit = 4;
  options.findRivals = true;
  options.rejectOutliers = !arguments.keepAll;
  const PointLineResult registration = registerPointsToLines(pairs, options);
  if (registration.isUsable())
  {
    arguments.output.say(matrixLines(registration.pointsToLines.matrix(), "", 12));
    for (int row : registration.rejected)
    {
      std::cerr << "left out row " << row + 1
                << format(": disagrees with the others, %.3g mm from its line\n", registration.residualsMm[std::size_t(row)]);
    }
    if (arguments.options.method == PointLineOptions::Method::MaximumLikelihood)
    {
      std::cerr << format("noise %.3g mm, %.3g rad ", registration.sigmaMm, registration.sigmaRad)
                << (arguments.options.sigmaMm + arguments.options.sigmaRad > 0 ? "(given)" : "(estimated)") << "\n";
    }
    std::cerr << format(
      "residual %.6g mm RMS over %.0f points\n", registration.rmsMm, double(pairs.size() - registration.rejected.size()));
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
  command->add_flag("--keep-all", arguments->keepAll, "Use all rows, also those that disagree with the rest");
  addSigmaOption(*command, "--sigma-mm", arguments->options.sigmaMm,
    "ml: noise of the points, mm per axis; without any noise given it is estimated from the residuals");
  addSigmaOption(*command, "--sigma-rad", arguments->options.sigmaRad, "ml: noise of the rays' directions, rad per axis");
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runRegister(*arguments); });
}

}  // namespace handeye::cli
