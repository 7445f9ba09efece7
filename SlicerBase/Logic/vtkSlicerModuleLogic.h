// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeSlicerBaseExport.h"
#include "vtkMRMLAbstractLogic.h"

/// Stands in for 3D Slicer's class of this name in a build without Slicer: the superclass of a loadable module's logic.
class HANDEYE_SLICER_BASE_EXPORT vtkSlicerModuleLogic : public vtkMRMLAbstractLogic
{
public:
  static vtkSlicerModuleLogic* New();
  vtkTypeMacro(vtkSlicerModuleLogic, vtkMRMLAbstractLogic)
  void PrintSelf(std::ostream& os, vtkIndent indent) override;

protected:
  vtkSlicerModuleLogic() = default;
  ~vtkSlicerModuleLogic() override = default;

private:
  vtkSlicerModuleLogic(const vtkSlicerModuleLogic&) = delete;
  void operator=(const vtkSlicerModuleLogic&) = delete;
};
