// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "qSlicerAbstractModuleRepresentation.h"

#include "qSlicerAbstractCoreModule.h"

qSlicerAbstractModuleRepresentation::~qSlicerAbstractModuleRepresentation()
{
  if (this->Module)
  {
    this->Module->representationDeleted(this);
  }
}

QString qSlicerAbstractModuleRepresentation::moduleName() const
{
  return this->Module ? this->Module->name() : QString();
}

vtkMRMLAbstractLogic* qSlicerAbstractModuleRepresentation::logic() const
{
  return this->Module ? this->Module->logic() : nullptr;
}

qSlicerAbstractCoreModule* qSlicerAbstractModuleRepresentation::module() const
{
  return this->Module;
}

void qSlicerAbstractModuleRepresentation::setModule(qSlicerAbstractCoreModule* module)
{
  this->Module = module;
}
