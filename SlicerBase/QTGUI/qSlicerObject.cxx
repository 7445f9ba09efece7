// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "qSlicerObject.h"

qSlicerObject::~qSlicerObject() = default;

vtkMRMLScene* qSlicerObject::mrmlScene() const
{
  return this->Scene;
}

void qSlicerObject::setMRMLScene(vtkMRMLScene* scene)
{
  this->Scene = scene;
}
