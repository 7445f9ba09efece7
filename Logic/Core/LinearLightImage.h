// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace handeye
{

/// An image sampled in linear light.
///
/// Cameras encode light with a gamma; an edge sits where the linear light is half way, not where the pixel value is. The curve
/// undone here is sRGB's, which consumer and surgical cameras follow closely.
class LinearLightImage
{
public:
  /// @param image 3 or 4 channels, 8 or 16 bit; not copied, must outlive this object
  explicit LinearLightImage(const cv::Mat& image);

  /// Whether there is light at a place between pixels.
  bool inside(const Eigen::Vector2d& point_Image) const
  {
    return point_Image.x() >= 0 && point_Image.y() >= 0 && point_Image.x() < image_.cols - 1 && point_Image.y() < image_.rows - 1;
  }

  /// The light at `count` places that are `step` px apart, the first and the last of which must be inside(): the
  /// first three channels (0 to 1), bilinear.
  void along(const Eigen::Vector2d& first, const Eigen::Vector2d& step, int count, Eigen::Vector3f* light) const;

  /// The light of a pixel, which must be one of the image's.
  Eigen::Vector3f pixel(int column, int row) const;
  int width() const { return image_.cols; }
  int height() const { return image_.rows; }

  /// How fast the light grows with the encoded value (0 to 1) that stands for it.
  static float slope(float light);

private:
  template<typename Pixel>
  void interpolate(const Eigen::Vector2d& first, const Eigen::Vector2d& step, int count, Eigen::Vector3f* light) const;

  const cv::Mat& image_;
  const float* table_;  ///< pixel value to linear light
};

}  // namespace handeye
