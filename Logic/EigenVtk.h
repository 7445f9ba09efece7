// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSlicerHandEyeCalibrationModuleLogicExport.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <vtkSmartPointer.h>

#include <vector>

class vtkImageData;
class vtkMatrix4x4;
class vtkPoints;

/// The one place where the types of the mathematics (Eigen, OpenCV) and those of the display (VTK) meet.
namespace handeye
{

/// The same 4x4 numbers; p_B = aToB * p_A holds for both.
/// @throws std::invalid_argument if `matrix` is null
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT void toVtk(const Eigen::Matrix4d& aToB, vtkMatrix4x4* matrix);
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT void toVtk(const Eigen::Isometry3d& aToB, vtkMatrix4x4* matrix);

/// A new matrix with the same numbers.
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT vtkSmartPointer<vtkMatrix4x4> toVtk(const Eigen::Isometry3d& aToB);

/// The same 4x4 numbers, rigid or not.
/// @throws std::invalid_argument if `matrix` is null
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT Eigen::Matrix4d toEigen(const vtkMatrix4x4* matrix);

/// A rigid transform: the rotation nearest to the matrix (see toRigid() in RigidTransform.h), its translation kept.
/// @throws std::invalid_argument if `matrix` is null or not rigid to 1e-3, a scale or a mirror image among others
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT Eigen::Isometry3d toIsometry(const vtkMatrix4x4* matrix);

/// The coordinates of each point.
/// @throws std::invalid_argument if `points` is null
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT std::vector<Eigen::Vector3d> toEigen(vtkPoints* points);

/// Copies an OpenCV picture (8 bits; grey, BGR or BGRA; top row first) into a VTK image (RGB; bottom row first), reusing its memory
/// if the size is the same, and marks it modified. An alpha channel is dropped.
/// @throws std::invalid_argument if `image` is null or the picture is empty or of another type
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT void toVtk(const cv::Mat& picture, vtkImageData* image);

/// Copies a VTK image (8 bits; 1, 3 or 4 components; one slice; bottom row first) into an OpenCV picture (BGR; top row first).
/// @throws std::invalid_argument if `image` is null, empty, of another type, or a volume
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT cv::Mat toOpenCV(vtkImageData* image);

}  // namespace handeye
