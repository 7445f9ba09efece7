// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "qSlicerBaseQTGUIExport.h"

class vtkMRMLScene;

/// Stands in for 3D Slicer's class of this name: what has a scene. Without Slicer there is no MRML: the scene is a pointer that is handed on,
/// not kept alive, and may be null.
class Q_SLICER_BASE_QTGUI_EXPORT qSlicerObject
{
public:
  qSlicerObject() = default;
  virtual ~qSlicerObject();

  vtkMRMLScene* mrmlScene() const;
  virtual void setMRMLScene(vtkMRMLScene* scene);

private:
  qSlicerObject(const qSlicerObject&) = delete;
  qSlicerObject& operator=(const qSlicerObject&) = delete;

  vtkMRMLScene* Scene = nullptr;
};
