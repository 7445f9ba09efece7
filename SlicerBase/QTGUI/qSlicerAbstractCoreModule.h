// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "qSlicerBaseQTGUIExport.h"

#include <vtkSmartPointer.h>

#include <QObject>
#include <QString>
#include <QStringList>

class qSlicerAbstractModuleRepresentation;
class vtkMRMLAbstractLogic;
class vtkMRMLScene;
class vtkSlicerApplicationLogic;

/// The title, for the module and without one.
#define qSlicerGetTitleMacro(_TITLE)                                                                                               \
  static QString staticTitle()                                                                                                     \
  {                                                                                                                                \
    return _TITLE;                                                                                                                 \
  }                                                                                                                                \
  QString title() const override                                                                                                   \
  {                                                                                                                                \
    return _TITLE;                                                                                                                 \
  }

/// Stands in for 3D Slicer's class of this name: what every module is, with its life in this order:
///
/// constructor; setName(); initialize(), which makes the logic and calls setup(); widgetRepresentation(), which makes the panel, tells it
/// the module and calls its setup(); setMRMLScene(). The panel is the module's until a widget takes it as its child.
class Q_SLICER_BASE_QTGUI_EXPORT qSlicerAbstractCoreModule : public QObject
{
  Q_OBJECT
  Q_PROPERTY(QString name READ name)
  Q_PROPERTY(QString title READ title)
  Q_PROPERTY(QStringList categories READ categories)
  Q_PROPERTY(QStringList contributors READ contributors)
  Q_PROPERTY(QStringList dependencies READ dependencies)
  Q_PROPERTY(QStringList associatedNodeTypes READ associatedNodeTypes)
  Q_PROPERTY(QString helpText READ helpText)
  Q_PROPERTY(QString acknowledgementText READ acknowledgementText)
  Q_PROPERTY(bool hidden READ isHidden)
  Q_PROPERTY(int index READ index)
  Q_PROPERTY(QString path READ path)

public:
  typedef QObject Superclass;

  explicit qSlicerAbstractCoreModule(QObject* parent = nullptr);
  ~qSlicerAbstractCoreModule() override;

  /// Makes the logic and calls setup().
  void initialize(vtkSlicerApplicationLogic* appLogic);
  vtkSlicerApplicationLogic* appLogic() const { return this->AppLogic; }

  /// What the file name says: unique.
  virtual QString name() const;
  virtual void setName(const QString& name);
  /// The file it was loaded from.
  QString path() const { return this->Path; }
  void setPath(const QString& path);

  virtual QString title() const = 0;
  /// In the selector's menu; "Filtering.Arithmetic" is a submenu.
  virtual QStringList categories() const;
  /// Order in its category: 0 first; -1 behind those that have one, by title.
  virtual int index() const;
  /// Not to be offered in a selector.
  virtual bool isHidden() const;
  /// HTML.
  virtual QString helpText() const;
  virtual QString acknowledgementText() const;
  virtual QStringList contributors() const;
  /// Names of modules to be initialized before this one.
  virtual QStringList dependencies() const;
  virtual QStringList associatedNodeTypes() const;

  /// The panel, made at the first call; null for a module that has none.
  qSlicerAbstractModuleRepresentation* widgetRepresentation();
  /// Made at the first call, with the scene; null for a module that has none.
  Q_INVOKABLE vtkMRMLAbstractLogic* logic();

  vtkMRMLScene* mrmlScene() const { return this->Scene; }

public slots:
  virtual void setMRMLScene(vtkMRMLScene* scene);

protected:
  virtual void setup() = 0;
  /// Returns a new one.
  virtual qSlicerAbstractModuleRepresentation* createWidgetRepresentation() = 0;
  /// Returns New(): the reference is taken.
  virtual vtkMRMLAbstractLogic* createLogic() = 0;

private:
  Q_DISABLE_COPY(qSlicerAbstractCoreModule)
  friend class qSlicerAbstractModuleRepresentation;
  void representationDeleted(qSlicerAbstractModuleRepresentation* representation);

  QString Name;
  QString Path;
  vtkSlicerApplicationLogic* AppLogic = nullptr;
  vtkMRMLScene* Scene = nullptr;
  vtkSmartPointer<vtkMRMLAbstractLogic> Logic;
  qSlicerAbstractModuleRepresentation* Representation = nullptr;
};
