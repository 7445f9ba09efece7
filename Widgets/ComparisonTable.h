// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ErrorSeries.h"
#include "MethodComparison.h"

#include <QTableWidget>

namespace handeye
{

/// The methods of a comparison: mean, standard deviation, minimum and maximum of their projection errors (px) and of how many
/// samples, the best first; behind them those that failed so often that their errors are of easy cases, and those that gave nothing,
/// with the reason. Ctrl+C copies it with tabs.
class ComparisonTable : public QTableWidget
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
    Count,
    ColumnCount
  };

  explicit ComparisonTable(QWidget* parent = nullptr);

  void setResult(const ComparisonResult& result);
  /// The table as lines with tabs, the titles first.
  QString toText() const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

protected:
  void keyPressEvent(QKeyEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;

private:
  void addMethod(const ComparisonResult& result, int index);
  void fitReasons();

  ComparisonResult result_;
};

/// The look of a method in plots and tables, which is that of the report.
[[nodiscard]] SeriesLook lookOfMethod(const ComparisonResult& result, std::size_t index);

/// The methods in the order in which a comparison is shown: ranked, ranked apart, failed.
[[nodiscard]] std::vector<int> comparisonOrder(const ComparisonResult& result);

}  // namespace handeye
