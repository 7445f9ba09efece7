// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OutlinePixels.h"

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

/// Finds the point of an outline that is nearest to a place.
class NearestPoint
{
public:
  NearestPoint(const SphereCone::Outline& outline, const Eigen::Vector2d& centre_Image)
    : outline_(outline)
    , centre_(centre_Image)
    , count_(int(outline.points_Image.size()))
    , first_(std::size_t(count_), -1)
  {
    for (int i = 0; i < count_; ++i)
    {
      first_[bin(point(i))] = i;
      const Eigen::Vector2d next = point((i + 1) % count_) - point(i);
      lengths_.push_back(next.norm());
      tangents_.push_back(next.normalized());
    }
    // Bins without a point have the one before.
    int last = *std::max_element(first_.begin(), first_.end());
    for (int round = 0; round < 2; ++round)
    {
      for (int& first : first_)
      {
        first = first < 0 ? last : first;
        last = first;
      }
    }
  }

  /// @param along receives how far the place is from the point's normal, px
  std::size_t find(const Eigen::Vector2d& place, double& along) const
  {
    int i = first_[bin(place)];
    for (int step = 0; step < MostSteps; ++step)
    {
      along = tangents_[std::size_t(i)].dot(place - point(i));
      if (along > 0.5 * lengths_[std::size_t(i)])
      {
        i = (i + 1) % count_;
      }
      else if (along < -0.5 * lengths_[std::size_t(i)])
      {
        i = (i + count_ - 1) % count_;
      }
      else
      {
        break;
      }
    }
    return std::size_t(i);
  }

private:
  static constexpr int MostSteps = 8;

  const Eigen::Vector2d& point(int i) const { return outline_.points_Image[std::size_t(i)]; }
  std::size_t bin(const Eigen::Vector2d& place) const
  {
    const float degrees = cv::fastAtan2(float(place.y() - centre_.y()), float(place.x() - centre_.x()));
    return std::size_t(std::min(int(degrees * float(count_) / 360), count_ - 1));
  }

  const SphereCone::Outline& outline_;
  Eigen::Vector2d centre_;
  int count_;
  std::vector<int> first_;
  std::vector<double> lengths_;
  std::vector<Eigen::Vector2d> tangents_;
};

}  // namespace

std::vector<OutlinePixel> pixelsAlongOutline(
  const LinearLightImage& light, const SphereCone::Outline& outline, double radiusPx, double insidePx, double outsidePx)
{
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& point : outline.points_Image)
  {
    box.extend(point);
  }
  const Eigen::Vector2d centre = box.center();
  double nearest = 1e9, furthest = 0;
  for (const Eigen::Vector2d& point : outline.points_Image)
  {
    nearest = std::min(nearest, (point - centre).norm());
    furthest = std::max(furthest, (point - centre).norm());
  }
  nearest = std::max(0.0, nearest - insidePx - 1);
  furthest += outsidePx + 1;
  const NearestPoint points(outline, centre);
  std::vector<OutlinePixel> pixels;
  const int top = std::max(0, int(std::ceil(centre.y() - furthest)));
  const int bottom = std::min(light.height() - 1, int(std::floor(centre.y() + furthest)));
  for (int row = top; row <= bottom; ++row)
  {
    const double y = row - centre.y(), half = std::sqrt(std::max(0.0, furthest * furthest - y * y));
    const double hole = std::sqrt(std::max(0.0, nearest * nearest - y * y));
    const int last = std::min(light.width() - 1, int(std::floor(centre.x() + half)));
    for (int column = std::max(0, int(std::ceil(centre.x() - half))); column <= last; ++column)
    {
      if (std::abs(column - centre.x()) < hole)
      {
        column = int(std::ceil(centre.x() + hole));
        if (column > last)
        {
          break;
        }
      }
      const Eigen::Vector2d place(column, row);
      double along = 0;
      const std::size_t i = points.find(place, along);
      const double across = outline.normals_Image[i].dot(place - outline.points_Image[i]);
      const double offset = across + along * along / (2 * std::max(1.0, radiusPx + across));
      if (offset >= -insidePx && offset <= outsidePx)
      {
        pixels.push_back({ i, place.cast<float>(), float(offset), light.pixel(column, row) });
      }
    }
  }
  return pixels;
}

}  // namespace handeye
