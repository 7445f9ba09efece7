// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComparisonTable.h"

#include "ErrorDistancePlot.h"
#include "Look.h"
#include "ReportPlots.h"

#include <QApplication>
#include <QClipboard>
#include <QHeaderView>
#include <QKeyEvent>
#include <QLabel>
#include <QLocale>

#include <algorithm>

namespace handeye
{

namespace
{

bool contains(const std::vector<int>& indices, int index)
{
  return std::find(indices.begin(), indices.end(), index) != indices.end();
}

/// How many samples have an error, and how many there would be without failures.
QString countText(const MethodResult& method)
{
  const int all = method.successShare > 0 ? int(std::lround(method.errorPx.count / method.successShare)) : method.errorPx.count;
  const QLocale locale;
  return all > method.errorPx.count
    ? ComparisonTable::tr("%1 of %2").arg(locale.toString(method.errorPx.count), locale.toString(all))
    : locale.toString(all);
}

QString toolTipOf(const MethodResult& method)
{
  return ComparisonTable::tr("%1\n%2\nwith a %3; %4 of %5 calibrations usable, %6 s each")
           .arg(QString::fromStdString(method.title), QString::fromStdString(method.reference),
             QString::fromStdString(toString(method.target)))
           .arg(method.usableCount())
           .arg(method.captures.size())
           .arg(QLocale().toString(method.medianSeconds(), 'g', 2)) +
    (method.message.empty() ? QString() : QLatin1Char('\n') + QString::fromStdString(method.message));
}

}  // namespace

SeriesLook lookOfMethod(const ComparisonResult& result, std::size_t index)
{
  const report::MethodLook look = report::lookOf(result.methods, index);
  return { look.color, look.marker, look.isDashed };
}

std::vector<int> comparisonOrder(const ComparisonResult& result)
{
  std::vector<int> order = result.ranking;
  for (int i = 0; i < int(result.methods.size()); ++i)
  {
    if (!contains(order, i))
    {
      order.push_back(i);
    }
  }
  return order;
}

ComparisonTable::ComparisonTable(QWidget* parent)
  : QTableWidget(0, ColumnCount, parent)
{
  this->setAccessibleName(tr("Projection errors of the methods"));
  this->setHorizontalHeaderLabels(
    { tr("Method"), tr("Mean\n[px]"), tr("Std\n[px]"), tr("Min\n[px]"), tr("Max\n[px]"), tr("Samples") });
  this->verticalHeader()->hide();
  this->horizontalHeader()->setSectionResizeMode(QHeaderView::Fixed);
  this->horizontalHeader()->setSectionResizeMode(Name, QHeaderView::Stretch);
  this->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  this->horizontalHeader()->setHighlightSections(false);
  this->setEditTriggers(QAbstractItemView::NoEditTriggers);
  this->setSelectionBehavior(QAbstractItemView::SelectRows);
  this->setTabKeyNavigation(false);
  this->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  this->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void ComparisonTable::setResult(const ComparisonResult& result)
{
  result_ = result;
  this->setRowCount(0);
  for (const int index : comparisonOrder(result))
  {
    addMethod(result, index);
  }
  fitReasons();
}

void ComparisonTable::addMethod(const ComparisonResult& result, int index)
{
  const MethodResult& method = result.methods[std::size_t(index)];
  const int row = this->rowCount();
  this->insertRow(row);
  // The mark of the plots, and how it stands: in words for those who do not see it.
  const bool isAlike = contains(result.notToldApart, index), isApart = contains(result.incomplete, index);
  const QString sign = isAlike ? QStringLiteral(" \u2248") : isApart ? QStringLiteral(" \u26a0") : QString();
  const QString mark = method.isUsable()
    ? ErrorDistancePlot::markOf(lookOfMethod(result, std::size_t(index)), this->palette()) + QStringLiteral("&nbsp;")
    : QString();
  auto* name = new QLabel(mark + QString::fromStdString(method.name).toHtmlEscaped() + sign);
  name->setContentsMargins(4, 0, 4, 0);
  name->setToolTip(toolTipOf(method));
  this->setCellWidget(row, Name, name);
  const auto put = [&](int column, const QString& text)
  {
    auto* item = new QTableWidgetItem(text);
    item->setTextAlignment(int(Qt::AlignRight | Qt::AlignVCenter));
    item->setToolTip(toolTipOf(method));
    this->setItem(row, column, item);
  };
  this->setItem(row, Name, new QTableWidgetItem);
  const QString words = isAlike ? tr("not told apart from the first") : isApart ? tr("failed where others did not") : QString();
  this->item(row, Name)->setData(Qt::AccessibleTextRole, QString::fromStdString(method.name));
  this->item(row, Name)->setData(Qt::AccessibleDescriptionRole, words);
  if (method.isUsable())
  {
    const QLocale locale;
    put(Mean, locale.toString(method.errorPx.mean, 'f', 2));
    put(StandardDeviation, locale.toString(method.errorPx.standardDeviation, 'f', 2));
    put(Minimum, locale.toString(method.errorPx.minimum, 'f', 2));
    put(Maximum, locale.toString(method.errorPx.maximum, 'f', 2));
    put(Count, countText(method));
    return;
  }
  put(Mean, QString::fromStdString(statusWords(method.status) + ": " + method.message));
  this->item(row, Mean)->setTextAlignment(int(Qt::AlignLeft | Qt::AlignVCenter));
  this->setSpan(row, Mean, 1, ColumnCount - Mean);
}

/// A view makes the first of the columns that a text spans as wide as the text, and does not give it the lines that it needs.
void ComparisonTable::fitReasons()
{
  this->verticalHeader()->setDefaultSectionSize(this->fontMetrics().height() + 8);
  for (int column = Mean; column < ColumnCount; ++column)
  {
    int needed = this->horizontalHeader()->sectionSizeHint(column);
    for (int row = 0; row < this->rowCount(); ++row)
    {
      const QTableWidgetItem* item = this->columnSpan(row, Mean) > 1 ? nullptr : this->item(row, column);
      needed = std::max(needed, item ? this->fontMetrics().horizontalAdvance(item->text()) + 12 : 0);
    }
    this->setColumnWidth(column, needed);
  }
  int room = 0;
  for (int column = Mean; column < ColumnCount; ++column)
  {
    room += this->columnWidth(column);
  }
  for (int row = 0; row < this->rowCount(); ++row)
  {
    if (this->columnSpan(row, Mean) > 1)
    {
      const QRect words = this->fontMetrics().boundingRect(
        QRect(0, 0, std::max(80, room - 10), 10000), Qt::TextWordWrap | Qt::AlignLeft, this->item(row, Mean)->text());
      this->setRowHeight(row, std::max(this->verticalHeader()->defaultSectionSize(), words.height() + 6));
    }
  }
  this->updateGeometry();
}

QString ComparisonTable::toText() const
{
  QStringList lines{ tr("Method\tStanding\tMean [px]\tStd [px]\tMin [px]\tMax [px]\tSamples") };
  for (int row = 0; row < this->rowCount(); ++row)
  {
    const QTableWidgetItem* name = this->item(row, Name);
    QStringList cells{ name->data(Qt::AccessibleTextRole).toString(), name->data(Qt::AccessibleDescriptionRole).toString() };
    for (int column = Mean; column < ColumnCount && this->item(row, column); ++column)
    {
      cells << this->item(row, column)->text();
    }
    lines << cells.join(QLatin1Char('\t'));
  }
  return lines.join(QLatin1Char('\n'));
}

QSize ComparisonTable::sizeHint() const
{
  int height = this->horizontalHeader()->sizeHint().height() + 2 * this->frameWidth() + 2;
  for (int row = 0; row < this->rowCount(); ++row)
  {
    height += this->rowHeight(row);
  }
  return { 380, height };
}

QSize ComparisonTable::minimumSizeHint() const
{
  return { 300, sizeHint().height() };
}

void ComparisonTable::keyPressEvent(QKeyEvent* event)
{
  if (event->matches(QKeySequence::Copy))
  {
    QApplication::clipboard()->setText(this->toText());
    return;
  }
  QTableWidget::keyPressEvent(event);
}

void ComparisonTable::resizeEvent(QResizeEvent* event)
{
  QTableWidget::resizeEvent(event);
  fitReasons();
}

void ComparisonTable::changeEvent(QEvent* event)
{
  QTableWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange)
  {
    setResult(ComparisonResult(result_));
  }
}

}  // namespace handeye
