// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vtkSmartPointer.h>

#include <vector>

class vtkPolyData;

namespace handeye
{

class CameraModel;

/// Private to HandEyeSceneProps: the shapes of things, mm, each in its own frame.

/// A tracker: a bar along x with two lenses.
vtkSmartPointer<vtkPolyData> trackerShape();

/// A marker: four balls on a cross in the plane z = 0.
vtkSmartPointer<vtkPolyData> markerShape();

/// A camera: its body behind the origin, its lens at it, looking along +z.
vtkSmartPointer<vtkPolyData> cameraShape();

/// What a camera sees, as lines: the image's border at a depth, bent as the lens bends it, the edges from the centre to the
/// corners, and a mark at the upper side. Parts that the lens model does not reach are left out.
vtkSmartPointer<vtkPolyData> frustumShape(const CameraModel& camera, double depthMm);

/// A stylus: a shaft from the marker to the tip.
vtkSmartPointer<vtkPolyData> shaftShape(const Eigen::Vector3d& tip_Stylus);

/// A ball of unit radius at the origin.
vtkSmartPointer<vtkPolyData> unitBall();

/// The same for a wireframe.
vtkSmartPointer<vtkPolyData> coarseBall();

}  // namespace handeye
