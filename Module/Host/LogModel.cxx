// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LogModel.h"

#include "Icons.h"

#include <QThread>

#include <algorithm>

namespace desktop
{

LogModel::LogModel(QObject* parent)
  : QAbstractTableModel(parent)
{
}

void LogModel::append(Level level, const QString& text)
{
  const QDateTime now = QDateTime::currentDateTime();
  const bool isHere = QThread::currentThread() == this->thread();
  if (isHere && this->State == Storing::No)
  {
    this->store(now, level, text, Storing::Line);
  }
  else if (!isHere || this->State == Storing::Line)
  {
    const Storing kind = isHere ? Storing::LineOfAListener : Storing::Line;
    QMetaObject::invokeMethod(
      this, [this, now, level, text, kind] { this->store(now, level, text, kind); }, Qt::QueuedConnection);
  }
}

void LogModel::store(const QDateTime& time, Level level, const QString& text, Storing kind)
{
  this->State = kind;
  this->insert(time, level, text);
  this->State = Storing::No;
}

void LogModel::insert(const QDateTime& time, Level level, const QString& text)
{
  const int row = int(this->Entries.size());
  if (row >= this->MaximumCount)
  {
    const int surplus = row - this->MaximumCount + 1;
    this->beginRemoveRows({}, 0, surplus - 1);
    this->Entries.erase(this->Entries.begin(), this->Entries.begin() + surplus);
    this->endRemoveRows();
  }
  const int end = int(this->Entries.size());
  this->beginInsertRows({}, end, end);
  this->Entries.push_back({ time, level, text });
  this->endInsertRows();
  ++this->Counts[int(level)];
  emit this->countsChanged();
  emit this->appended(level, text);
}

void LogModel::clear()
{
  this->beginResetModel();
  this->Entries.clear();
  std::fill(std::begin(this->Counts), std::end(this->Counts), 0);
  this->endResetModel();
  emit this->countsChanged();
}

void LogModel::setMaximumCount(int count)
{
  this->MaximumCount = std::max(1, count);
}

int LogModel::count(Level level) const
{
  return this->Counts[int(level)];
}

QString LogModel::levelName(Level level)
{
  switch (level)
  {
    case Level::Info:
      return tr("Info");
    case Level::Warning:
      return tr("Warning");
    case Level::Error:
      return tr("Error");
  }
  return {};
}

int LogModel::rowCount(const QModelIndex& parent) const
{
  return parent.isValid() ? 0 : int(this->Entries.size());
}

int LogModel::columnCount(const QModelIndex& parent) const
{
  return parent.isValid() ? 0 : ColumnCount;
}

QVariant LogModel::data(const QModelIndex& index, int role) const
{
  if (!index.isValid() || index.row() >= this->rowCount())
  {
    return {};
  }
  const Entry& entry = this->Entries[size_t(index.row())];
  const QString time = entry.time.toString(QStringLiteral("HH:mm:ss.zzz"));
  switch (role)
  {
    case LevelRole:
      return int(entry.level);
    case LineRole:
      return QStringLiteral("%1  %2  %3").arg(entry.time.toString(Qt::ISODateWithMs), levelName(entry.level), entry.text);
    case Qt::DecorationRole:
      if (index.column() == LevelColumn && entry.level != Level::Info)
      {
        return levelIcon(entry.level);
      }
      return {};
    case Qt::ToolTipRole:
      return index.column() == TextColumn ? entry.text : QVariant();
    case Qt::DisplayRole:
      return index.column() == TimeColumn ? time : index.column() == LevelColumn ? levelName(entry.level) : entry.text;
    default:
      return {};
  }
}

QVariant LogModel::headerData(int section, Qt::Orientation orientation, int role) const
{
  if (orientation != Qt::Horizontal || role != Qt::DisplayRole)
  {
    return {};
  }
  switch (section)
  {
    case TimeColumn:
      return tr("Time");
    case LevelColumn:
      return tr("Level");
    case TextColumn:
      return tr("Message");
    default:
      return {};
  }
}

}  // namespace desktop
