// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DesktopWindow.h"

#include "Icons.h"
#include "LogWindow.h"
#include "MessageCapture.h"
#include "ModuleLoader.h"
#include "ModulePanel.h"
#include "ModuleSelector.h"
#include "NoticeBar.h"
#include "RecentFiles.h"
#include "SceneView.h"
#include "StreamLights.h"
#include "ViewArea.h"
#include "qSlicerLoadableModule.h"

#include <QActionGroup>
#include <QApplication>
#include <QCloseEvent>
#include <QDesktopWidget>
#include <QDockWidget>
#include <QFileInfo>
#include <QScreen>
#include <QSettings>
#include <QStatusBar>
#include <QToolButton>
#include <QVBoxLayout>

namespace desktop
{

static const QString lastModuleKey = QStringLiteral("Desktop/lastModule");

DesktopWindow::DesktopWindow(QWidget* parent)
  : QMainWindow(parent)
  , Settings(DesktopSettings::load())
  , Log(new LogModel(this))
  , Capture(std::make_unique<MessageCapture>(*this->Log))
  , Loader(std::make_unique<ModuleLoader>())
{
  this->setObjectName(QStringLiteral("NavigationDesktop"));
  this->setAcceptDrops(true);
  this->Recent = new RecentFiles(this);
  connect(this->Recent, &RecentFiles::chosen, this, &DesktopWindow::openPath);
  this->makeCentre();
  this->makeDocks();
  this->makeStatusBar();
  this->makeActions();
  this->updateIcons();
  connect(this->Loader.get(), &ModuleLoader::loading, this,
    [this](const QString& name) { this->Log->append(LogLevel::Info, tr("Loading module \"%1\"").arg(name)); });
  connect(this->Loader.get(), &ModuleLoader::problemFound, this,
    [this](const QString& path, const QString& reason)
    { this->Log->append(LogLevel::Warning, tr("Skipped %1: %2").arg(path, reason)); });
}

DesktopWindow::~DesktopWindow()
{
  // Panels first, while views and logic they use are there; modules after their panels; the log last.
  delete this->PanelDock;
  this->Views->video()->setWidget(nullptr);
  this->Loader.reset();
  this->Capture.reset();
}

void DesktopWindow::makeCentre()
{
  auto* const centre = new QWidget;
  this->Notices = new NoticeBar;
  this->Views = new ViewArea;
  auto* const layout = new QVBoxLayout(centre);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(2);
  layout->addWidget(this->Notices);
  layout->addWidget(this->Views, 1);
  this->setCentralWidget(centre);
}

void DesktopWindow::makeDocks()
{
  this->Panel = new ModulePanel;
  this->PanelDock = new QDockWidget(tr("Module"), this);
  this->PanelDock->setObjectName(QStringLiteral("ModuleDock"));
  this->PanelDock->setAllowedAreas(Qt::LeftDockWidgetArea | Qt::RightDockWidgetArea);
  this->PanelDock->setWidget(this->Panel);
  this->Panel->setMinimumWidth(this->fontMetrics().averageCharWidth() * 56);
  this->addDockWidget(Qt::LeftDockWidgetArea, this->PanelDock);

  this->LogView = new LogWindow(this->Log);
  this->LogView->setLowestLevel(this->Settings.logLevel);
  this->LogDock = new QDockWidget(tr("Log"), this);
  this->LogDock->setObjectName(QStringLiteral("LogDock"));
  this->LogDock->setWidget(this->LogView);
  this->addDockWidget(Qt::BottomDockWidgetArea, this->LogDock);
  this->LogDock->hide();
  // The module is what a person works with: it has the whole height.
  this->setCorner(Qt::BottomLeftCorner, Qt::LeftDockWidgetArea);
  this->setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  connect(this->Notices, &NoticeBar::detailsRequested, this->LogDock, &QDockWidget::show);
}

void DesktopWindow::makeStatusBar()
{
  this->Lights = new StreamLights(this->statusBar());
  this->statusBar()->addPermanentWidget(this->Lights);
  this->LogButton = new QToolButton;
  this->LogButton->setObjectName(QStringLiteral("LogButton"));
  this->LogButton->setAutoRaise(true);
  this->LogButton->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  this->statusBar()->addPermanentWidget(this->LogButton);
  connect(this->LogButton, &QToolButton::clicked, this, [this] { this->LogDock->setVisible(!this->LogDock->isVisible()); });
  connect(this->Log, &LogModel::countsChanged, this, &DesktopWindow::updateLogButton);
  this->updateLogButton();
}

void DesktopWindow::updateLogButton()
{
  const int errors = this->Log->count(LogLevel::Error);
  const int warnings = this->Log->count(LogLevel::Warning);
  const QString errorText = errors == 1 ? tr("1 error") : tr("%1 errors").arg(errors);
  const QString warningText = warnings == 1 ? tr("1 warning") : tr("%1 warnings").arg(warnings);
  this->LogButton->setText(errors > 0 ? errorText : warnings > 0 ? warningText : tr("Log"));
  this->LogButton->setIcon(errors > 0 ? levelIcon(LogLevel::Error)
      : warnings > 0                  ? levelIcon(LogLevel::Warning)
                                      : icon(QStringLiteral("log")));
  this->LogButton->setToolTip(tr("The log: %1, %2").arg(errorText, warningText));
  this->LogButton->setAccessibleName(this->LogButton->toolTip());
}

void DesktopWindow::loadModules(const QStringList& folders)
{
  const int problemsBefore = this->Loader->problems().size();
  const int modulesBefore = this->Loader->modules().size();
  this->Loader->load(folders);
  for (int i = modulesBefore; i < this->Loader->modules().size(); ++i)
  {
    this->Selector->addModule(this->Loader->modules()[i]);
  }
  const auto problems = this->Loader->problems().mid(problemsBefore);
  if (problems.size() == 1)
  {
    const auto& problem = problems.first();
    this->Notices->addNotice(tr("%1 was skipped: %2.").arg(QFileInfo(problem.path).fileName(), problem.reason));
  }
  else if (!problems.isEmpty())
  {
    QStringList names;
    for (const auto& problem : problems)
    {
      names << QFileInfo(problem.path).fileName();
    }
    this->Notices->addNotice(
      tr("%1 files were skipped; the log says why: %2.").arg(problems.size()).arg(names.join(QStringLiteral(", "))));
  }
  if (this->Loader->modules().isEmpty())
  {
    this->Notices->addNotice(
      tr("No module was found in %1. Folders of modules can be added in the settings or with --additional-module-paths.")
        .arg(folders.join(QStringLiteral(", "))));
  }
}

bool DesktopWindow::showModule(const QString& name)
{
  if (!name.isEmpty())
  {
    if (this->Selector->select(name))
    {
      return true;
    }
    this->Notices->addNotice(tr("There is no module \"%1\" to begin with.").arg(name));
    return false;
  }
  const QString last = QSettings().value(lastModuleKey).toString();
  if (this->Selector->select(this->Settings.startModule) || this->Selector->select(last))
  {
    return true;
  }
  for (const qSlicerLoadableModule* const module : this->Loader->modules())
  {
    if (this->Selector->select(module->name()))
    {
      return true;
    }
  }
  return false;
}

void DesktopWindow::moduleChosen(const QString& name)
{
  const QString problem = this->Panel->setModule(this->Loader->module(name));
  if (!problem.isEmpty())
  {
    this->Log->append(LogLevel::Error, problem);
    this->Notices->addNotice(problem);
  }
  QSettings().setValue(lastModuleKey, name);
  this->PanelDock->show();
}

QVector<QPair<QString, QString>> DesktopWindow::moduleTitles() const
{
  QVector<QPair<QString, QString>> titles;
  for (const qSlicerLoadableModule* const module : this->Loader->modules())
  {
    titles.append({ module->name(), module->title() });
  }
  return titles;
}

void DesktopWindow::setSettings(const DesktopSettings& settings)
{
  this->Settings = settings;
  settings.save();
  applyTheme(settings.theme);
  this->LogView->setLowestLevel(settings.logLevel);
}

void DesktopWindow::restoreGeometryOfLastTime()
{
  const QSettings stored;
  const QByteArray geometry = stored.value(QStringLiteral("Desktop/geometry")).toByteArray();
  if (geometry.isEmpty() || !this->restoreGeometry(geometry))
  {
    const QRect screen = this->screen()->availableGeometry();
    // On a small screen, all of it: the wizard, the video and the scene are beside one another.
    constexpr QSize comfortable(1440, 900);
    this->resize((screen.size() * 0.85).expandedTo(comfortable).boundedTo(screen.size()));
    this->move(screen.center() - this->rect().center());
  }
  this->restoreState(stored.value(QStringLiteral("Desktop/state")).toByteArray());
  this->setViewLayout(stored.value(QStringLiteral("Desktop/layout"), int(ViewArea::SideBySide)).toInt());
  this->Views->restoreState(stored.value(QStringLiteral("Desktop/views")).toByteArray());
}

void DesktopWindow::closeEvent(QCloseEvent* event)
{
  QSettings stored;
  stored.setValue(QStringLiteral("Desktop/geometry"), this->saveGeometry());
  stored.setValue(QStringLiteral("Desktop/state"), this->saveState());
  stored.setValue(QStringLiteral("Desktop/layout"), int(this->Views->layoutKind()));
  stored.setValue(QStringLiteral("Desktop/views"), this->Views->saveState());
  event->accept();
}

void DesktopWindow::changeEvent(QEvent* event)
{
  this->QMainWindow::changeEvent(event);
  if (event->type() == QEvent::PaletteChange && this->Layouts)
  {
    this->updateIcons();
  }
}

// NavigationHost ------------------------------------------------------------------------------------------------------------------------

void DesktopWindow::setVideoWidget(QWidget* widget)
{
  this->Views->video()->setWidget(widget);
}

vtkRenderer* DesktopWindow::sceneRenderer()
{
  return this->Views->scene()->renderer();
}

void DesktopWindow::requestSceneRender()
{
  this->Views->scene()->requestRender();
}

void DesktopWindow::resetSceneCamera()
{
  this->Views->scene()->resetCamera();
}

void DesktopWindow::setStreams(const QVector<Stream>& streams)
{
  this->Lights->setStreams(streams);
}

void DesktopWindow::log(LogLevel level, const QString& text)
{
  this->Log->append(level, text);
}

void DesktopWindow::showMessage(const QString& text)
{
  constexpr int durationMs = 8000;
  this->statusBar()->showMessage(text, durationMs);
}

void DesktopWindow::addRecentFile(const QString& path)
{
  this->Recent->add(path);
}

void DesktopWindow::setFileHandler(QObject* receiver)
{
  this->FileHandler = receiver;
}

QString DesktopWindow::settingsGroup(const QString& moduleName)
{
  return QStringLiteral("Modules/%1").arg(moduleName);
}

}  // namespace desktop
