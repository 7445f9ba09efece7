// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LogWindow.h"

#include "LogModel.h"

#include <QAction>
#include <QApplication>
#include <QClipboard>
#include <QComboBox>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSaveFile>
#include <QScrollBar>
#include <QTableView>
#include <QVBoxLayout>

#include <algorithm>
#include <memory>

namespace desktop
{

void LogFilter::setLowestLevel(int level)
{
  this->LowestLevel = level;
  this->invalidateFilter();
}

void LogFilter::setText(const QString& text)
{
  this->Text = text;
  this->invalidateFilter();
}

bool LogFilter::filterAcceptsRow(int row, const QModelIndex& parent) const
{
  const QModelIndex index = this->sourceModel()->index(row, LogModel::TextColumn, parent);
  return index.data(LogModel::LevelRole).toInt() >= this->LowestLevel &&
    (this->Text.isEmpty() || index.data().toString().contains(this->Text, Qt::CaseInsensitive));
}

LogWindow::LogWindow(LogModel* model, QWidget* parent)
  : QWidget(parent)
  , Model(model)
  , Filter(new LogFilter(this))
  , Table(new QTableView)
  , Level(new QComboBox)
{
  this->Filter->setSourceModel(model);
  this->Table->setModel(this->Filter);
  this->Table->setObjectName(QStringLiteral("LogTable"));
  this->Table->setAccessibleName(tr("Log"));
  this->Table->setSelectionBehavior(QAbstractItemView::SelectRows);
  this->Table->setEditTriggers(QAbstractItemView::NoEditTriggers);
  this->Table->setAlternatingRowColors(true);
  this->Table->setShowGrid(false);
  this->Table->setWordWrap(false);
  this->Table->verticalHeader()->hide();
  this->Table->verticalHeader()->setSectionResizeMode(QHeaderView::Fixed);
  this->Table->verticalHeader()->setDefaultSectionSize(this->fontMetrics().height() + 6);
  QHeaderView* const header = this->Table->horizontalHeader();
  header->setStretchLastSection(true);
  header->setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
  header->resizeSection(LogModel::TimeColumn, this->fontMetrics().horizontalAdvance(QStringLiteral("00:00:00.000")) + 24);
  header->resizeSection(LogModel::LevelColumn, this->fontMetrics().horizontalAdvance(tr("Warning")) + 48);

  this->Level->setObjectName(QStringLiteral("LogLevel"));
  this->Level->addItems({ tr("All"), tr("Warnings and errors"), tr("Errors") });
  this->Level->setAccessibleName(tr("Level of the log lines shown"));
  this->Level->setToolTip(tr("Which lines are shown"));
  connect(this->Level, QOverload<int>::of(&QComboBox::currentIndexChanged), this->Filter, &LogFilter::setLowestLevel);
  auto* const search = new QLineEdit;
  search->setPlaceholderText(tr("Find in the log"));
  search->setAccessibleName(tr("Find in the log"));
  search->setClearButtonEnabled(true);
  connect(search, &QLineEdit::textChanged, this->Filter, &LogFilter::setText);
  auto* const copyButton = new QPushButton(tr("&Copy"));
  copyButton->setToolTip(tr("Copies the selected lines, or all that are shown if none is selected"));
  connect(copyButton, &QPushButton::clicked, this, &LogWindow::copy);
  auto* const saveButton = new QPushButton(tr("&Save..."));
  saveButton->setToolTip(tr("Writes the selected lines, or all that are shown if none is selected, into a text file"));
  connect(saveButton, &QPushButton::clicked, this, &LogWindow::saveAs);
  auto* const clearButton = new QPushButton(tr("C&lear"));
  clearButton->setToolTip(tr("Empties the log"));
  connect(clearButton, &QPushButton::clicked, model, &LogModel::clear);

  auto* const bar = new QHBoxLayout;
  auto* const levelLabel = new QLabel(tr("Sho&w:"));
  levelLabel->setBuddy(this->Level);
  bar->addWidget(levelLabel);
  bar->addWidget(this->Level);
  bar->addWidget(search, 1);
  bar->addWidget(copyButton);
  bar->addWidget(saveButton);
  bar->addWidget(clearButton);
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 6, 6, 6);
  layout->addLayout(bar);
  layout->addWidget(this->Table);

  auto* const copyAction = new QAction(tr("Copy"), this->Table);
  copyAction->setShortcut(QKeySequence::Copy);
  copyAction->setShortcutContext(Qt::WidgetShortcut);
  connect(copyAction, &QAction::triggered, this, &LogWindow::copy);
  this->Table->addAction(copyAction);
  this->follow();
}

// The newest line stays in view as long as the person has not scrolled away from it.
void LogWindow::follow()
{
  QScrollBar* const bar = this->Table->verticalScrollBar();
  auto atEnd = std::make_shared<bool>(true);
  connect(
    this->Filter, &QAbstractItemModel::rowsAboutToBeInserted, this, [bar, atEnd] { *atEnd = bar->value() == bar->maximum(); });
  connect(this->Filter, &QAbstractItemModel::rowsInserted, this->Table,
    [this, atEnd]
    {
      if (*atEnd)
      {
        this->Table->scrollToBottom();
      }
    });
}

void LogWindow::setLowestLevel(int level)
{
  this->Level->setCurrentIndex(level);
}

int LogWindow::lowestLevel() const
{
  return this->Filter->lowestLevel();
}

QString LogWindow::text() const
{
  QModelIndexList rows = this->Table->selectionModel()->selectedRows();
  std::sort(rows.begin(), rows.end());
  if (rows.isEmpty())
  {
    for (int row = 0; row < this->Filter->rowCount(); ++row)
    {
      rows << this->Filter->index(row, 0);
    }
  }
  QString text;
  for (const QModelIndex& row : rows)
  {
    text += row.data(LogModel::LineRole).toString() + QLatin1Char('\n');
  }
  return text;
}

void LogWindow::copy()
{
  QApplication::clipboard()->setText(this->text());
}

void LogWindow::saveAs()
{
  const QString path =
    QFileDialog::getSaveFileName(this, tr("Save the log"), QStringLiteral("log.txt"), tr("Text (*.txt);;All files (*)"));
  if (!path.isEmpty())
  {
    this->save(path);
  }
}

bool LogWindow::save(const QString& path)
{
  QSaveFile file(path);
  if (file.open(QIODevice::WriteOnly | QIODevice::Text) && file.write(this->text().toUtf8()) >= 0 && file.commit())
  {
    return true;
  }
  this->Model->append(LogModel::Level::Error, tr("The log could not be saved as %1: %2").arg(path, file.errorString()));
  return false;
}

}  // namespace desktop
