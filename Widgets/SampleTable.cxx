// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampleTable.h"

#include <QAction>
#include <QEvent>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QMenu>
#include <QScrollBar>
#include <QSortFilterProxyModel>
#include <QTableView>
#include <QToolButton>
#include <QUndoStack>
#include <QVBoxLayout>

#include <functional>

namespace handeye
{

namespace
{

/// A change of the samples as a pair of requests: the one, and its contrary.
class Request : public QUndoCommand
{
public:
  Request(const QString& text, std::function<void()> apply, std::function<void()> revert)
    : QUndoCommand(text)
    , apply_(std::move(apply))
    , revert_(std::move(revert))
  {
  }

  void redo() override { apply_(); }
  void undo() override { revert_(); }

private:
  std::function<void()> apply_, revert_;
};

}  // namespace

class SampleTable::Private
{
public:
  explicit Private(SampleTable& table)
    : q(table)
    , model(new SampleTableModel(&table))
    , proxy(new QSortFilterProxyModel(&table))
    , view(new QTableView(&table))
    , buttons(new QWidget(&table))
    , count(new QLabel(&table))
    , stack(new QUndoStack(&table))
  {
  }

  QAction* addAction(const QString& iconName, const QString& text, const QKeySequence& key, const QString& toolTip)
  {
    auto* action = new QAction(icon(iconName), text, &q);
    const QString keyText = key.toString(QKeySequence::NativeText);
    action->setToolTip(keyText.isEmpty() ? toolTip : QStringLiteral("%1 (%2)").arg(toolTip, keyText));
    action->setShortcut(key);
    action->setShortcutContext(Qt::WidgetWithChildrenShortcut);
    q.addAction(action);
    return action;
  }

  void addButton(QAction* action)
  {
    auto* button = new QToolButton(buttons);
    button->setDefaultAction(action);
    button->setAccessibleName(action->text());
    button->setAutoRaise(true);
    buttons->layout()->addWidget(button);
  }

  void setUpView();
  void setUpActions();
  void updateActions();
  void requestExclusion(const QVector<int>& ids, bool excluded);

  SampleTable& q;
  SampleTableModel* model;
  QSortFilterProxyModel* proxy;
  QTableView* view;
  QWidget* buttons;
  QLabel* count;
  QUndoStack* stack;
  QAction *exclude = nullptr, *include = nullptr, *remove = nullptr, *undo = nullptr, *redo = nullptr;
  bool editable = true;
};

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
  view->verticalHeader()->setDefaultSectionSize(52);
  view->setIconSize({ 16, 16 });
  QHeaderView* header = view->horizontalHeader();
  header->setMinimumSectionSize(24);
  header->setSectionResizeMode(QHeaderView::ResizeToContents);
  header->setSectionResizeMode(SampleTableModel::Thumbnail, QHeaderView::Fixed);
  header->resizeSection(SampleTableModel::Thumbnail, 76);
  header->setSectionResizeMode(SampleTableModel::Status, QHeaderView::Stretch);
  header->setHighlightSections(false);
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
  stack->push(new Request(
    text, [this, ids, excluded] { emit q.excludeRequested(ids, excluded); },
    [this, ids, excluded] { emit q.excludeRequested(ids, !excluded); }));
}

SampleTable::SampleTable(QWidget* parent)
  : QWidget(parent)
  , d(std::make_unique<Private>(*this))
{
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  auto* row = new QHBoxLayout(d->buttons);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(2);
  d->setUpView();
  d->setUpActions();
  auto* foot = new QHBoxLayout();
  foot->addWidget(d->buttons);
  foot->addStretch();
  foot->addWidget(d->count);
  layout->addWidget(d->view);
  layout->addLayout(foot);
  this->setFocusProxy(d->view);

  connect(d->model, &SampleTableModel::excludeRequested, this,
    [this](const QVector<int>& ids, bool excluded) { d->requestExclusion(ids, excluded); });
  connect(d->stack, &QUndoStack::indexChanged, this, [this] { d->updateActions(); });
  connect(d->view->selectionModel(), &QItemSelectionModel::selectionChanged, this, [this] { d->updateActions(); });
  connect(d->view->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
    [this](const QModelIndex& current)
    { emit currentSampleChanged(current.isValid() ? d->model->rows()[d->proxy->mapToSource(current).row()].id : -1); });
  connect(d->view, &QTableView::activated, this,
    [this](const QModelIndex& index) { emit sampleActivated(d->model->rows()[d->proxy->mapToSource(index).row()].id); });
  connect(d->view, &QTableView::customContextMenuRequested, this,
    [this](const QPoint& place)
    {
      auto* menu = new QMenu(this);
      menu->setAttribute(Qt::WA_DeleteOnClose);
      menu->addActions({ d->include, d->exclude, d->remove });
      menu->addSeparator();
      menu->addActions({ d->undo, d->redo });
      menu->popup(d->view->viewport()->mapToGlobal(place));
    });
  d->updateActions();
}

SampleTable::~SampleTable()
{
  // Stack and view outlive `d` by a moment, and speak while they go.
  d->stack->disconnect(this);
  d->view->selectionModel()->disconnect(this);
  d->view->disconnect(this);
}

void SampleTable::setRows(const QVector<SampleRow>& rows)
{
  const QScrollBar* bar = d->view->verticalScrollBar();
  const bool atEnd = bar->value() >= bar->maximum() - 4;
  const bool grew = rows.size() > d->model->rows().size();
  d->model->setRows(rows);
  d->updateActions();
  if (grew && atEnd && d->proxy->sortColumn() == SampleTableModel::Id && d->proxy->sortOrder() == Qt::AscendingOrder)
  {
    d->view->scrollToBottom();
  }
}

const QVector<SampleRow>& SampleTable::rows() const
{
  return d->model->rows();
}

void SampleTable::setEditable(bool editable)
{
  d->editable = editable;
  d->buttons->setVisible(editable);
  d->model->setCheckable(editable);
  d->view->setColumnHidden(SampleTableModel::Use, !editable);
  d->view->setContextMenuPolicy(editable ? Qt::CustomContextMenu : Qt::NoContextMenu);
  d->updateActions();
}

void SampleTable::setResidualTitle(const QString& title)
{
  d->model->setResidualTitle(title);
}

void SampleTable::clearHistory()
{
  d->stack->clear();
  d->updateActions();
}

QUndoStack* SampleTable::undoStack() const
{
  return d->stack;
}

QTableView* SampleTable::view() const
{
  return d->view;
}

QVector<int> SampleTable::selectedIds() const
{
  QVector<int> ids;
  const QModelIndexList selected = d->view->selectionModel()->selectedRows();
  for (const QModelIndex& index : selected)
  {
    ids.append(d->model->rows()[d->proxy->mapToSource(index).row()].id);
  }
  return ids;
}

void SampleTable::selectSample(int id)
{
  const int row = d->model->rowOf(id);
  if (row >= 0)
  {
    const QModelIndex index = d->proxy->mapFromSource(d->model->index(row, SampleTableModel::Id));
    d->view->selectRow(index.row());
    d->view->scrollTo(index);
  }
}

void SampleTable::excludeSelected(bool excluded)
{
  QVector<int> ids;
  for (const int id : this->selectedIds())
  {
    if (d->model->rows()[d->model->rowOf(id)].excluded != excluded)
    {
      ids.append(id);
    }
  }
  if (d->editable && !ids.isEmpty())
  {
    d->requestExclusion(ids, excluded);
  }
}

void SampleTable::deleteSelected()
{
  const QVector<int> ids = this->selectedIds();
  if (d->editable && !ids.isEmpty())
  {
    d->stack->push(new Request(
      counted(ids.size(), tr("delete a sample"), tr("delete %1 samples")), [this, ids] { emit deleteRequested(ids); },
      [this, ids] { emit restoreRequested(ids); }));
  }
}

void SampleTable::undo()
{
  if (d->editable)
  {
    d->stack->undo();
  }
}

void SampleTable::redo()
{
  if (d->editable)
  {
    d->stack->redo();
  }
}

QSize SampleTable::minimumSizeHint() const
{
  return { 240, 160 };
}

void SampleTable::resizeEvent(QResizeEvent* event)
{
  QWidget::resizeEvent(event);
  // In a narrow panel the status keeps the room for some words, and the table scrolls.
  const int words = 20 * this->fontMetrics().averageCharWidth();
  QHeaderView* header = d->view->horizontalHeader();
  int others = 0;
  for (int column = 0; column < SampleTableModel::ColumnCount; ++column)
  {
    others += column == SampleTableModel::Status ? 0 : header->sectionSize(column);
  }
  const bool isNarrow = d->view->viewport()->width() - others < words;
  header->setSectionResizeMode(SampleTableModel::Status, isNarrow ? QHeaderView::Fixed : QHeaderView::Stretch);
  if (isNarrow)
  {
    header->resizeSection(SampleTableModel::Status, words);
  }
}

void SampleTable::changeEvent(QEvent* event)
{
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange)
  {
    d->view->viewport()->update();
  }
}

}  // namespace handeye
