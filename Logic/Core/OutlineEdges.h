// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "SphereCone.h"

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <array>
#include <vector>

namespace handeye
{

/// An image sampled in linear light.
///
/// Cameras encode light with a gamma; an edge sits where the linear light is half way, not where the pixel value is. The curve
/// undone here is sRGB's, which consumer and surgical cameras follow closely.
class LinearLightImage
{
public:
  /// @param image BGR or BGRA, 8 or 16 bit; not copied, must outlive this object
  explicit LinearLightImage(const cv::Mat& image);

  /// The light (blue, green, red; 0 to 1) at a place between pixels, bilinear; the place must be inside().
  Eigen::Vector3f at(double x, double y) const;
  bool inside(const Eigen::Vector2d& point_Image) const;

private:
  template<typename Pixel> Eigen::Vector3f interpolate(double x, double y) const;

  const cv::Mat& image_;
  std::vector<float> table_;  ///< pixel value to linear light
};

struct OutlineEdges
{
  struct Edge
  {
    Eigen::Vector2d point_Image = Eigen::Vector2d::Zero();  ///< px, sub-pixel
    Eigen::Vector3d ray_Camera = Eigen::Vector3d::UnitZ();
    double contrast = 0;  ///< of the linear light across the edge
  };
  std::vector<Edge> edges;
  int searched = 0;   ///< places on the outline where an edge was looked for
  double blurPx = 0;  ///< median standard deviation of the edges' blur
};

/// Looks for the ball's edge along the normals of an expected outline.
///
/// The light along a normal is projected onto the difference between the light just inside and just outside, so that any pair of
/// colours makes a profile from 1 to 0; the edge is where the area under it says, which uses every sample.
///
/// @param expected where the outline is thought to be
/// @param reachPx how far from it an edge is looked for
/// @param blurPx blur of the edges if known (from an earlier call), else 0
OutlineEdges findOutlineEdges(
  const LinearLightImage& image, const CameraModel& camera, const SphereCone& expected, double reachPx, double blurPx);

}  // namespace handeye
