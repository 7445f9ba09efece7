// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QSortFilterProxyModel>
#include <QWidget>

class QComboBox;
class QLineEdit;
class QTableView;

namespace desktop
{

class LogModel;

/// Lines of one level and above, in which a text occurs.
class LogFilter : public QSortFilterProxyModel
{
  Q_OBJECT

public:
  using QSortFilterProxyModel::QSortFilterProxyModel;

  void setLowestLevel(int level);
  int lowestLevel() const { return this->LowestLevel; }
  void setText(const QString& text);

protected:
  bool filterAcceptsRow(int row, const QModelIndex& parent) const override;

private:
  int LowestLevel = 0;
  QString Text;
};

/// The log: a table with a filter; the selected lines, or all that are shown, can be copied and saved.
class LogWindow : public QWidget
{
  Q_OBJECT

public:
  explicit LogWindow(LogModel* model, QWidget* parent = nullptr);

  void setLowestLevel(int level);
  int lowestLevel() const;

  /// The selected lines, or all that are shown if none is selected, oldest first.
  QString text() const;

public slots:
  void copy();
  void saveAs();
  /// Writes what saveAs() would. @return false, and a message in the log, if the file cannot be written
  bool save(const QString& path);

private:
  void follow();

  LogModel* Model;
  LogFilter* Filter;
  QTableView* Table;
  QComboBox* Level;
};

}  // namespace desktop
