// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QString>
#include <QStringList>
#include <QVector>
#include <QtPlugin>

class QObject;
class QWidget;
class vtkRenderer;
class vtkRenderWindow;

/// What a navigation desktop offers to the modules that it loads, and what it asks nothing else of them for: two views, lights for
/// streams, a log, a place for files that were dropped. It is an interface without code, so that a module links nothing of the desktop;
/// the desktop knows nothing of what the module does.
///
/// A module finds it with findNavigationHost(). In 3D Slicer, or in a window of a test, there is none: null, and the module shows its
/// views in its own panel.
///
/// All calls belong to the thread of the user interface.
class NavigationHost
{
public:
  /// How a stream is; the desktop shows a light for each.
  enum class StreamLight
  {
    Live,   ///< arriving
    Stale,  ///< nothing new for a while, or its poses are not valid now (a hidden tool)
    Lost    ///< its source is gone
  };

  struct Stream
  {
    QString name;    ///< "StylusToTracker"
    QString source;  ///< where it comes from: "127.0.0.1:18944"
    StreamLight light = StreamLight::Lost;
    double rateHz = 0;   ///< 0: unknown
    double ageSec = -1;  ///< since the last sample; negative: unknown
    QString message;     ///< for a tooltip: why it is not live
  };

  enum class LogLevel
  {
    Info,
    Warning,
    Error
  };

  virtual ~NavigationHost() = default;

  /// The view for live video: a place for one widget of the module, which takes all of it. Null takes it out again. The desktop does not own
  /// the widget; it shows its own words while there is none.
  virtual void setVideoWidget(QWidget* widget) = 0;

  /// The three-dimensional view, mm: the module adds its props to this renderer and takes them out again, and asks for a rendering,
  /// which happens soon and once for many requests.
  virtual vtkRenderer* sceneRenderer() = 0;
  virtual void requestSceneRender() = 0;
  /// Turns the view so that everything in it is seen.
  virtual void resetSceneCamera() = 0;

  /// The lights of the status bar: all streams as they are now; empty takes them away.
  virtual void setStreams(const QVector<Stream>& streams) = 0;

  /// A line in the log window, with time and level.
  virtual void log(LogLevel level, const QString& text) = 0;

  /// Sentence in the status bar for some seconds.
  virtual void showMessage(const QString& text) = 0;

  /// A folder or file that a person worked with, for the list of recent ones; choosing it calls the handler of setFileHandler().
  virtual void addRecentFile(const QString& path) = 0;

  /// Who takes files that were dropped on the window or chosen from the recent ones. `receiver` has an invokable method
  /// `bool openFile(QString path)`, which returns whether it could make something of it. Null: nobody.
  virtual void setFileHandler(QObject* receiver) = 0;

  /// Settings the desktop remembers for a module, by its name: the group to use in a QSettings().
  virtual QString settingsGroup(const QString& moduleName) = 0;

  /// Whether the desktop was started for a demonstration: the module then begins with its simulated room.
  virtual bool isDemonstration() const = 0;
};

#define NavigationHost_iid "org.handeyecalibration.NavigationHost/1.0"
Q_DECLARE_INTERFACE(NavigationHost, NavigationHost_iid)
