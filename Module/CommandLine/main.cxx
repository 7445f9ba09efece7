// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Commands.h"

#include "FileError.h"

#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <string>

namespace
{

/// CLI11 says of an unknown command only that one is required.
std::string explain(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv)
{
  if (argc < 2 || argv[1][0] == '-')
  {
    return error.what();
  }
  std::string commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
  {
    if (command->check_name(argv[1]))
    {
      return error.what();
    }
    commands += " " + command->get_name();
  }
  return "'" + std::string(argv[1]) + "' is not a command; there are:" + commands;
}

}  // namespace

int main(int argc, char** argv)
{
  using namespace handeye::cli;
  CLI::App app("Finds where a camera sits relative to its tracking marker, and draws virtual anatomy onto its video.\n"
               "Lengths are in mm, pixels are those of the recorded image; a transform aToB maps p_B = aToB * p_A.",
    "handeye");
  app.set_version_flag("--version", HANDEYE_VERSION);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::help);
  app.footer("Exit codes: 0 good; 1 the data do not allow a usable result; 2 wrong usage or an unreadable file.\n"
             "The usual way: pivot, calibrate, validate, landmarks, overlay. `handeye COMMAND --help` explains one.");
  int exitCode = Good;
  addPivotCommand(app, exitCode);
  addSpinCommand(app, exitCode);
  addCalibrateCommand(app, exitCode);
  addValidateCommand(app, exitCode);
  addCompareCommand(app, exitCode);
  addDetectCommand(app, exitCode);
  addRegisterCommand(app, exitCode);
  addLandmarksCommand(app, exitCode);
  addOverlayCommand(app, exitCode);
  addExportCommand(app, exitCode);
  addCameraConvertCommand(app, exitCode);
  addSimulateCommand(app, exitCode);
  addRecordCommand(app, exitCode);
  addCaptureCommand(app, exitCode);
  addStreamsCommand(app, exitCode);
  addLatencyCommand(app, exitCode);
  addStudyCommand(app, exitCode);
  try
  {
    app.parse(argc, argv);
    return exitCode;
  }
  catch (const CLI::Success& request)
  {
    return app.exit(request);
  }
  catch (const CLI::ParseError& error)
  {
    std::cerr << "handeye: " << explain(app, error, argc, argv)
              << "\nRun `handeye --help` or `handeye COMMAND --help` for the usage.\n";
    return WrongUse;
  }
  catch (const std::bad_alloc&)
  {
    std::cerr << "handeye: there is not enough memory for this input\n";
    return WrongUse;
  }
  catch (const std::exception& error)
  {
    std::cerr << "handeye: " << error.what() << '\n';
    return WrongUse;
  }
}
