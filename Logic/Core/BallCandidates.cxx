// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallCandidates.h"

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace handeye
{

namespace
{

constexpr std::size_t MaximumRegions = 8;
constexpr std::size_t MaximumCandidates = 12;
constexpr int MaximumConesPerRegion = 2;
constexpr int BorderSamples = 240;
constexpr int Draws = 400;
/// A border point supports a cone when it is this close to it, in px.
constexpr double SupportPx = 1.5;
/// A hole (a highlight) is closed when it is smaller than this share of its region.
constexpr double HighlightShare = 0.2;

struct Candidate
{
  SphereCone cone;
  double support;  ///< border points near the cone over the length of its outline, at most about 1
};

/// A region's border as rays, without the points that are the image's own border.
std::vector<Eigen::Vector3d> borderRays(const std::vector<cv::Point>& border, cv::Size imageSize, const CameraModel& camera)
{
  std::vector<Eigen::Vector3d> rays;
  const std::size_t step = std::max<std::size_t>(1, border.size() / BorderSamples);
  for (std::size_t i = 0; i < border.size(); i += step)
  {
    const cv::Point& pixel = border[i];
    if (pixel.x <= 1 || pixel.y <= 1 || pixel.x >= imageSize.width - 2 || pixel.y >= imageSize.height - 2)
    {
      continue;
    }
    const CameraModel::Unprojection ray = camera.unproject({ double(pixel.x), double(pixel.y) });
    if (ray.isUsable())
    {
      rays.push_back(ray.ray_Camera);
    }
  }
  return rays;
}

/// The cone through three border points that most of the others follow.
Candidate bestCone(
  const std::vector<Eigen::Vector3d>& rays, double pixelsPerSample, const CameraModel& camera, double minimumRadiusPx)
{
  Candidate best{ {}, 0 };
  if (rays.size() < 6)
  {
    return best;
  }
  const double focal = (camera.fx() + camera.fy()) / 2;
  std::mt19937 random(7);
  std::uniform_int_distribution<std::size_t> any(0, rays.size() - 1);
  for (int draw = 0; draw < Draws; ++draw)
  {
    const SphereCone cone = coneThrough(rays[any(random)], rays[any(random)], rays[any(random)]);
    const double radiusPx = focal * std::tan(cone.halfAngle);
    if (!(radiusPx >= minimumRadiusPx) || cone.halfAngle > 1.2 || cone.axis_Camera.z() <= 0)
    {
      continue;
    }
    // |cos(angle) - cos(halfAngle)| is the angle's deviation times sin(halfAngle): no arc cosine in the inner loop.
    const double cosine = std::cos(cone.halfAngle);
    const double tolerance = SupportPx / focal * std::sin(cone.halfAngle);
    const auto supports = [&](const Eigen::Vector3d& ray) { return std::abs(ray.dot(cone.axis_Camera) - cosine) < tolerance; };
    const double count = double(std::count_if(rays.begin(), rays.end(), supports));
    const double support = count * pixelsPerSample / (2 * EIGEN_PI * radiusPx);
    // Between equally complete circles the one that explains more of the border wins: a highlight's rim is a circle, too.
    const double score = support * std::sqrt(count);
    if (score > best.support)
    {
      best = { cone, score };
    }
  }
  return best;
}

/// The outer border of each region and of each of its holes that is too large to be a highlight.
std::vector<std::vector<cv::Point>> findBorders(const cv::Mat& mask, double minimumRadiusPx)
{
  std::vector<std::vector<cv::Point>> contours;
  std::vector<cv::Vec4i> hierarchy;
  cv::findContours(mask, contours, hierarchy, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  const double minimumArea = minimumRadiusPx * minimumRadiusPx;
  std::vector<std::pair<double, std::vector<cv::Point>>> borders;
  for (std::size_t i = 0; i < contours.size(); ++i)
  {
    const bool isOuter = hierarchy[i][3] < 0;
    const double area = cv::contourArea(contours[i]);
    if (!isOuter || area < minimumArea)
    {
      continue;
    }
    std::vector<cv::Point> border = contours[i];
    for (int hole = hierarchy[i][2]; hole >= 0; hole = hierarchy[hole][0])
    {
      if (cv::contourArea(contours[hole]) > HighlightShare * area)
      {
        border.insert(border.end(), contours[hole].begin(), contours[hole].end());
      }
    }
    borders.emplace_back(area, std::move(border));
  }
  std::sort(borders.begin(), borders.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  borders.resize(std::min(borders.size(), MaximumRegions));
  std::vector<std::vector<cv::Point>> result;
  for (auto& border : borders)
  {
    result.push_back(std::move(border.second));
  }
  return result;
}

}  // namespace

std::vector<SphereCone> findBallCandidates(const cv::Mat& mask, const CameraModel& camera, double minimumRadiusPx)
{
  std::vector<Candidate> candidates;
  for (const std::vector<cv::Point>& border : findBorders(mask, minimumRadiusPx))
  {
    std::vector<Eigen::Vector3d> rays = borderRays(border, mask.size(), camera);
    const double pixelsPerSample = double(std::max<std::size_t>(1, border.size() / BorderSamples));
    for (int k = 0; k < MaximumConesPerRegion; ++k)
    {
      const Candidate candidate = bestCone(rays, pixelsPerSample, camera, minimumRadiusPx);
      if (!(candidate.support > 0))
      {
        break;
      }
      candidates.push_back(candidate);
      // What follows this cone is explained; a second ball may be attached.
      const double cosine = std::cos(candidate.cone.halfAngle);
      const double tolerance = 3 * SupportPx / camera.fx() * std::sin(candidate.cone.halfAngle);
      const auto explained = [&](const Eigen::Vector3d& ray)
      { return std::abs(ray.dot(candidate.cone.axis_Camera) - cosine) < tolerance; };
      rays.erase(std::remove_if(rays.begin(), rays.end(), explained), rays.end());
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) { return a.support > b.support; });
  candidates.resize(std::min(candidates.size(), MaximumCandidates));
  std::vector<SphereCone> cones;
  for (const Candidate& candidate : candidates)
  {
    cones.push_back(candidate.cone);
  }
  return cones;
}

}  // namespace handeye
