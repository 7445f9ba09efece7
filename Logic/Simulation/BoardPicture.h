// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardDescription.h"
#include "CameraModel.h"
#include "Photograph.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <memory>

namespace handeye
{
class BoardPattern;
}

namespace handeye::simulation
{

class RayTable;

/// How bright ink, paper and what is behind the board are, in linear light.
struct BoardLight
{
  Light ink = { 0.03F, 0.03F, 0.03F };
  Light paper = { 0.75F, 0.78F, 0.8F };
  Light background = { 0.22F, 0.24F, 0.23F };
};

/// Pictures of a printed board, worked out from what each ray of a pixel meets: through the exact lens, 4 x 4 rays in each pixel
/// that
/// an edge crosses, in linear light; then blur, sRGB, noise and rounding.
///
/// The printed sheet is the board with its margin, as printBoard draws it. Frame `Board` as in BoardDescription.
///
/// The rays of the camera are worked out once, so one object makes many pictures.
/// @throws std::invalid_argument as BoardDescription::check(), or for a camera without an image size
/// Thread-safe: take() changes nothing.
class BoardPicture
{
public:
  BoardPicture(const BoardDescription& board, const CameraModel& camera, const BoardLight& light = {});
  ~BoardPicture();

  /// One picture. @param boardToCamera p_Camera = boardToCamera * p_Board
  cv::Mat take(const Eigen::Isometry3d& boardToCamera, const Photograph& how = {}) const;

private:
  std::unique_ptr<BoardPattern> pattern_;
  CameraModel camera_;
  BoardLight light_;
  std::unique_ptr<RayTable> rays_;
};

}  // namespace handeye::simulation
