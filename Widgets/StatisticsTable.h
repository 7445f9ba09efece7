// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ErrorSeries.h"

#include <QTableWidget>
#include <QVector>

namespace handeye
{

/// Mean, standard deviation, minimum, maximum, root mean square (px) and count of errors, one row per series; Ctrl+C copies it with
/// tabs.
class StatisticsTable : public QTableWidget
{
  Q_OBJECT

public:
  enum Column
  {
    Name,
    Mean,
    StandardDeviation,
    Minimum,
    Maximum,
    Rms,
    Count,
    ColumnCount
  };

  explicit StatisticsTable(QWidget* parent = nullptr);

  void setSeries(const QVector<ErrorSeries>& series);
  /// The table as lines with tabs, the titles first.
  QString toText() const;

  QSize sizeHint() const override;

protected:
  void keyPressEvent(QKeyEvent* event) override;
};

}  // namespace handeye
