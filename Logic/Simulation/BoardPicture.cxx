// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardPicture.h"

#include "BoardPattern.h"
#include "SphereRenderer.h"

#include <opencv2/imgproc.hpp>

#include <stdexcept>

namespace handeye::simulation
{

namespace
{

constexpr int Grid = 4;

/// Where rays meet a board.
class Caster
{
public:
  Caster(const BoardPattern& pattern, const BoardLight& light, const Eigen::Isometry3d& boardToCamera)
    : pattern_(pattern)
    , light_(light)
    , normal_Camera_(boardToCamera.linear().col(2))
    , cameraToBoard_(boardToCamera.inverse())
    , offset_(normal_Camera_.dot(boardToCamera.translation()))
  {
  }

  Light lightOf(const Eigen::Vector3d& ray_Camera) const
  {
    const double along = normal_Camera_.dot(ray_Camera);
    const double distance = offset_ / along;
    if (!(distance > 0) || !std::isfinite(distance))
    {
      return light_.background;
    }
    const Eigen::Vector3d hit_Camera = distance * ray_Camera;
    const Eigen::Vector2d hit_Board = (cameraToBoard_ * hit_Camera).head<2>();
    const BoardPattern::Rectangle& sheet = pattern_.sheet();
    const bool isOnSheet =
      (hit_Board.array() >= sheet.lower_Board.array()).all() && (hit_Board.array() <= sheet.upper_Board.array()).all();
    // Printed on one side only: z points into the board.
    return !isOnSheet ? light_.background : along > 0 && pattern_.isBlack(hit_Board) ? light_.ink : light_.paper;
  }

private:
  const BoardPattern& pattern_;
  const BoardLight& light_;
  Eigen::Vector3d normal_Camera_;
  Eigen::Isometry3d cameraToBoard_;
  double offset_;
};

Light supersampled(const Caster& caster, const RayTable& rays, int column, int row)
{
  Light sum(0, 0, 0);
  for (int i = 0; i < Grid * Grid; ++i)
  {
    sum += caster.lightOf(rays.at(column - 0.5 + (i % Grid + 0.5) / Grid, row - 0.5 + (i / Grid + 0.5) / Grid));
  }
  return sum / float(Grid * Grid);
}

}  // namespace

BoardPicture::BoardPicture(const BoardDescription& board, const CameraModel& camera, const BoardLight& light)
  : pattern_(std::make_unique<BoardPattern>(board))
  , camera_(camera)
  , light_(light)
{
  if (!camera.hasImageSize())
  {
    throw std::invalid_argument("BoardPicture: the camera has no image size");
  }
  rays_ = std::make_unique<RayTable>(camera);
}

BoardPicture::~BoardPicture() = default;

cv::Mat BoardPicture::take(const Eigen::Isometry3d& boardToCamera, const Photograph& how) const
{
  const Caster caster(*pattern_, light_, boardToCamera);
  const int width = camera_.width(), height = camera_.height();
  // What the pixels' corners meet: where all four agree a pixel has one colour, unless a corner of something lies within.
  cv::Mat corners(height + 1, width + 1, CV_32FC3);
  for (int row = 0; row <= height; ++row)
  {
    for (int column = 0; column <= width; ++column)
    {
      corners.at<Light>(row, column) = caster.lightOf(rays_->at(column - 0.5, row - 0.5));
    }
  }
  cv::Mat light(height, width, CV_32FC3);
  for (int row = 0; row < height; ++row)
  {
    const Light *above = corners.ptr<Light>(row), *below = corners.ptr<Light>(row + 1);
    Light* pixels = light.ptr<Light>(row);
    for (int column = 0; column < width; ++column)
    {
      const Light first = above[column];
      const bool isEven = first == above[column + 1] && first == below[column] && first == below[column + 1] &&
        first == caster.lightOf(rays_->at(column, row));
      pixels[column] = isEven ? first : supersampled(caster, *rays_, column, row);
    }
  }
  if (how.blurPx > 0)
  {
    cv::GaussianBlur(light, light, {}, how.blurPx, how.blurPx, cv::BORDER_REPLICATE);
  }
  return develop(light, how);
}

}  // namespace handeye::simulation
