// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "RoomMesh.h"

#include <filesystem>
#include <memory>

namespace handeye
{

/// A mesh file as a simulated room draws it.
/// @throws io::FileError as readMesh(); std::invalid_argument for points that are not finite
/// May be called from any thread.
std::shared_ptr<const simulation::RoomMesh> readRoomMesh(const std::filesystem::path& file);

}  // namespace handeye
