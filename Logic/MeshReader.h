// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSlicerHandEyeCalibrationModuleLogicExport.h"

#include <vtkSmartPointer.h>

#include <filesystem>

class vtkPolyData;

namespace handeye
{

/// Reads a surface mesh: STL, PLY, OBJ, VTP (VTK XML) or VTK (legacy polydata), text or binary, told apart by the ending of the
/// name.
///
/// What comes back is ready to be drawn and registered: triangles only, with point normals (those of the file, or made here),
/// finite coordinates in the file's own unit and axes (the rest of the program takes them for mm), and at least one triangle.
///
/// VTK's readers write what they dislike into a log and return what they have; here that is an exception. A file cut short is found
/// in every format except OBJ, where a cut between two lines leaves a valid, smaller file.
///
/// Not for several threads at once: VTK has one place for its messages.
/// @throws handeye::io::FileError where the file is missing, empty, cut short, damaged, of another kind, or without triangles
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT vtkSmartPointer<vtkPolyData> readMesh(const std::filesystem::path& path);

}  // namespace handeye
