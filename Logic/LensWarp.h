// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "vtkSlicerHandEyeCalibrationModuleLogicExport.h"

#include <array>

namespace handeye
{

/// What the graphics card needs to bend a mesh as the lens bends light, and how far that can be believed.
///
/// A point p_Camera = (X, Y, Z) is moved to (x'' Z, y'' Z, Z), where (x'', y'') are the distorted normalised coordinates of (X/Z,
/// Y/Z). A plain pinhole camera then draws it at the pixel where the real camera sees it, at the same depth. Beyond `limitRadius`
/// nothing is drawn; vertices there are continued outward linearly, with a positive slope, so that the geometry never folds back.
struct LensWarp
{
  std::array<float, 14> coefficients{};  ///< k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 tauX tauY, zero where the lens has none
  std::array<float, 9> tilt{};           ///< the tilted sensor's homography, column by column
  /// Largest sqrt(x^2 + y^2), x = X/Z, that is drawn: 1.1 times the radius of the furthest image corner, and never past the radius
  /// at which the lens polynomial folds back. Where the polynomial folds back inside the picture, the corners beyond stay empty.
  double limitRadius = 0;
  double outerSlope = 1;  ///< of the continuation: distorted by undistorted radius
  /// The largest second derivative (px, by undistorted normalised coordinates, along a line) of the mapping inside the picture: a
  /// straight edge that is e long in normalised coordinates is bent by at most curvaturePx e^2 / 8.
  double curvaturePx = 0;
};

/// @throws std::invalid_argument if the camera has no image size
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT LensWarp makeLensWarp(const CameraModel& camera);

/// What a straightened picture needs: nothing is bent, and the same is believed.
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT LensWarp plainWarp(const LensWarp& lens);

/// The longest edge (mm) that is drawn with an error of no more than `tolerancePx`, at `nearestDistanceMm` or further: a vertex
/// shader bends vertices, not the edges between them. Infinity for a lens without distortion.
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT double longestEdgeMm(
  const LensWarp& warp, double nearestDistanceMm, double tolerancePx);

/// The reverse: by how many pixels an edge of this length (mm) is drawn too straight, at most.
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT double chordErrorPx(
  const LensWarp& warp, double nearestDistanceMm, double edgeMm);

}  // namespace handeye
