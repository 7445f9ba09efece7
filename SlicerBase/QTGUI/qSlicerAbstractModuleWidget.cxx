// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "qSlicerAbstractModuleWidget.h"

qSlicerAbstractModuleWidget::qSlicerAbstractModuleWidget(QWidget* parent)
  : qSlicerWidget(parent)
{
}

void qSlicerAbstractModuleWidget::enter()
{
  this->Entered = true;
}

void qSlicerAbstractModuleWidget::exit()
{
  this->Entered = false;
}

void qSlicerAbstractModuleWidget::setup()
{
}
