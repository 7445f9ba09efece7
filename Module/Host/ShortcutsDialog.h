// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QDialog>
#include <QPair>
#include <QVector>

namespace desktop
{

/// What can be done with the keyboard: every action and shortcut of a window and its widgets that has keys, as they are now.
/// A shortcut says in "what's this" what it does. Of keys that a widget handles itself, it says so in its property
/// `keysAndWhatTheyDo`: a list of texts, key and words with a tabulator between them.
class ShortcutsDialog : public QDialog
{
  Q_OBJECT

public:
  explicit ShortcutsDialog(QWidget* window);

  /// What it does, and the keys ("Ctrl+Y or Ctrl+Shift+Z"); sorted, each once.
  static QVector<QPair<QString, QString>> shortcutsOf(const QWidget* window);
};

}  // namespace desktop
