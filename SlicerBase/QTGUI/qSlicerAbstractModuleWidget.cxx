// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "qSlicerAbstractModuleWidget.h"

qSlicerAbstractModuleWidget::qSlicerAbstractModuleWidget(QWidget* parent)
  : qSlicerWidget(parent)
{
}

qSlicerAbstractModuleWidget::~qSlicerAbstractModuleWidget()
{
  Q_ASSERT(!this->Entered);
}

void qSlicerAbstractModuleWidget::enter()
{
  Q_ASSERT(!this->Entered);
  this->Entered = true;
}

void qSlicerAbstractModuleWidget::exit()
{
  Q_ASSERT(this->Entered);
  this->Entered = false;
}

void qSlicerAbstractModuleWidget::setup()
{
}
