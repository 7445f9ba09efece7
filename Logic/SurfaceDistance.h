// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSlicerHandEyeCalibrationModuleLogicExport.h"

#include <Eigen/Core>

#include <vector>

class vtkPolyData;

namespace handeye
{

/// Landmarks are picked on the model's surface; further away (mm) they were not picked on this model.
constexpr double LargestSurfaceDistanceMm = 5;

/// How far the furthest of these points is from a mesh, mm, in the mesh's own coordinates. 0 without points or cells.
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT double largestSurfaceDistance(
  vtkPolyData* mesh, const std::vector<Eigen::Vector3d>& points_Model);

}  // namespace handeye
