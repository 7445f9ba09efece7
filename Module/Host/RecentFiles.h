// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QObject>
#include <QStringList>

class QMenu;

namespace desktop
{

/// The files and folders a person worked with last, newest first; remembered in the settings.
class RecentFiles : public QObject
{
  Q_OBJECT

public:
  static constexpr int maximumCount = 10;

  explicit RecentFiles(QObject* parent = nullptr);

  QStringList paths() const { return this->Paths; }
  /// To the front, absolute.
  void add(const QString& path);
  void clear();

  /// Fills a menu, now and whenever it opens. What is not there any more is shown so, and cannot be chosen.
  void attach(QMenu* menu);

signals:
  void chosen(const QString& path);

private:
  void fill(QMenu* menu);
  void store() const;

  QStringList Paths;
};

}  // namespace desktop
