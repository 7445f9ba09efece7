// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "qSlicerAbstractModule.h"
#include "qSlicerBaseQTGUIExport.h"

/// Stands in for 3D Slicer's class of this name: a module in a Qt plugin.
class Q_SLICER_BASE_QTGUI_EXPORT qSlicerLoadableModule : public qSlicerAbstractModule
{
  Q_OBJECT

public:
  typedef qSlicerAbstractModule Superclass;

  explicit qSlicerLoadableModule(QObject* parent = nullptr);

protected:
  void setup() override;

private:
  Q_DISABLE_COPY(qSlicerLoadableModule)
};

#define qSlicerLoadableModule_iid "org.slicer.modules.loadable.qSlicerLoadableModule/1.0"
Q_DECLARE_INTERFACE(qSlicerLoadableModule, qSlicerLoadableModule_iid)
