// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "SampleTable.h"

#include <QAction>
#include <QKeySequence>
#include <QLabel>
#include <QSortFilterProxyModel>
#include <QTableView>
#include <QUndoStack>

#include <functional>

namespace handeye
{

/// Private to SampleTable: its view and its actions, and what they do to the undo stack.
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

  QAction* addAction(const QString& iconName, const QString& text, const QKeySequence& key, const QString& toolTip);
  void addButton(QAction* action);
  /// A change of the samples as a pair of requests: the one, and its contrary. @param isDone it is made already
  void push(const QString& text, std::function<void()> apply, std::function<void()> revert, bool isDone = false);
  void setUpView();
  void setUpActions();
  void fitColumns();
  void updateActions();
  void adjustStatusColumn();
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
  int mmColumnPx = 0;  ///< what the residual in mm needs
};

}  // namespace handeye
