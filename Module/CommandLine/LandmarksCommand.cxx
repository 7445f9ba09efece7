// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CommandOutput.h"
#include "Commands.h"
#include "LandmarkRegistration.h"
#include "ResultFiles.h"
#include "TextTables.h"

#include <memory>

namespace handeye::cli
{

namespace
{

struct LandmarksArguments
{
  std::string model, touched;
  CommandOutput output;
};

int runLandmarks(const LandmarksArguments& arguments)
{
  const LandmarkRegistrationResult registration =
    registerLandmarks(io::readPoints(arguments.model), io::readPoints(arguments.touched));
  if (registration.isUsable())
  {
    arguments.output.say("model's landmarks    " + arguments.model);
    arguments.output.say("touched landmarks    " + arguments.touched);
    arguments.output.say("modelToPhantom (mm)");
    arguments.output.say(matrixLines(registration.modelToPhantom.matrix(), "  ", 4));
    arguments.output.say(format("residual             %.3f mm RMS", registration.rmsMm));
    for (std::size_t i = 0; i < registration.residualsMm.size(); ++i)
    {
      arguments.output.say("  landmark " + std::to_string(i + 1) + format("         %.3f mm", registration.residualsMm[i]));
    }
  }
  return arguments.output.finish(phantomJson(registration));
}

}  // namespace

void addLandmarksCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<LandmarksArguments>();
  CLI::App* command = app.add_subcommand("landmarks", "Register a model to its phantom by touched landmarks");
  command->add_option("model-points", arguments->model, "Landmarks on the model, \"x y z\" a line, mm")
    ->required()
    ->type_name("MODEL-POINTS");
  command->add_option("touched-points", arguments->touched, "The same landmarks as touched, in the phantom marker's frame, mm")
    ->required()
    ->type_name("TOUCHED-POINTS");
  arguments->output.addTo(*command);
  command->callback([arguments, &exitCode] { exitCode = runLandmarks(*arguments); });
}

}  // namespace handeye::cli
