// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "LensWarp.h"
#include "vtkSlicerHandEyeCalibrationModuleLogicExport.h"

#include <vtkSmartPointer.h>

class vtkPolyData;

namespace handeye
{

/// The square from -1 to 1 with texture coordinates (0, 0 is the lower left corner of the video): the video as it is.
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT vtkSmartPointer<vtkPolyData> makeRawVideoMesh();

/// The same square with texture coordinates that straighten the video: what a pinhole camera of the same focal lengths, principal
/// point and size would see. The graphics card looks the video's pixels up; coordinates outside of 0 to 1 are places that the real
/// camera does not see.
///
/// Between the nodes of a grid the coordinates are linear; the grid is fine enough for an error of at most 0.08 px of the video,
/// where the lens bends most. Cells that touch what is outside of the lens model are left out.
/// @param camera with an image size
/// @param warp makeLensWarp(camera)
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT vtkSmartPointer<vtkPolyData> makeUndistortedVideoMesh(
  const CameraModel& camera, const LensWarp& warp);

}  // namespace handeye
