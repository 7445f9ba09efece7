// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QStringList>
#include <QWidget>

class QAction;
class QLineEdit;
class QMenu;
class QToolButton;
class qSlicerAbstractModule;

namespace desktop
{

/// Chooses a module as in 3D Slicer: a menu by categories, a search over titles, names and categories, and a history with back, forward
/// and a list.
class ModuleSelector : public QWidget
{
  Q_OBJECT

public:
  explicit ModuleSelector(QWidget* parent = nullptr);

  /// A hidden module is left out.
  void addModule(qSlicerAbstractModule* module);

  /// @return false if there is no such module
  bool select(const QString& name);
  QString currentModule() const;
  /// Oldest first.
  QStringList history() const { return this->History; }

  QAction* backAction() const { return this->Back; }
  QAction* forwardAction() const { return this->Forward; }
  QAction* findAction() const { return this->Find; }

  /// After a change of theme.
  void updateIcons();

public slots:
  void back();
  void forward();
  /// The one that matches best; the search stays as it is when nothing does.
  void selectFound();

signals:
  void moduleSelected(const QString& name);

private:
  void makeHistoryActions();
  void goTo(int position);
  void showCurrent();
  void rebuildMenu();
  void rebuildHistoryMenu();
  QMenu* categoryMenu(const QString& category);
  qSlicerAbstractModule* find(const QString& name) const;
  void updateCompleter();
  static QString searchText(const qSlicerAbstractModule& module);

  QVector<qSlicerAbstractModule*> Modules;
  QStringList History;
  int Position = -1;
  QToolButton* Button;
  QMenu* Menu;
  QMenu* HistoryMenu;
  QLineEdit* Search;
  QAction* Back;
  QAction* Forward;
  QAction* Find;
  QToolButton* HistoryButton;
};

}  // namespace desktop
