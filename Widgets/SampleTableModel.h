// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Look.h"

#include <QAbstractTableModel>
#include <QImage>
#include <QString>
#include <QVector>

#include <optional>

namespace handeye
{

/// The number of a sample for a person, who counts from 1; files have the id, from 0.
constexpr int sampleNumber(int id)
{
  return id + 1;
}

/// One sample as the table shows it.
struct SampleRow
{
  int id = -1;                        ///< of the session's sample, or the frame of a recording; each once
  QImage thumbnail;                   ///< about 96 px wide; may be null
  bool excluded = false;              ///< a person said that it is not to be used
  bool used = false;                  ///< the calibration uses it
  QString status;                     ///< in words: "ok", "disagrees with the others"
  Level level = Level::Info;          ///< of the status
  std::optional<double> residualPx;   ///< of the calibration's fit (or, in a validation, the projection error)
  std::optional<double> residualMm;   ///< distance of the tip to its ray
  std::optional<double> distanceMm;   ///< of the ball from the camera
  Level residualLevel = Level::Info;  ///< Warning, Error: the residual is marked with colour and icon
};

/// The rows of a SampleTable. A check box says whether a sample takes part; changing it asks for the change (excludeRequested), it is
/// setRows() that makes it.
class SampleTableModel : public QAbstractTableModel
{
  Q_OBJECT

public:
  enum Column
  {
    Use,
    Thumbnail,
    Id,
    Status,
    ResidualPx,
    ResidualMm,
    DistanceMm,
    ColumnCount
  };
  /// What a proxy sorts by.
  static constexpr int SortRole = Qt::UserRole + 1;
  /// At most, px without the screen's scaling.
  static QSize thumbnailSize() { return { 46, 34 }; }

  explicit SampleTableModel(QObject* parent = nullptr);

  /// @throws std::invalid_argument if an id occurs twice (naming it)
  void setRows(const QVector<SampleRow>& rows);
  const QVector<SampleRow>& rows() const { return rows_; }
  /// Whether the check box can be changed; true until set.
  void setCheckable(bool checkable);
  /// "Residual" until set.
  void setResidualTitle(const QString& title);
  /// The row of a sample; -1 if it is not there.
  int rowOf(int id) const;

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
  bool setData(const QModelIndex& index, const QVariant& value, int role = Qt::EditRole) override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role = Qt::DisplayRole) const override;

signals:
  void excludeRequested(QVector<int> ids, bool excluded);

private:
  QString text(const SampleRow& row, int column) const;
  QVariant sortKey(const SampleRow& row, int column) const;
  QString toolTip(const SampleRow& row, int column) const;

  QVector<SampleRow> rows_;
  QString residualTitle_;
  bool checkable_ = true;
};

}  // namespace handeye
