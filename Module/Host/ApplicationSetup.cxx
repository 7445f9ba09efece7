// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ApplicationSetup.h"

#include "Icons.h"

#include <QVTKOpenGLNativeWidget.h>

#include <QApplication>
#include <QDir>
#include <QSurfaceFormat>

static void initialiseResources()
{
  Q_INIT_RESOURCE(NavigationDesktop);
}

namespace desktop
{

void prepareApplication()
{
  QApplication::setAttribute(Qt::AA_EnableHighDpiScaling);
  QApplication::setAttribute(Qt::AA_UseHighDpiPixmaps);
  // A scale of 1.5 stays 1.5.
  QApplication::setHighDpiScaleFactorRoundingPolicy(Qt::HighDpiScaleFactorRoundingPolicy::PassThrough);
  QSurfaceFormat::setDefaultFormat(QVTKOpenGLNativeWidget::defaultFormat());
  QApplication::setOrganizationName(QStringLiteral("NavigationDesktop"));
  QApplication::setApplicationName(QStringLiteral("NavigationDesktop"));
  QApplication::setApplicationVersion(applicationVersion());
}

void finishApplication()
{
  initialiseResources();
  QApplication::setWindowIcon(QIcon(QStringLiteral(":/NavigationDesktop/NavigationDesktop.svg")));
  QApplication::setApplicationDisplayName(QStringLiteral("NavigationDesktop"));
}

QString applicationVersion()
{
  return QStringLiteral(DESKTOP_VERSION);
}

QStringList defaultModuleFolders()
{
  const QDir programs(QCoreApplication::applicationDirPath());
  const QStringList candidates = { programs.absoluteFilePath(QStringLiteral("../" DESKTOP_MODULES_FOLDER)),
    programs.absoluteFilePath(QStringLiteral("../lib/handeye/modules")) };
  QStringList folders;
  for (const QString& candidate : candidates)
  {
    const QString folder = QDir::cleanPath(candidate);
    if (QDir(folder).exists() && !folders.contains(folder))
    {
      folders << folder;
    }
  }
  return folders.isEmpty() ? QStringList{ QDir::cleanPath(candidates.first()) } : folders;
}

}  // namespace desktop
