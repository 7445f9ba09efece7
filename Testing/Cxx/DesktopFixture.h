// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "DesktopTestMain.h"
#include "DesktopWindow.h"
#include "Theme.h"

#include <QTemporaryDir>

#include <memory>

/// A desktop with two small modules, from a folder of its own; settings begin empty. The test's init() and cleanup() call setUp() and
/// tearDown().
class DesktopFixture : public QObject
{
protected:
  void setUp()
  {
    QSettings().clear();
    desktop::applyTheme(desktop::Theme::Light);
    qApp->setProperty("calls", QStringList());
    this->Folder = std::make_unique<QTemporaryDir>();
    for (const char* const name : { "Witness", "First" })
    {
      const QString file = QString("libqSlicer%1Module.so").arg(name);
      QVERIFY(QFile::copy(HANDEYE_TEST_PLUGINS_DIR "/" + file, this->Folder->filePath(file)));
    }
    this->open();
  }

  void tearDown()
  {
    this->Window.reset();
    this->Folder.reset();
  }

  void open()
  {
    this->Window.reset();
    qApp->setProperty("calls", QStringList());
    this->Window = std::make_unique<desktop::DesktopWindow>();
    this->Window->loadModules({ this->Folder->path() });
    this->Window->resize(1280, 800);
    this->Window->show();
    QVERIFY(QTest::qWaitForWindowExposed(this->Window.get()));
    this->Window->activateWindow();
    QVERIFY(QTest::qWaitForWindowActive(this->Window.get()));
  }

  /// What the module Witness was called for.
  static QStringList calls() { return qApp->property("calls").toStringList(); }

  std::unique_ptr<QTemporaryDir> Folder;
  std::unique_ptr<desktop::DesktopWindow> Window;
};
