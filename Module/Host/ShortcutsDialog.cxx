// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ShortcutsDialog.h"

#include <QAction>
#include <QDialogButtonBox>
#include <QHeaderView>
#include <QMap>
#include <QShortcut>
#include <QTableWidget>
#include <QVBoxLayout>

namespace desktop
{

QVector<QPair<QString, QString>> ShortcutsDialog::shortcutsOf(const QWidget* window)
{
  QMap<QString, QStringList> keysOf;
  const auto add = [&](QString text, const QString& keys)
  {
    text = text.remove(QLatin1Char('&')).section(QStringLiteral(": "), 0, 0);  // "Redo: delete a sample" is "Redo"
    if (!text.isEmpty() && !keys.isEmpty() && !keysOf[text].contains(keys))
    {
      keysOf[text].append(keys);
    }
  };
  for (const QAction* const action : window->findChildren<QAction*>())
  {
    for (const QKeySequence& keys : action->shortcuts())
    {
      add(action->text(), keys.toString(QKeySequence::NativeText));
    }
  }
  // A shortcut has no text of its own: a module says in "what's this" what it does.
  for (const QShortcut* const shortcut : window->findChildren<QShortcut*>())
  {
    add(shortcut->whatsThis(), shortcut->key().toString(QKeySequence::NativeText));
  }
  for (const QWidget* const widget : window->findChildren<QWidget*>())
  {
    for (const QString& line : widget->property("keysAndWhatTheyDo").toStringList())
    {
      add(line.section(QLatin1Char('\t'), 1), line.section(QLatin1Char('\t'), 0, 0));
    }
  }
  QVector<QPair<QString, QString>> shortcuts;
  for (auto entry = keysOf.constBegin(); entry != keysOf.constEnd(); ++entry)
  {
    if (!entry->isEmpty())
    {
      shortcuts.append({ entry.key(), entry->join(tr(" or ")) });
    }
  }
  return shortcuts;
}

ShortcutsDialog::ShortcutsDialog(QWidget* window)
  : QDialog(window)
{
  this->setWindowTitle(tr("Keyboard shortcuts"));
  const auto shortcuts = shortcutsOf(window);
  auto* const table = new QTableWidget(shortcuts.size(), 2);
  table->setAccessibleName(tr("Keyboard shortcuts"));
  table->setHorizontalHeaderLabels({ tr("What it does"), tr("Keys") });
  table->verticalHeader()->hide();
  table->horizontalHeader()->setSectionResizeMode(0, QHeaderView::Stretch);
  table->horizontalHeader()->setSectionResizeMode(1, QHeaderView::ResizeToContents);
  table->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table->setSelectionBehavior(QAbstractItemView::SelectRows);
  table->setShowGrid(false);
  table->setAlternatingRowColors(true);
  for (int row = 0; row < shortcuts.size(); ++row)
  {
    table->setItem(row, 0, new QTableWidgetItem(shortcuts[row].first));
    table->setItem(row, 1, new QTableWidgetItem(shortcuts[row].second));
  }
  auto* const buttons = new QDialogButtonBox(QDialogButtonBox::Close);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* const layout = new QVBoxLayout(this);
  layout->addWidget(table);
  layout->addWidget(buttons);
  this->resize(480, 520);
}

}  // namespace desktop
