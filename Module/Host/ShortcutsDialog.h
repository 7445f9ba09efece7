// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QDialog>
#include <QPair>
#include <QVector>

namespace desktop
{

/// What can be done with the keyboard: every action and shortcut of a window and its widgets that has keys, as they are now.
class ShortcutsDialog : public QDialog
{
  Q_OBJECT

public:
  explicit ShortcutsDialog(QWidget* window);

  /// What it does, and the keys; sorted, each once.
  static QVector<QPair<QString, QString>> shortcutsOf(const QWidget* window);
};

}  // namespace desktop
