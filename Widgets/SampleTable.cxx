// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampleTable.h"

#include "SampleTablePrivate.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QMenu>
#include <QScrollBar>
#include <QStyle>
#include <QTimer>
#include <QVBoxLayout>

namespace handeye
{

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
  connect(d->view->horizontalHeader(), &QHeaderView::sectionResized, this,
    [this](int column)
    {
      if (column != SampleTableModel::Status)
      {
        d->adjustStatusColumn();
      }
    });
  connect(d->view->horizontalHeader(), &QHeaderView::sortIndicatorChanged, this, [this] { d->fitColumns(); });
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
  this->setMinimumHeight(this->minimumSizeHint().height());  // also where a page ignores the hints
}

SampleTable::~SampleTable()
{
  // Stack and view outlive `d` by a moment, and speak while they go.
  d->stack->disconnect(this);
  d->view->selectionModel()->disconnect(this);
  d->view->disconnect(this);
  d->view->horizontalHeader()->disconnect(this);
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
  d->fitColumns();
}

void SampleTable::addUndoableSamples(const QVector<int>& ids, const QString& text)
{
  d->push(
    text, [this, ids] { emit restoreRequested(ids); }, [this, ids] { emit deleteRequested(ids); }, true);
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
    d->push(
      counted(ids.size(), tr("delete a sample"), tr("delete %1 samples")), [this, ids] { emit deleteRequested(ids); },
      [this, ids] { emit restoreRequested(ids); });
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
  constexpr int LeastRows = 3, HeaderLines = 2;
  const QHeaderView* header = d->view->horizontalHeader();
  const int headerPx = HeaderLines * header->fontMetrics().lineSpacing() +
    2 * header->style()->pixelMetric(QStyle::PM_HeaderMargin, nullptr, header) + 1;
  return { 240,
    headerPx + LeastRows * d->view->verticalHeader()->defaultSectionSize() + 2 * d->view->frameWidth() + this->layout()->spacing() +
      d->buttons->sizeHint().height() };
}

void SampleTable::resizeEvent(QResizeEvent* event)
{
  QWidget::resizeEvent(event);
  // Once the view has its size, which the layout gives it after this.
  QTimer::singleShot(0, this, [this] { d->adjustStatusColumn(); });
}

void SampleTable::changeEvent(QEvent* event)
{
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange)
  {
    d->view->viewport()->update();
  }
  else if (event->type() == QEvent::FontChange)
  {
    d->fitColumns();
    this->setMinimumHeight(this->minimumSizeHint().height());
  }
}

}  // namespace handeye
