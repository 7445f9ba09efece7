// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "Photograph.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <array>
#include <vector>

namespace handeye::simulation
{

/// A closed surface of triangles that a simulated room shows, mm.
struct RoomMesh
{
  std::vector<Eigen::Vector3d> points_Model;
  std::vector<std::array<int, 3>> triangles;   ///< indices into the points, counter-clockwise seen from outside
  std::vector<Eigen::Vector3d> normals_Model;  ///< unit, outwards, one a point

  RoomMesh() = default;
  /// With the normals of the triangles around each point, by their areas.
  /// @throws std::invalid_argument for an index of no point, or a coordinate that is not finite
  RoomMesh(std::vector<Eigen::Vector3d> points_Model, std::vector<std::array<int, 3>> triangles);
};

struct RoomMeshLook
{
  Light color = Light(0.4F, 0.5F, 0.56F);
  /// Dots painted on the surface around these places.
  std::vector<Eigen::Vector3d> dots_Model;
  double dotRadiusMm = 2.2;
  Light dotColor = Light(0.3F, 0.1F, 0.01F);
};

/// Draws a mesh into linear light through the exact lens: 2 x 2 samples a pixel, a depth buffer, the lamp of RenderedBall.
///
/// Frames: p_Camera = modelToCamera * p_Model. Vertices are projected exactly, edges between them are straight: triangles of a few
/// pixels bend by less than 0.01 px. A triangle with a vertex that the lens does not see is left out.
/// Thread-safe.
void drawMesh(cv::Mat& light, const CameraModel& camera, const RoomMesh& mesh, const Eigen::Isometry3d& modelToCamera,
  const RoomMeshLook& look = {});

}  // namespace handeye::simulation
