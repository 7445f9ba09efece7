// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QSize>
#include <QString>
#include <QStringList>

namespace desktop
{

/// The command line of NavigationDesktop.
struct DesktopOptions
{
  enum class Action
  {
    Run,
    ShowHelp,
    ShowVersion,
    Refuse  ///< message says why
  };

  Action action = Action::Run;
  QString message;
  QStringList additionalModulePaths;
  QString module;  ///< to begin with
  QString screenshot;
  double screenshotDelaySec = 1.5;
  QSize size;  ///< of the window, px; invalid: as it was
  QString theme;
  bool demonstration = false;
  bool noSplash = false;
  bool exitAfterStartup = false;
  bool checkDisplay = false;  ///< only whether windows can be opened
  QStringList files;          ///< to open once the module is there

  /// @param arguments as main() has them, the program's name first
  static DesktopOptions parse(const QStringList& arguments);
  static QString help();
};

}  // namespace desktop
