// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Theme.h"

#include <QDialog>
#include <QStringList>

class QCheckBox;
class QComboBox;
class QListWidget;

namespace desktop
{

/// What the desktop remembers of a person's wishes.
struct DesktopSettings
{
  Theme theme = Theme::System;
  QStringList moduleFolders;  ///< besides the ones that belong to the program
  QString startModule;        ///< name; empty: the one of last time, or the first
  int logLevel = 0;           ///< lowest level of the log lines shown
  bool showSplash = true;

  static DesktopSettings load();
  void save() const;
};

/// The settings, to be changed. Theme and log change with OK; folders of modules at the next start, which the dialog says.
class SettingsDialog : public QDialog
{
  Q_OBJECT

public:
  /// @param modules names and titles to choose the start module from
  SettingsDialog(const DesktopSettings& settings, const QVector<QPair<QString, QString>>& modules, QWidget* parent);

  DesktopSettings settings() const;

private:
  QWidget* makeModulesPage(const DesktopSettings& settings, const QVector<QPair<QString, QString>>& modules);
  void addFolder();

  QComboBox* ThemeBox;
  QListWidget* Folders;
  QComboBox* StartModule;
  QComboBox* LogLevel;
  QCheckBox* Splash;
};

}  // namespace desktop
