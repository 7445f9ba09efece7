// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LogModel.h"
#include "NavigationHost.h"
#include "SettingsDialog.h"

#include <QMainWindow>
#include <QPointer>

#include <memory>

class QActionGroup;
class QDockWidget;
class QMimeData;
class QToolButton;

namespace desktop
{

class LogWindow;
class MessageCapture;
class ModuleLoader;
class ModulePanel;
class ModuleSelector;
class NoticeBar;
class RecentFiles;
class StreamLights;
class ViewArea;

/// The main window: modules in a dock with a selector above, video and three-dimensional view, lights for streams, the log. It is what
/// modules see as NavigationHost.
///
/// It knows modules by qSlicerLoadableModule alone. Modules come from loadModules(), which may be called several times, and go with the
/// window.
class DesktopWindow : public QMainWindow, public NavigationHost
{
  Q_OBJECT
  Q_INTERFACES(NavigationHost)

public:
  explicit DesktopWindow(QWidget* parent = nullptr);
  ~DesktopWindow() override;

  /// Looks for modules in folders and adds them; what could not be used is in the log and in a notice.
  void loadModules(const QStringList& folders);
  ModuleLoader* loader() const { return this->Loader.get(); }

  /// Shows a module; empty: the one of the settings, else of last time, else the first. @return false if there is none of this name
  bool showModule(const QString& name);

  void setDemonstration(bool on) { this->Demonstration = on; }

  /// Hands a file or folder to whoever takes files. @return whether somebody made something of it; if not, the person is told
  bool openPath(const QString& path);

  /// As the person left it: size, place, docks, layout.
  void restoreGeometryOfLastTime();

  LogModel* logModel() const { return this->Log; }
  DesktopSettings settings() const { return this->Settings; }
  /// Takes effect now and is remembered.
  void setSettings(const DesktopSettings& settings);

  // NavigationHost
  void setVideoWidget(QWidget* widget) override;
  vtkRenderer* sceneRenderer() override;
  void requestSceneRender() override;
  void resetSceneCamera() override;
  void setStreams(const QVector<Stream>& streams) override;
  void log(LogLevel level, const QString& text) override;
  void showMessage(const QString& text) override;
  void addRecentFile(const QString& path) override;
  void setFileHandler(QObject* receiver) override;
  QString settingsGroup(const QString& moduleName) override;
  bool isDemonstration() const override { return this->Demonstration; }

public slots:
  void openFileDialog();
  void openFolderDialog();
  void editSettings();
  void showShortcuts();
  void showAbout();
  /// 0 video, 1 3D, 2 side by side, 3 one above the other.
  void setViewLayout(int layout);

protected:
  void changeEvent(QEvent* event) override;
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dragLeaveEvent(QDragLeaveEvent* event) override;
  void dropEvent(QDropEvent* event) override;

private:
  void makeCentre();
  void makeDocks();
  void makeStatusBar();
  void makeActions();
  void makeFileMenu();
  void makeViewMenu();
  void makeHelpMenu();
  void updateIcons();
  void updateLogButton();
  void moduleChosen(const QString& name);
  void showDropHint(bool on);
  QVector<QPair<QString, QString>> moduleTitles() const;
  static QStringList localPaths(const QMimeData* data);

  DesktopSettings Settings;
  bool Demonstration = false;
  QPointer<QObject> FileHandler;
  LogModel* Log;
  std::unique_ptr<MessageCapture> Capture;
  std::unique_ptr<ModuleLoader> Loader;
  ModuleSelector* Selector = nullptr;
  ModulePanel* Panel = nullptr;
  QDockWidget* PanelDock = nullptr;
  QDockWidget* LogDock = nullptr;
  LogWindow* LogView = nullptr;
  NoticeBar* Notices = nullptr;
  ViewArea* Views = nullptr;
  StreamLights* Lights = nullptr;
  QToolButton* LogButton = nullptr;
  RecentFiles* Recent = nullptr;
  QActionGroup* Layouts = nullptr;
  QPointer<QWidget> DropHint;
};

}  // namespace desktop
