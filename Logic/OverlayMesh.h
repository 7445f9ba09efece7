// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSlicerHandEyeCalibrationModuleLogicExport.h"

#include <vtkSmartPointer.h>

class vtkPolyData;

namespace handeye
{

/// A mesh made ready for vtkHandEyeLensMapper, by prepareOverlayMesh().
struct OverlayMesh
{
  vtkSmartPointer<vtkPolyData> mesh;  ///< triangles only, with point normals
  double longestEdgeMm = 0;           ///< in `mesh`; 0 for an empty one
  bool isClosed = false;              ///< isClosedSurface()
};

/// Triangles and normals (made where they are missing). The input is not changed. Takes tens of ms for a large mesh; any thread may
/// call it while nobody else uses the input.
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT OverlayMesh prepareOverlayMesh(vtkPolyData* model);

/// Edges no longer than `longestEdgeMm`: longer ones are divided, without cracks. Where that would need more than a million triangles,
/// the edges are left longer, and the result says how long. The input is not changed.
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT OverlayMesh dividedOverlayMesh(const OverlayMesh& mesh, double longestEdgeMm);

/// Whether every part of a mesh of triangles is closed and turned outward: each edge has two triangles that run along it in
/// opposite directions (points at exactly the same place are one), and each part has a positive volume. From outside, its back
/// faces are then always hidden by others.
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT bool isClosedSurface(vtkPolyData* triangles);

/// Triangles only, with point normals; normals of the input are kept.
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT vtkSmartPointer<vtkPolyData> triangulatedWithNormals(vtkPolyData* model);

}  // namespace handeye
