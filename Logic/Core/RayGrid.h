// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <vector>

namespace handeye
{

/// The rays of an image's pixels, interpolated between exact ones on a coarse grid: good to a few tenths of a pixel even for strong
/// lenses, and many times faster than CameraModel::unproject(). For where to look, not for what is measured.
///
/// Thread-safe: immutable after construction.
class RayGrid
{
public:
  RayGrid(const CameraModel& camera, const cv::Size& imageSize);

  const cv::Size& imageSize() const { return imageSize_; }

  /// @param pixel inside the image
  /// @return a ray of about unit length; NaN where the lens model cannot be believed
  Eigen::Vector3f at(const cv::Point& pixel) const;

private:
  cv::Size imageSize_;
  int columns_;
  std::vector<Eigen::Vector3f> rays_;
};

}  // namespace handeye
