// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Commands.h"

#include "FileError.h"

#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>

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
  addCalibrateCommand(app, exitCode);
  addValidateCommand(app, exitCode);
  addDetectCommand(app, exitCode);
  addRegisterCommand(app, exitCode);
  addLandmarksCommand(app, exitCode);
  addOverlayCommand(app, exitCode);
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
    std::cerr << "handeye: " << error.what() << "\nRun `handeye --help` or `handeye COMMAND --help` for the usage.\n";
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
