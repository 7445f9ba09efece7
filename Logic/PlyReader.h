// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

#include <filesystem>

class vtkPolyData;

namespace handeye
{

/// Reads the surface in a PLY file (text, little or big endian): `vertex` with x, y, z and, if there, nx, ny, nz; `face` with
/// vertex_indices or vertex_index. Other elements and properties are passed over.
///
/// VTK 9.1 has a reader too, but it does not survive a file that is cut short (it frees the same memory twice).
/// @throws handeye::io::FileError for a header that is not PLY's, or for data that are damaged or end too early
vtkSmartPointer<vtkPolyData> readPly(const std::filesystem::path& path);

}  // namespace handeye
