// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampleTableModel.h"

#include <QApplication>
#include <QLocale>
#include <QPalette>
#include <QSet>

#include <limits>
#include <stdexcept>

namespace handeye
{

namespace
{

QString number(const std::optional<double>& value, int digits)
{
  return value ? QLocale().toString(*value, 'f', digits) : QString(QChar(0x2013));
}

/// What is not there comes last.
double sortValue(const std::optional<double>& value)
{
  return value.value_or(std::numeric_limits<double>::infinity());
}

/// As large as its cell, in device pixels.
QImage thumbnail(const QImage& picture)
{
  const double ratio = qApp->devicePixelRatio();
  QImage scaled = picture.scaled(SampleTableModel::thumbnailSize() * ratio, Qt::KeepAspectRatio, Qt::SmoothTransformation);
  scaled.setDevicePixelRatio(ratio);
  return scaled;
}

bool isResidual(int column)
{
  return column == SampleTableModel::ResidualPx || column == SampleTableModel::ResidualMm;
}

}  // namespace

SampleTableModel::SampleTableModel(QObject* parent)
  : QAbstractTableModel(parent)
{
}

void SampleTableModel::setRows(const QVector<SampleRow>& rows)
{
  QSet<int> ids;
  for (const SampleRow& row : rows)
  {
    if (ids.contains(row.id))
    {
      throw std::invalid_argument("sample " + std::to_string(row.id) + " is in the list twice");
    }
    ids.insert(row.id);
  }
  // Rows that stay keep their index, and with it the selection and the place in view.
  for (int index = rows_.size() - 1; index >= 0; --index)
  {
    if (!ids.contains(rows_[index].id))
    {
      this->beginRemoveRows({}, index, index);
      rows_.removeAt(index);
      this->endRemoveRows();
    }
  }
  for (const SampleRow& row : rows)
  {
    const int index = this->rowOf(row.id);
    if (index >= 0)
    {
      rows_[index] = row;
    }
    else
    {
      this->beginInsertRows({}, rows_.size(), rows_.size());
      rows_.append(row);
      this->endInsertRows();
    }
  }
  if (!rows_.isEmpty())
  {
    emit dataChanged(this->index(0, 0), this->index(rows_.size() - 1, ColumnCount - 1));
  }
}

void SampleTableModel::setResidualTitle(const QString& title)
{
  residualTitle_ = title;
  emit headerDataChanged(Qt::Horizontal, ResidualPx, ResidualMm);
}

void SampleTableModel::setCheckable(bool checkable)
{
  checkable_ = checkable;
  if (!rows_.isEmpty())
  {
    emit dataChanged(this->index(0, Use), this->index(rows_.size() - 1, Use));
  }
}

int SampleTableModel::rowOf(int id) const
{
  for (int index = 0; index < rows_.size(); ++index)
  {
    if (rows_[index].id == id)
    {
      return index;
    }
  }
  return -1;
}

int SampleTableModel::rowCount(const QModelIndex& parent) const
{
  return parent.isValid() ? 0 : rows_.size();
}

int SampleTableModel::columnCount(const QModelIndex& parent) const
{
  return parent.isValid() ? 0 : ColumnCount;
}

QVariant SampleTableModel::data(const QModelIndex& index, int role) const
{
  if (!index.isValid() || index.row() >= rows_.size())
  {
    return {};
  }
  const SampleRow& row = rows_[index.row()];
  const int column = index.column();
  const Level level = column == Status ? row.level : isResidual(column) ? row.residualLevel : Level::Info;
  switch (role)
  {
    case Qt::DisplayRole:
      return this->text(row, column);
    case SortRole:
      return this->sortKey(row, column);
    case Qt::CheckStateRole:
      return column == Use ? QVariant(row.excluded ? Qt::Unchecked : Qt::Checked) : QVariant();
    case Qt::DecorationRole:
      if (column == Thumbnail && !row.thumbnail.isNull())
      {
        return thumbnail(row.thumbnail);
      }
      return level == Level::Warning || level == Level::Error ? QVariant(levelIcon(level)) : QVariant();
    case Qt::ForegroundRole:
      if (row.excluded)
      {
        return QApplication::palette().color(QPalette::Disabled, QPalette::Text);
      }
      return level == Level::Info ? QVariant() : QVariant(levelColor(level, QApplication::palette()));
    case Qt::TextAlignmentRole:
      return column == Status || column == Use ? int(Qt::AlignLeft | Qt::AlignVCenter) : int(Qt::AlignRight | Qt::AlignVCenter);
    case Qt::ToolTipRole:
      return this->toolTip(row, column);
    case Qt::AccessibleTextRole:
      return column == Use ? (row.excluded ? tr("left out") : tr("used")) : QVariant(this->text(row, column));
    default:
      return {};
  }
}

QString SampleTableModel::text(const SampleRow& row, int column) const
{
  switch (column)
  {
    case Id:
      return QString::number(sampleNumber(row.id));
    case Status:
      return row.excluded ? tr("left out") : row.status;
    case ResidualPx:
      return number(row.residualPx, 2);
    case ResidualMm:
      return number(row.residualMm, 2);
    case DistanceMm:
      return number(row.distanceMm, 0);
    default:
      return {};
  }
}

QVariant SampleTableModel::sortKey(const SampleRow& row, int column) const
{
  switch (column)
  {
    case Use:
      return row.excluded ? 1 : 0;
    case Status:
      return this->text(row, column);
    case ResidualPx:
      return sortValue(row.residualPx);
    case ResidualMm:
      return sortValue(row.residualMm);
    case DistanceMm:
      return sortValue(row.distanceMm);
    default:
      return row.id;
  }
}

QString SampleTableModel::toolTip(const SampleRow& row, int column) const
{
  switch (column)
  {
    case Use:
      return row.excluded ? tr("Sample %1 is left out on request. Tick to use it.").arg(sampleNumber(row.id))
                          : tr("Sample %1 takes part. Take the tick away to leave it out.").arg(sampleNumber(row.id));
    case Thumbnail:
      return tr("Sample %1. Double click shows its picture.").arg(sampleNumber(row.id));
    case Status:
      return !row.excluded     ? row.status
        : row.status.isEmpty() ? tr("Left out on request")
                               : tr("Left out on request. Before: %1").arg(row.status);
    case ResidualPx:
      return tr("Between the projected tip and the segmented ball, px of the image") +
        (row.residualMm ? tr("; %1 mm off the ray").arg(number(row.residualMm, 2)) : QString());
    case ResidualMm:
      return tr("Of the tip from the ray on which the camera sees the ball, mm");
    case DistanceMm:
      return tr("Of the ball from the camera, mm");
    case Id:
      return tr("In files: frame %1").arg(row.id);
    default:
      return {};
  }
}

bool SampleTableModel::setData(const QModelIndex& index, const QVariant& value, int role)
{
  if (!checkable_ || !index.isValid() || index.column() != Use || role != Qt::CheckStateRole)
  {
    return false;
  }
  const SampleRow& row = rows_[index.row()];
  const bool excluded = value.toInt() != Qt::Checked;
  if (excluded != row.excluded)
  {
    emit excludeRequested({ row.id }, excluded);
  }
  return true;
}

Qt::ItemFlags SampleTableModel::flags(const QModelIndex& index) const
{
  Qt::ItemFlags flags = QAbstractTableModel::flags(index);
  if (checkable_ && index.column() == Use)
  {
    flags |= Qt::ItemIsUserCheckable;
  }
  return flags;
}

QVariant SampleTableModel::headerData(int section, Qt::Orientation orientation, int role) const
{
  if (orientation != Qt::Horizontal || section < 0 || section >= ColumnCount)
  {
    return {};
  }
  const QString residual = residualTitle_.isEmpty() ? tr("Residual") : residualTitle_;
  if (role == Qt::TextAlignmentRole && section == Status)
  {
    return int(Qt::AlignLeft | Qt::AlignVCenter);  // as its words: they are seen from the left
  }
  if (role == Qt::DisplayRole)
  {
    const QString titles[ColumnCount] = { tr("Use"), tr("Picture"), tr("No."), tr("Status"), tr("%1\n[px]").arg(residual),
      tr("%1\n[mm]").arg(residual), tr("Distance\n[mm]") };
    return titles[section];
  }
  if (role == Qt::ToolTipRole)
  {
    const QString texts[ColumnCount] = { tr("Whether the sample takes part"), tr("The ball in the image"),
      tr("Number of the sample, in the order of capturing"), tr("What the calibration made of the sample"),
      tr("Between the projected tip and the segmented ball, px of the image"),
      tr("Of the tip from the ray on which the camera sees the ball, mm"), tr("Of the ball from the camera, mm") };
    return texts[section];
  }
  return {};
}

}  // namespace handeye
