// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallCandidates.h"

#include "WideVectors.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace handeye
{

namespace
{

constexpr double Pi = double(EIGEN_PI);
constexpr std::size_t MaximumRegions = 8;
constexpr std::size_t MaximumCandidates = 12;
constexpr int MaximumConesPerRegion = 2;
constexpr std::size_t BorderSamples = 320;
/// Draws of three border points; half of them from one stretch of the border, where they are likely to be of one outline.
constexpr int MostDraws = 240;
/// No more draws once all three points were on the best outline with this certainty.
constexpr double Certainty = 0.9999;
/// A border point supports a cone when it is this close to it, in px.
constexpr double SupportPx = 1.5;
/// A hole (a highlight) is closed when it is smaller than this share of its region.
constexpr double HighlightShare = 0.2;
/// A cone is followed up when this share of its outline lies on the region's border.
constexpr double FewestSupport = 0.15;
constexpr double WidestHalfAngle = 1.2;

struct Candidate
{
  SphereCone cone;
  double share = 0;  ///< border points near the cone over the length of its outline, at most about 1
  double score = 0;
};

/// How many rays are this close to a cone: |ray . axis - cosine| below a tolerance. The innermost loop of the search.
HANDEYE_WIDE_VECTORS int countNear(
  const float* x, const float* y, const float* z, int count, const Eigen::Vector3f& axis, float cosine, float tolerance)
{
  int near = 0;
  const float ax = axis.x(), ay = axis.y(), az = axis.z();
  for (int i = 0; i < count; ++i)
  {
    near += std::abs(x[i] * ax + y[i] * ay + z[i] * az - cosine) < tolerance ? 1 : 0;
  }
  return near;
}

/// A region's border as rays, in its order, without the points that are the image's own border.
class BorderRays
{
public:
  BorderRays(const std::vector<cv::Point>& border, const cv::Point& origin, const RayGrid& grid, double focalPx)
    : focalPx_(focalPx)
  {
    const std::size_t samples = std::min(border.size(), BorderSamples);
    pixelsPerSample_ = double(border.size()) / double(samples);
    const cv::Rect inner(2, 2, grid.imageSize().width - 4, grid.imageSize().height - 4);
    for (std::size_t i = 0; i < samples; ++i)
    {
      const cv::Point pixel = border[std::size_t(double(i) * pixelsPerSample_)] + origin;
      const Eigen::Vector3f ray = inner.contains(pixel) ? grid.at(pixel) : Eigen::Vector3f::Constant(NAN);
      if (!std::isnan(ray.x()))
      {
        x_.push_back(ray.x());
        y_.push_back(ray.y());
        z_.push_back(ray.z());
      }
    }
  }

  /// The cone through three border points that most of the others follow.
  Candidate bestCone(double minimumRadiusPx) const
  {
    Candidate best;
    const std::size_t total = x_.size();
    if (total < 6)
    {
      return best;
    }
    std::mt19937 random(7);
    int draws = MostDraws;
    for (int draw = 0; draw < draws; ++draw)
    {
      std::size_t a = random() % total, b = random() % total, c = random() % total;
      if (draw % 2 == 0)
      {
        const std::size_t step = 1 + b % std::max<std::size_t>(1, total / 4);
        b = (a + step) % total;
        c = (b + step) % total;
      }
      const Candidate drawn = judge(coneThrough(ray(a), ray(b), ray(c)), minimumRadiusPx);
      if (drawn.score > best.score)
      {
        best = drawn;
        const double hit = best.share * 2 * Pi * radiusPx(best.cone) / (pixelsPerSample_ * double(total));
        const double all = std::clamp(hit * hit * hit, 1e-9, 0.999);
        draws = int(std::clamp(std::log(1 - Certainty) / std::log(1 - all), 12.0, double(MostDraws)));
      }
    }
    return best;
  }

  /// Takes away what a cone explains: a second ball may be attached.
  void remove(const SphereCone& cone)
  {
    const double cosine = std::cos(cone.halfAngle);
    const double tolerance = 3 * SupportPx / focalPx_ * std::sin(cone.halfAngle);
    std::size_t count = 0;
    for (std::size_t i = 0; i < x_.size(); ++i)
    {
      if (std::abs(ray(i).dot(cone.axis_Camera) - cosine) >= tolerance)
      {
        x_[count] = x_[i];
        y_[count] = y_[i];
        z_[count++] = z_[i];
      }
    }
    x_.resize(count);
    y_.resize(count);
    z_.resize(count);
  }

private:
  Eigen::Vector3d ray(std::size_t i) const { return { double(x_[i]), double(y_[i]), double(z_[i]) }; }
  double radiusPx(const SphereCone& cone) const { return focalPx_ * std::tan(cone.halfAngle); }

  Candidate judge(const SphereCone& cone, double minimumRadiusPx) const
  {
    if (cone.halfAngle > WidestHalfAngle || cone.axis_Camera.z() <= 0 || !(radiusPx(cone) >= minimumRadiusPx))
    {
      return {};
    }
    // |cos(angle) - cos(halfAngle)| is the angle's deviation times sin(halfAngle): no arc cosine in the inner loop.
    const double tolerance = SupportPx / focalPx_ * std::sin(cone.halfAngle);
    const double count = countNear(x_.data(), y_.data(), z_.data(), int(x_.size()), cone.axis_Camera.cast<float>(),
      float(std::cos(cone.halfAngle)), float(tolerance));
    const double share = count * pixelsPerSample_ / (2 * Pi * radiusPx(cone));
    // Between equally complete circles the one that explains more of the border wins: a highlight's rim is a circle, too.
    return { cone, share, share * std::sqrt(count) };
  }

  double focalPx_;
  double pixelsPerSample_ = 1;
  std::vector<float> x_, y_, z_;  ///< unit rays
};

using Border = std::vector<cv::Point>;

/// The outer border of each region and of each of its holes that is too large to be a highlight; the largest regions first.
/// @param around becomes what all of them together cover (px of the mask)
std::vector<Border> findBorders(const cv::Mat& mask, const cv::Point& origin, double minimumRadiusPx,
  const std::function<bool(const cv::Rect&)>& isKnown, cv::Rect& around)
{
  std::vector<Border> contours;
  std::vector<cv::Vec4i> hierarchy;
  cv::findContours(mask, contours, hierarchy, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  const double minimumArea = minimumRadiusPx * minimumRadiusPx;
  std::vector<std::pair<double, std::size_t>> regions;
  around = {};
  for (std::size_t i = 0; i < contours.size(); ++i)
  {
    // An area needs a border that goes around it.
    const bool isOuter = hierarchy[i][3] < 0;
    if (!isOuter || double(contours[i].size()) < 2 * minimumRadiusPx)
    {
      continue;
    }
    const double area = cv::contourArea(contours[i]);
    const cv::Rect box = cv::boundingRect(contours[i]);
    if (area >= minimumArea && !isKnown(box + origin))
    {
      regions.emplace_back(area, i);
      around |= box;
    }
  }
  std::sort(regions.begin(), regions.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  regions.resize(std::min(regions.size(), MaximumRegions));
  std::vector<Border> borders;
  for (const auto& [area, index] : regions)
  {
    Border border = std::move(contours[index]);
    for (int hole = hierarchy[index][2]; hole >= 0; hole = hierarchy[std::size_t(hole)][0])
    {
      const Border& rim = contours[std::size_t(hole)];
      if (double(rim.size()) > minimumRadiusPx && cv::contourArea(rim) > HighlightShare * area)
      {
        border.insert(border.end(), rim.begin(), rim.end());
      }
    }
    borders.push_back(std::move(border));
  }
  return borders;
}

}  // namespace

BallCandidates findBallCandidates(const cv::Mat& mask, const cv::Point& origin, const RayGrid& grid, double focalPx,
  double minimumRadiusPx, const std::function<bool(const cv::Rect&)>& isKnown)
{
  BallCandidates result;
  std::vector<Candidate> candidates;
  for (const Border& border : findBorders(mask, origin, minimumRadiusPx, isKnown, result.around))
  {
    BorderRays rays(border, origin, grid, focalPx);
    for (int k = 0; k < MaximumConesPerRegion; ++k)
    {
      const Candidate candidate = rays.bestCone(minimumRadiusPx);
      if (candidate.share < FewestSupport)
      {
        break;
      }
      candidates.push_back(candidate);
      rays.remove(candidate.cone);
    }
  }
  result.around += origin;
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  candidates.resize(std::min(candidates.size(), MaximumCandidates));
  for (const Candidate& candidate : candidates)
  {
    result.cones.push_back(candidate.cone);
  }
  return result;
}

}  // namespace handeye
