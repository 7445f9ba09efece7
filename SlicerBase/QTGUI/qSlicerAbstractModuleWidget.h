// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "qSlicerAbstractModuleRepresentation.h"
#include "qSlicerBaseQTGUIExport.h"
#include "qSlicerWidget.h"

/// Stands in for 3D Slicer's class of this name: a module's panel. A desktop calls enter() when it is shown and exit() when another module
/// takes its place, or at the end; in turns, which is asserted.
class Q_SLICER_BASE_QTGUI_EXPORT qSlicerAbstractModuleWidget : public qSlicerWidget, public qSlicerAbstractModuleRepresentation
{
  Q_OBJECT

public:
  typedef qSlicerWidget Superclass;

  explicit qSlicerAbstractModuleWidget(QWidget* parent = nullptr);
  ~qSlicerAbstractModuleWidget() override;

  virtual void enter();
  virtual void exit();
  bool isEntered() const { return this->Entered; }

protected:
  void setup() override;

private:
  Q_DISABLE_COPY(qSlicerAbstractModuleWidget)

  bool Entered = false;
};
