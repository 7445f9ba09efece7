// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Menus, tool bar and keys of DesktopWindow.
#include "AboutDialog.h"
#include "DesktopWindow.h"
#include "Icons.h"
#include "ModuleLoader.h"
#include "ModuleSelector.h"
#include "RecentFiles.h"
#include "SceneView.h"
#include "ShortcutsDialog.h"
#include "ViewArea.h"
#include "qSlicerLoadableModule.h"

#include <QAction>
#include <QActionGroup>
#include <QDir>
#include <QDockWidget>
#include <QFileDialog>
#include <QMenu>
#include <QMenuBar>
#include <QSettings>
#include <QToolBar>

namespace desktop
{

void DesktopWindow::makeActions()
{
  this->Selector = new ModuleSelector;
  connect(this->Selector, &ModuleSelector::moduleSelected, this, &DesktopWindow::moduleChosen);
  QToolBar* const modules = this->addToolBar(tr("Modules"));
  modules->setObjectName(QStringLiteral("ModulesBar"));
  modules->addWidget(this->Selector);
  QToolBar* const views = this->addToolBar(tr("Views"));
  views->setObjectName(QStringLiteral("ViewsBar"));

  this->makeFileMenu();
  this->makeViewMenu();
  views->addActions(this->Layouts->actions());
  QMenu* const module = this->menuBar()->addMenu(tr("&Module"));
  module->addAction(this->Selector->findAction());
  module->addAction(this->Selector->backAction());
  module->addAction(this->Selector->forwardAction());
  this->makeHelpMenu();
}

void DesktopWindow::makeFileMenu()
{
  QMenu* const file = this->menuBar()->addMenu(tr("&File"));
  QAction* const open = file->addAction(tr("&Open a file..."), this, &DesktopWindow::openFileDialog, QKeySequence::Open);
  open->setObjectName(QStringLiteral("open"));
  QAction* const folder = file->addAction(
    tr("Open a &folder..."), this, &DesktopWindow::openFolderDialog, QKeySequence(Qt::CTRL + Qt::SHIFT + Qt::Key_O));
  folder->setObjectName(QStringLiteral("open-folder"));
  this->Recent->attach(file->addMenu(tr("Open &recent")));
  file->addSeparator();
  QAction* const settings =
    file->addAction(tr("&Settings..."), this, &DesktopWindow::editSettings, QKeySequence(Qt::CTRL + Qt::Key_Comma));
  settings->setObjectName(QStringLiteral("settings"));
  file->addSeparator();
  file->addAction(tr("&Quit"), this, &QWidget::close, QKeySequence(Qt::CTRL + Qt::Key_Q));
}

void DesktopWindow::makeViewMenu()
{
  QMenu* const view = this->menuBar()->addMenu(tr("&View"));
  this->Layouts = new QActionGroup(this);
  const struct
  {
    QString name, text;
  } layouts[] = { { QStringLiteral("layout-video"), tr("&Video") }, { QStringLiteral("layout-scene"), tr("&3D") },
    { QStringLiteral("layout-side-by-side"), tr("Video and 3D side &by side") },
    { QStringLiteral("layout-stacked"), tr("Video &above 3D") } };
  for (int i = 0; i < 4; ++i)
  {
    QAction* const action = this->Layouts->addAction(view->addAction(layouts[i].text));
    action->setObjectName(layouts[i].name);
    action->setCheckable(true);
    action->setData(i);
    action->setShortcut(QKeySequence(Qt::CTRL + Qt::Key_1 + i));
    connect(action, &QAction::triggered, this, [this, i] { this->setViewLayout(i); });
  }
  view->addSeparator();
  QAction* const reset =
    view->addAction(tr("&Show the whole scene"), this, &DesktopWindow::resetSceneCamera, QKeySequence(Qt::CTRL + Qt::Key_R));
  reset->setObjectName(QStringLiteral("reset-view"));
  QAction* const full = view->addAction(tr("&Full screen"));
  full->setCheckable(true);
  full->setShortcut(QKeySequence(Qt::Key_F11));
  connect(full, &QAction::triggered, this,
    [this](bool on) { this->setWindowState(this->windowState().setFlag(Qt::WindowFullScreen, on)); });
  view->addSeparator();
  QAction* const panel = this->PanelDock->toggleViewAction();
  panel->setText(tr("&Module panel"));
  panel->setShortcut(QKeySequence(Qt::CTRL + Qt::Key_M));
  view->addAction(panel);
  QAction* const log = this->LogDock->toggleViewAction();
  log->setText(tr("&Log"));
  log->setShortcut(QKeySequence(Qt::CTRL + Qt::Key_L));
  view->addAction(log);
  this->setViewLayout(this->Views->layoutKind());
}

void DesktopWindow::makeHelpMenu()
{
  QMenu* const help = this->menuBar()->addMenu(tr("&Help"));
  help->addAction(tr("&Keyboard shortcuts"), this, &DesktopWindow::showShortcuts, QKeySequence::HelpContents);
  help->addAction(tr("&About"), this, &DesktopWindow::showAbout);
}

void DesktopWindow::updateIcons()
{
  for (QAction* const action : this->findChildren<QAction*>())
  {
    const QIcon named = icon(action->objectName());
    if (!action->objectName().isEmpty() && !named.isNull())
    {
      action->setIcon(named);
    }
  }
  this->Selector->updateIcons();
  this->updateLogButton();
}

void DesktopWindow::setViewLayout(int layout)
{
  const int kind = qBound(0, layout, int(ViewArea::Stacked));
  this->Views->setLayoutKind(ViewArea::Layout(kind));
  this->Layouts->actions()[kind]->setChecked(true);
}

void DesktopWindow::openFileDialog()
{
  const QString path =
    QFileDialog::getOpenFileName(this, tr("Open a file"), QSettings().value(QStringLiteral("Desktop/openFolder")).toString());
  if (!path.isEmpty())
  {
    QSettings().setValue(QStringLiteral("Desktop/openFolder"), QFileInfo(path).absolutePath());
    this->openPath(path);
  }
}

void DesktopWindow::openFolderDialog()
{
  const QString path = QFileDialog::getExistingDirectory(
    this, tr("Open a folder"), QSettings().value(QStringLiteral("Desktop/openFolder")).toString());
  if (!path.isEmpty())
  {
    QSettings().setValue(QStringLiteral("Desktop/openFolder"), QFileInfo(path).absolutePath());
    this->openPath(path);
  }
}

void DesktopWindow::editSettings()
{
  SettingsDialog dialog(this->Settings, this->moduleTitles(), this);
  if (dialog.exec() == QDialog::Accepted)
  {
    const bool foldersChanged = dialog.settings().moduleFolders != this->Settings.moduleFolders;
    this->setSettings(dialog.settings());
    if (foldersChanged)
    {
      this->showMessage(tr("The folders of modules are used from the next start on."));
    }
  }
}

void DesktopWindow::showShortcuts()
{
  ShortcutsDialog(this).exec();
}

void DesktopWindow::showAbout()
{
  QStringList modules;
  for (const qSlicerLoadableModule* const module : this->Loader->modules())
  {
    modules << tr("%1, from %2").arg(module->title(), QDir::toNativeSeparators(module->path()));
  }
  AboutDialog(modules, this).exec();
}

}  // namespace desktop
