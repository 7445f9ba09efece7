// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "qSlicerWidget.h"

qSlicerWidget::qSlicerWidget(QWidget* parent, Qt::WindowFlags flags)
  : QWidget(parent, flags)
{
}

void qSlicerWidget::setMRMLScene(vtkMRMLScene* scene)
{
  if (this->mrmlScene() == scene)
  {
    return;
  }
  this->qSlicerObject::setMRMLScene(scene);
  emit this->mrmlSceneChanged(scene);
}
