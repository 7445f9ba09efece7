// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampleTablePrivate.h"

#include <QHBoxLayout>
#include <QHeaderView>
#include <QStyle>
#include <QToolButton>

#include <algorithm>
#include <utility>

namespace handeye
{

namespace
{

/// A change of the samples as a pair of requests: the one, and its contrary.
class Request : public QUndoCommand
{
public:
  Request(const QString& text, std::function<void()> apply, std::function<void()> revert, bool isDone)
    : QUndoCommand(text)
    , apply_(std::move(apply))
    , revert_(std::move(revert))
    , isDone_(isDone)
  {
  }

  /// The stack calls it also when it gets the command.
  void redo() override
  {
    if (!std::exchange(isDone_, false))
    {
      apply_();
    }
  }
  void undo() override { revert_(); }

private:
  std::function<void()> apply_, revert_;
  bool isDone_;
};

}  // namespace

QAction* SampleTable::Private::addAction(
  const QString& iconName, const QString& text, const QKeySequence& key, const QString& toolTip)
{
  auto* action = new QAction(icon(iconName), text, &q);
  const QString keyText = key.toString(QKeySequence::NativeText);
  action->setToolTip(keyText.isEmpty() ? toolTip : QStringLiteral("%1 (%2)").arg(toolTip, keyText));
  action->setShortcut(key);
  action->setShortcutContext(Qt::WidgetWithChildrenShortcut);
  q.addAction(action);
  return action;
}

void SampleTable::Private::addButton(QAction* action)
{
  auto* button = new QToolButton(buttons);
  button->setDefaultAction(action);
  button->setAccessibleName(action->text());
  button->setAutoRaise(true);
  buttons->layout()->addWidget(button);
}

void SampleTable::Private::push(const QString& text, std::function<void()> apply, std::function<void()> revert, bool isDone)
{
  stack->push(new Request(text, std::move(apply), std::move(revert), isDone));
}

void SampleTable::Private::setUpView()
{
  proxy->setSourceModel(model);
  proxy->setSortRole(SampleTableModel::SortRole);
  proxy->setSortLocaleAware(true);
  view->setModel(proxy);
  view->setAccessibleName(SampleTable::tr("Samples"));
  view->setSelectionBehavior(QAbstractItemView::SelectRows);
  view->setSelectionMode(QAbstractItemView::ExtendedSelection);
  view->setHorizontalScrollMode(QAbstractItemView::ScrollPerPixel);
  view->setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
  view->setAlternatingRowColors(true);
  view->setShowGrid(false);
  view->setWordWrap(true);
  view->setTabKeyNavigation(false);
  view->setContextMenuPolicy(Qt::CustomContextMenu);
  view->setSortingEnabled(true);
  view->sortByColumn(SampleTableModel::Id, Qt::AscendingOrder);
  view->verticalHeader()->hide();
  view->verticalHeader()->setSectionResizeMode(QHeaderView::Fixed);
  view->verticalHeader()->setDefaultSectionSize(SampleTableModel::thumbnailSize().height() + 4);
  view->setIconSize({ 16, 16 });
  QHeaderView* header = view->horizontalHeader();
  header->setMinimumSectionSize(24);
  header->setSectionResizeMode(QHeaderView::Fixed);
  header->resizeSection(SampleTableModel::Thumbnail, SampleTableModel::thumbnailSize().width() + 6);
  header->setSectionResizeMode(SampleTableModel::Status, QHeaderView::Stretch);
  header->setHighlightSections(false);
  // The words come last: in a narrow panel the numbers are seen, and the words' icon.
  header->moveSection(header->visualIndex(SampleTableModel::Status), SampleTableModel::ColumnCount - 1);
  fitColumns();
}

/// As wide as their titles and numbers. A header's own hint keeps room for the arrow of sorting in each column, too much for a panel.
void SampleTable::Private::fitColumns()
{
  constexpr int ArrowPx = 16;
  QHeaderView* header = view->horizontalHeader();
  const QFontMetrics metrics = header->fontMetrics();
  const int marginPx = 2 * header->style()->pixelMetric(QStyle::PM_HeaderMargin, nullptr, header) + 4;
  for (const int column : { SampleTableModel::Use, SampleTableModel::Id, SampleTableModel::ResidualPx, SampleTableModel::ResidualMm,
         SampleTableModel::DistanceMm })
  {
    const bool isResidual = column == SampleTableModel::ResidualPx || column == SampleTableModel::ResidualMm;
    int widest = metrics.horizontalAdvance(isResidual ? QStringLiteral("00.00") : QStringLiteral("000"));
    for (const QString& line : model->headerData(column, Qt::Horizontal, Qt::DisplayRole).toString().split(QLatin1Char('\n')))
    {
      widest = std::max(widest, metrics.horizontalAdvance(line));
    }
    mmColumnPx = column == SampleTableModel::ResidualMm ? widest + marginPx + ArrowPx : mmColumnPx;
    header->resizeSection(column, widest + marginPx + (header->sortIndicatorSection() == column ? ArrowPx : 0));
  }
}

void SampleTable::Private::setUpActions()
{
  exclude = this->addAction(QStringLiteral("exclude"), SampleTable::tr("Leave out"), Qt::Key_X,
    SampleTable::tr("Leaves the selected samples out of the calibration; they stay in the list"));
  include = this->addAction(QStringLiteral("include"), SampleTable::tr("Use again"), Qt::Key_I,
    SampleTable::tr("Takes the selected samples into the calibration again"));
  remove = this->addAction(
    QStringLiteral("delete"), SampleTable::tr("Delete"), QKeySequence::Delete, SampleTable::tr("Deletes the selected samples"));
  undo = this->addAction(
    QStringLiteral("undo"), SampleTable::tr("Undo"), QKeySequence::Undo, SampleTable::tr("Takes the last change back"));
  redo = this->addAction(
    QStringLiteral("redo"), SampleTable::tr("Redo"), QKeySequence(Qt::CTRL | Qt::Key_Y), SampleTable::tr("Makes it again"));
  redo->setShortcuts({ QKeySequence(Qt::CTRL | Qt::Key_Y), QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_Z) });
  for (QAction* action : { exclude, include, remove, undo, redo })
  {
    this->addButton(action);
  }
  static_cast<QHBoxLayout*>(buttons->layout())->addStretch();
  connect(exclude, &QAction::triggered, &q, [this] { q.excludeSelected(true); });
  connect(include, &QAction::triggered, &q, [this] { q.excludeSelected(false); });
  connect(remove, &QAction::triggered, &q, &SampleTable::deleteSelected);
  connect(undo, &QAction::triggered, &q, &SampleTable::undo);
  connect(redo, &QAction::triggered, &q, &SampleTable::redo);
}

void SampleTable::Private::updateActions()
{
  bool anyUsed = false, anyExcluded = false;
  const QVector<int> ids = q.selectedIds();
  for (const int id : ids)
  {
    const bool excluded = model->rows()[model->rowOf(id)].excluded;
    anyUsed = anyUsed || !excluded;
    anyExcluded = anyExcluded || excluded;
  }
  exclude->setEnabled(editable && anyUsed);
  include->setEnabled(editable && anyExcluded);
  remove->setEnabled(editable && !ids.isEmpty());
  undo->setEnabled(editable && stack->canUndo());
  redo->setEnabled(editable && stack->canRedo());
  undo->setText(stack->canUndo() ? SampleTable::tr("Undo: %1").arg(stack->undoText()) : SampleTable::tr("Undo"));
  redo->setText(stack->canRedo() ? SampleTable::tr("Redo: %1").arg(stack->redoText()) : SampleTable::tr("Redo"));
  int excludedCount = 0, usedCount = 0;
  for (const SampleRow& row : model->rows())
  {
    excludedCount += row.excluded ? 1 : 0;
    usedCount += row.used && !row.excluded ? 1 : 0;
  }
  const int total = model->rows().size();
  QString text = counted(total, SampleTable::tr("1 sample"), SampleTable::tr("%1 samples"));
  if (editable && !model->rows().isEmpty())
  {
    text = SampleTable::tr("%1 of %2 used").arg(usedCount).arg(total);
    text += excludedCount > 0 ? SampleTable::tr(", %1 left out").arg(excludedCount) : QString();
  }
  count->setText(text);
}

void SampleTable::Private::requestExclusion(const QVector<int>& ids, bool excluded)
{
  const QString text = excluded
    ? counted(ids.size(), SampleTable::tr("leave out a sample"), SampleTable::tr("leave out %1 samples"))
    : counted(ids.size(), SampleTable::tr("use a sample again"), SampleTable::tr("use %1 samples again"));
  push(
    text, [this, ids, excluded] { emit q.excludeRequested(ids, excluded); },
    [this, ids, excluded] { emit q.excludeRequested(ids, !excluded); });
}

/// In a narrow panel the status keeps the room for some words: the residual in mm, which the tooltip of that in px has as well, gives way,
/// and where that is not enough the table scrolls.
void SampleTable::Private::adjustStatusColumn()
{
  const int words = 12 * q.fontMetrics().averageCharWidth();
  QHeaderView* header = view->horizontalHeader();
  int others = 0;
  for (int column = 0; column < SampleTableModel::ColumnCount; ++column)
  {
    const bool isOptional = column == SampleTableModel::Status || column == SampleTableModel::ResidualMm;
    others += isOptional ? 0 : header->sectionSize(column);
  }
  const bool hasMm = view->viewport()->width() - others - mmColumnPx >= words;
  if (view->isColumnHidden(SampleTableModel::ResidualMm) == hasMm)
  {
    view->setColumnHidden(SampleTableModel::ResidualMm, !hasMm);
  }
  others += hasMm ? mmColumnPx : 0;
  const bool isNarrow = view->viewport()->width() - others < words;
  const QHeaderView::ResizeMode mode = isNarrow ? QHeaderView::Fixed : QHeaderView::Stretch;
  if (header->sectionResizeMode(SampleTableModel::Status) != mode)
  {
    header->setSectionResizeMode(SampleTableModel::Status, mode);
  }
  if (isNarrow && header->sectionSize(SampleTableModel::Status) != words)
  {
    header->resizeSection(SampleTableModel::Status, words);
  }
}

}  // namespace handeye
