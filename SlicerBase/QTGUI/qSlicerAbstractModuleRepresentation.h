// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "qSlicerBaseQTGUIExport.h"
#include "qSlicerObject.h"

#include <QString>

class qSlicerAbstractCoreModule;
class vtkMRMLAbstractLogic;

/// Stands in for 3D Slicer's class of this name: how a module shows itself; see qSlicerAbstractModuleWidget.
///
/// module() and logic() are null in the constructor and valid from setup() until the module is gone.
class Q_SLICER_BASE_QTGUI_EXPORT qSlicerAbstractModuleRepresentation : virtual public qSlicerObject
{
public:
  typedef qSlicerObject Superclass;

  qSlicerAbstractModuleRepresentation() = default;
  ~qSlicerAbstractModuleRepresentation() override;

  QString moduleName() const;

protected:
  /// Everything that needs the logic; called once, before the scene is set.
  virtual void setup() = 0;

  vtkMRMLAbstractLogic* logic() const;
  qSlicerAbstractCoreModule* module() const;

private:
  friend class qSlicerAbstractCoreModule;
  void setModule(qSlicerAbstractCoreModule* module);

  qSlicerAbstractCoreModule* Module = nullptr;
};
