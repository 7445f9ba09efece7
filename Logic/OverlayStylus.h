// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSlicerHandEyeCalibrationModuleLogicExport.h"

#include <vtkSmartPointer.h>

class vtkPolyData;

namespace handeye
{

/// What a stylus looks like, mm. Frame `StylusTip`: the tip in the origin, -Z along the shaft (see calibrateSpin()); the ray runs
/// along +Z.
struct StylusShape
{
  double ballRadiusMm = 15;  ///< around the tip; 0: none
  double shaftRadiusMm = 4;  ///< 0: none
  double shaftLengthMm = 150;
  double rayLengthMm = 100;  ///< from the tip; 0: none
  bool hasShaft = true;      ///< false where only the tip is known, not the direction: no shaft and no ray then

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT void check() const;
};

/// What hides the model: ball and shaft. In the `StylusTip` frame, of triangles that the lens can bend.
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT vtkSmartPointer<vtkPolyData> makeStylusBody(const StylusShape& shape);

/// The ray from the ball's surface on, a thin rod; empty without one.
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT vtkSmartPointer<vtkPolyData> makeStylusRay(const StylusShape& shape);

/// The tip, a small ball.
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT vtkSmartPointer<vtkPolyData> makeStylusTip(const StylusShape& shape);

}  // namespace handeye
