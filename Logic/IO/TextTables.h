// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <filesystem>
#include <vector>

namespace handeye::io
{

/// Tables of numbers as plain text: one row a line; blanks, tabs, commas or semicolons between the numbers; `#` begins a comment;
/// empty lines are skipped. Numbers are read with a decimal point whatever the locale. All functions throw FileError naming the
/// line.

/// A row of readPointsAndLines(): a point, and the line on which it should come to lie.
struct PointAndLine
{
  Eigen::Vector3d point;
  Eigen::Vector3d lineOrigin;
  Eigen::Vector3d lineDirection;  ///< unit length
};

/// A rigid 4x4 matrix in four rows: p_To = matrix * p_From, mm. See Recording::transform() for what counts as rigid.
[[nodiscard]] Eigen::Isometry3d readMatrix4x4(const std::filesystem::path& path);

/// "x y z" a line, mm.
[[nodiscard]] std::vector<Eigen::Vector3d> readPoints(const std::filesystem::path& path);

/// Nine columns: point x y z, line origin x y z, line direction x y z (any length but zero; made a unit vector).
[[nodiscard]] std::vector<PointAndLine> readPointsAndLines(const std::filesystem::path& path);

}  // namespace handeye::io
