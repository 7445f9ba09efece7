// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSlicerModuleLogic.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkSlicerModuleLogic);

void vtkSlicerModuleLogic::PrintSelf(std::ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
