// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "qSlicerBaseQTGUIExport.h"
#include "qSlicerObject.h"

#include <QWidget>

class vtkMRMLScene;

/// Stands in for 3D Slicer's class of this name: a widget that has a scene.
class Q_SLICER_BASE_QTGUI_EXPORT qSlicerWidget : public QWidget, public virtual qSlicerObject
{
  Q_OBJECT

public:
  typedef QWidget Superclass;

  explicit qSlicerWidget(QWidget* parent = nullptr, Qt::WindowFlags flags = Qt::WindowFlags());

public slots:
  /// An override calls it; the signal comes for another scene than before only.
  void setMRMLScene(vtkMRMLScene* scene) override;

signals:
  void mrmlSceneChanged(vtkMRMLScene*);

private:
  Q_DISABLE_COPY(qSlicerWidget)
};
