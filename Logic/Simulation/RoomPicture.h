// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "SimulatedRoom.h"
#include "SphereRenderer.h"

namespace handeye::simulation
{

/// Where things are in the camera's frame when a picture is taken, mm.
struct RoomView
{
  Eigen::Vector3d ball_Camera;
  Eigen::Vector3d handle_Camera;  ///< the stylus' other end
  Eigen::Isometry3d phantomToCamera;
  Eigen::Isometry3d trackerToCamera;
};

/// The picture: background and clutter, phantom, shaft, and over them the ball; blur, encoding, noise.
cv::Mat drawRoom(const RoomOptions& options, const RayTable& rays, const RoomView& view, unsigned noiseSeed);

}  // namespace handeye::simulation
