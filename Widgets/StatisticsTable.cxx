// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StatisticsTable.h"

#include "Look.h"

#include <QApplication>
#include <QClipboard>
#include <QHeaderView>
#include <QKeyEvent>
#include <QLocale>

namespace handeye
{

StatisticsTable::StatisticsTable(QWidget* parent)
  : QTableWidget(0, ColumnCount, parent)
{
  this->setAccessibleName(tr("Statistics of the errors"));
  this->setHorizontalHeaderLabels(
    { tr("Capture"), tr("Mean\n[px]"), tr("Std\n[px]"), tr("Min\n[px]"), tr("Max\n[px]"), tr("RMS\n[px]"), tr("Count") });
  const QStringList toolTips = { tr("What was measured"), tr("Mean of the errors, px"),
    tr("Standard deviation of the errors (n - 1), px"), tr("Smallest error, px"), tr("Largest error, px"),
    tr("Root of the mean square of the errors, px"), tr("Number of errors") };
  for (int column = 0; column < ColumnCount; ++column)
  {
    this->horizontalHeaderItem(column)->setToolTip(toolTips[column]);
  }
  this->verticalHeader()->hide();
  this->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  this->horizontalHeader()->setSectionResizeMode(Name, QHeaderView::Stretch);
  this->horizontalHeader()->setHighlightSections(false);
  this->setEditTriggers(QAbstractItemView::NoEditTriggers);
  this->setSelectionBehavior(QAbstractItemView::SelectRows);
  this->setTabKeyNavigation(false);
  this->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Maximum);
}

void StatisticsTable::setSeries(const QVector<ErrorSeries>& series)
{
  const QLocale locale;
  this->setRowCount(series.size());
  for (int row = 0; row < series.size(); ++row)
  {
    const Summary& summary = series[row].errorPx;
    const bool some = summary.count > 0;
    const auto number = [&](double value, bool known) { return known ? locale.toString(value, 'f', 2) : QString(QChar(0x2013)); };
    const QString texts[ColumnCount] = { series[row].name, number(summary.mean, some),
      number(summary.standardDeviation, summary.count > 1), number(summary.minimum, some), number(summary.maximum, some),
      number(summary.rms, some), locale.toString(summary.count) };
    for (int column = 0; column < ColumnCount; ++column)
    {
      auto* item = new QTableWidgetItem(texts[column]);
      item->setTextAlignment(int((column == Name ? Qt::AlignLeft : Qt::AlignRight) | Qt::AlignVCenter));
      item->setToolTip(this->horizontalHeaderItem(column)->toolTip());
      this->setItem(row, column, item);
    }
  }
  this->updateGeometry();
}

QString StatisticsTable::toText() const
{
  QStringList lines, titles;
  for (int column = 0; column < ColumnCount; ++column)
  {
    titles += this->horizontalHeaderItem(column)->text().replace(QLatin1Char('\n'), QLatin1Char(' '));
  }
  lines += titles.join(QLatin1Char('\t'));
  for (int row = 0; row < this->rowCount(); ++row)
  {
    QStringList cells;
    for (int column = 0; column < ColumnCount; ++column)
    {
      cells += this->item(row, column)->text();
    }
    lines += cells.join(QLatin1Char('\t'));
  }
  return lines.join(QLatin1Char('\n'));
}

QSize StatisticsTable::sizeHint() const
{
  int height = this->horizontalHeader()->sizeHint().height() + 2 * this->frameWidth();
  for (int row = 0; row < std::max(1, this->rowCount()); ++row)
  {
    height += this->rowCount() > 0 ? this->rowHeight(row) : this->verticalHeader()->defaultSectionSize();
  }
  return { 480, height + 2 };
}

void StatisticsTable::keyPressEvent(QKeyEvent* event)
{
  if (event->matches(QKeySequence::Copy))
  {
    QApplication::clipboard()->setText(this->toText());
    return;
  }
  QTableWidget::keyPressEvent(event);
}

}  // namespace handeye
