// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RecentFiles.h"

#include <QDir>
#include <QFileInfo>
#include <QMenu>
#include <QSettings>

namespace desktop
{

static const QString settingsKey = QStringLiteral("Desktop/recentFiles");

RecentFiles::RecentFiles(QObject* parent)
  : QObject(parent)
  , Paths(QSettings().value(settingsKey).toStringList())
{
}

void RecentFiles::add(const QString& path)
{
  const QString absolute = QDir::cleanPath(QFileInfo(path).absoluteFilePath());
  this->Paths.removeAll(absolute);
  this->Paths.prepend(absolute);
  while (this->Paths.size() > maximumCount)
  {
    this->Paths.removeLast();
  }
  this->store();
}

void RecentFiles::clear()
{
  this->Paths.clear();
  this->store();
}

void RecentFiles::store() const
{
  QSettings().setValue(settingsKey, this->Paths);
}

void RecentFiles::attach(QMenu* menu)
{
  this->fill(menu);
  connect(menu, &QMenu::aboutToShow, this, [this, menu] { this->fill(menu); });
}

void RecentFiles::fill(QMenu* menu)
{
  menu->clear();
  menu->setToolTipsVisible(true);
  for (int i = 0; i < this->Paths.size(); ++i)
  {
    const QString path = this->Paths[i];
    const QFileInfo info(path);
    QString name = info.fileName();
    name.replace(QLatin1Char('&'), QStringLiteral("&&"));
    const QString folder = QDir::toNativeSeparators(info.dir().dirName());
    QAction* const action = menu->addAction(info.exists() ? tr("&%1  %2 (in %3)").arg((i + 1) % 10).arg(name, folder)
                                                          : tr("&%1  %2 (not there any more)").arg((i + 1) % 10).arg(name));
    action->setToolTip(QDir::toNativeSeparators(path));
    action->setData(path);
    action->setEnabled(info.exists());
    connect(action, &QAction::triggered, this, [this, path] { emit this->chosen(path); });
  }
  if (this->Paths.isEmpty())
  {
    menu->addAction(tr("Nothing yet"))->setEnabled(false);
    return;
  }
  menu->addSeparator();
  connect(menu->addAction(tr("&Clear this list")), &QAction::triggered, this, &RecentFiles::clear);
}

}  // namespace desktop
