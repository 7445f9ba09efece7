// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "qSlicerAbstractModule.h"

#include <QAction>

qSlicerAbstractModule::qSlicerAbstractModule(QObject* parent)
  : qSlicerAbstractCoreModule(parent)
{
}

QIcon qSlicerAbstractModule::icon() const
{
  return {};
}

QAction* qSlicerAbstractModule::action()
{
  if (!this->Action)
  {
    this->Action = new QAction(this->icon(), this->title(), this);
    this->Action->setData(this->name());
    this->Action->setIconVisibleInMenu(true);
  }
  return this->Action;
}
