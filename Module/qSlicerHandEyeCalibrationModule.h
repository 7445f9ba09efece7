// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "qSlicerHandEyeCalibrationModuleExport.h"
#include "qSlicerLoadableModule.h"

/// The module as 3D Slicer and NavigationDesktop load it: what it is called, its logic, its panel.
class Q_SLICER_QTMODULES_HANDEYECALIBRATION_EXPORT qSlicerHandEyeCalibrationModule : public qSlicerLoadableModule
{
  Q_OBJECT
  Q_PLUGIN_METADATA(IID "org.slicer.modules.loadable.qSlicerLoadableModule/1.0")
  Q_INTERFACES(qSlicerLoadableModule)

public:
  typedef qSlicerLoadableModule Superclass;

  explicit qSlicerHandEyeCalibrationModule(QObject* parent = nullptr);
  ~qSlicerHandEyeCalibrationModule() override;

  qSlicerGetTitleMacro(QTMODULE_TITLE)

    QString helpText() const override;
  QString acknowledgementText() const override;
  QStringList contributors() const override;
  QIcon icon() const override;
  QStringList categories() const override;
  QStringList dependencies() const override;

protected:
  void setup() override;
  qSlicerAbstractModuleRepresentation* createWidgetRepresentation() override;
  vtkMRMLAbstractLogic* createLogic() override;

private:
  Q_DISABLE_COPY(qSlicerHandEyeCalibrationModule)
};
