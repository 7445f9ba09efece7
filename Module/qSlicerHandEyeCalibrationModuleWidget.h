// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "qSlicerAbstractModuleWidget.h"
#include "qSlicerHandEyeCalibrationModuleExport.h"

#include <QScopedPointer>

#include <memory>

class MRMLBridge;
class qSlicerHandEyeCalibrationModuleWidgetPrivate;

/// The module's panel: the calibration, and, where there is a scene, its results as transform nodes and the stylus tip from one.
class Q_SLICER_QTMODULES_HANDEYECALIBRATION_EXPORT qSlicerHandEyeCalibrationModuleWidget : public qSlicerAbstractModuleWidget
{
  Q_OBJECT

public:
  typedef qSlicerAbstractModuleWidget Superclass;

  explicit qSlicerHandEyeCalibrationModuleWidget(QWidget* parent = nullptr);
  ~qSlicerHandEyeCalibrationModuleWidget() override;

  void enter() override;
  void exit() override;

  /// The scene's, as soon as there is a scene; null takes it away. From setup() on.
  void setBridge(std::unique_ptr<MRMLBridge> bridge);

public slots:
  void setMRMLScene(vtkMRMLScene* scene) override;

protected:
  void setup() override;

private:
  Q_DECLARE_PRIVATE(qSlicerHandEyeCalibrationModuleWidget)
  Q_DISABLE_COPY(qSlicerHandEyeCalibrationModuleWidget)

  QScopedPointer<qSlicerHandEyeCalibrationModuleWidgetPrivate> d_ptr;
};
