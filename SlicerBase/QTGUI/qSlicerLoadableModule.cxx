// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "qSlicerLoadableModule.h"

qSlicerLoadableModule::qSlicerLoadableModule(QObject* parent)
  : qSlicerAbstractModule(parent)
{
}

void qSlicerLoadableModule::setup()
{
}
