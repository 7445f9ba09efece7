// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "NavigationHost.h"

#include <QAbstractTableModel>
#include <QDateTime>

#include <deque>

namespace desktop
{

/// The lines of the log: time, level, text. The oldest go when there are too many. append() may be called from any thread; everything else
/// belongs to the thread of the user interface.
class LogModel : public QAbstractTableModel
{
  Q_OBJECT

public:
  using Level = NavigationHost::LogLevel;

  enum Columns
  {
    TimeColumn,
    LevelColumn,
    TextColumn,
    ColumnCount
  };
  enum Roles
  {
    LevelRole = Qt::UserRole,  ///< int of Level
    LineRole                   ///< the whole line, as it is copied and saved
  };

  explicit LogModel(QObject* parent = nullptr);

  /// A text of several lines stays one entry. What a listener of the log has to say of a line comes after it; what it has to say of that
  /// again is left out, since it would go on for ever.
  void append(Level level, const QString& text);
  void clear();
  void setMaximumCount(int count);

  /// How many of this level there were since the start or clear().
  int count(Level level) const;

  static QString levelName(Level level);

  int rowCount(const QModelIndex& parent = QModelIndex()) const override;
  int columnCount(const QModelIndex& parent = QModelIndex()) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

signals:
  void appended(NavigationHost::LogLevel level, const QString& text);
  void countsChanged();

private:
  struct Entry
  {
    QDateTime time;
    Level level;
    QString text;
  };

  enum class Storing
  {
    No,
    Line,
    LineOfAListener
  };

  void store(const QDateTime& time, Level level, const QString& text, Storing kind);
  void insert(const QDateTime& time, Level level, const QString& text);

  std::deque<Entry> Entries;
  int MaximumCount = 5000;
  int Counts[3] = {};
  Storing State = Storing::No;
};

}  // namespace desktop
