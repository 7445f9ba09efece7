// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RayGrid.h"

#include <limits>

namespace handeye
{

namespace
{

constexpr int SpacingPx = 24;

int nodes(int pixels)
{
  return (pixels - 1) / SpacingPx + 2;
}

}  // namespace

RayGrid::RayGrid(const CameraModel& camera, const cv::Size& imageSize)
  : imageSize_(imageSize)
  , columns_(nodes(imageSize.width))
{
  const int rows = nodes(imageSize.height);
  rays_.reserve(std::size_t(rows * columns_));
  for (int row = 0; row < rows; ++row)
  {
    for (int column = 0; column < columns_; ++column)
    {
      const CameraModel::Unprojection ray = camera.unproject({ double(column * SpacingPx), double(row * SpacingPx) });
      rays_.push_back(ray.isUsable() ? Eigen::Vector3f(ray.ray_Camera.cast<float>())
                                     : Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    }
  }
}

Eigen::Vector3f RayGrid::at(const cv::Point& pixel) const
{
  const int column = pixel.x / SpacingPx, row = pixel.y / SpacingPx;
  const float fx = float(pixel.x - column * SpacingPx) / SpacingPx, fy = float(pixel.y - row * SpacingPx) / SpacingPx;
  const Eigen::Vector3f* upper = &rays_[std::size_t(row * columns_ + column)];
  const Eigen::Vector3f* lower = upper + columns_;
  const Eigen::Vector3f top = (1 - fx) * upper[0] + fx * upper[1], bottom = (1 - fx) * lower[0] + fx * lower[1];
  return ((1 - fy) * top + fy * bottom).normalized();
}

}  // namespace handeye
