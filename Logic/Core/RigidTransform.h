// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>

namespace handeye
{

/// Rigid transforms are Eigen::Isometry3d, named `aToB` for p_B = aToB * p_A, translations in mm.

/// A 4x4 matrix as a rigid transform: the nearest rotation (in the Frobenius sense) with the matrix' translation.
/// @return nothing if a number is not finite, the last row is not 0 0 0 1, an entry of R^T R differs from the identity's by more
///        than
///         `tolerance`, or the matrix mirrors (det R < 0)
std::optional<Eigen::Isometry3d> toRigid(const Eigen::Matrix4d& matrix, double tolerance = 1e-3);

/// The rotation nearest to a 3x3 matrix in the Frobenius sense, det = +1.
Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& matrix);

/// The rotation by |v| radians about v.
Eigen::Matrix3d rotationFromVector(const Eigen::Vector3d& rotationVector);

/// The angle of a rotation in radians, 0 to pi; accurate near both ends.
double rotationAngle(const Eigen::Matrix3d& rotation);

/// The matrix with skew(a) * b = a x b.
Eigen::Matrix3d skew(const Eigen::Vector3d& vector);

}  // namespace handeye
