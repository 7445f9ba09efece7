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
/// So many of the largest regions are looked at, whatever they are like, and so many of the others that are round by themselves.
constexpr std::size_t LargestRegions = 8;
constexpr std::size_t RoundRegions = 24;
constexpr std::size_t MaximumCandidates = 12;
constexpr std::size_t MaximumRoundCandidates = 6;
/// A region is round if it fills its box so far and this is no longer than so; a half disc is.
constexpr double LeastOfBox = 0.48;
constexpr double MostOfBox = 0.92;
constexpr double LongestBox = 2.4;
constexpr int MaximumConesPerRegion = 2;
constexpr std::size_t BorderSamples = 320;
/// Draws of three border points; half of them from one stretch of the border, where they are likely to be of one outline.
constexpr int MostDraws = 240;
/// No more draws once all three points were on the best outline with this certainty.
constexpr double Certainty = 0.9999;
/// A border point supports a cone when it is this close to it, in px; of a small one, this share of its radius.
constexpr double SupportPx = 1.5;
constexpr double LeastSupportPx = 0.8;
constexpr double SupportShare = 0.12;
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
    const double tolerance = 3 * supportPx(cone) / focalPx_ * std::sin(cone.halfAngle);
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
  double supportPx(const SphereCone& cone) const { return std::clamp(SupportShare * radiusPx(cone), LeastSupportPx, SupportPx); }

  Candidate judge(const SphereCone& cone, double minimumRadiusPx) const
  {
    if (cone.halfAngle > WidestHalfAngle || cone.axis_Camera.z() <= 0 || !(radiusPx(cone) >= minimumRadiusPx))
    {
      return {};
    }
    // |cos(angle) - cos(halfAngle)| is the angle's deviation times sin(halfAngle): no arc cosine in the inner loop.
    const double tolerance = supportPx(cone) / focalPx_ * std::sin(cone.halfAngle);
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

using Contour = std::vector<cv::Point>;

/// The outer border of a region and of each of its holes that is too large to be a highlight.
struct Border
{
  Contour pixels;
  bool isOfLargest = true;  ///< the region is one of the largest; otherwise it is a round one
};

struct Region
{
  double area;
  std::size_t contour;
  bool isRound;
};

bool isRound(double area, const cv::Rect& box)
{
  // The border goes through the centres of pixels.
  const double width = std::max(1, box.width - 1), height = std::max(1, box.height - 1), share = area / (width * height);
  return share >= LeastOfBox && share <= MostOfBox && std::max(width, height) <= LongestBox * std::min(width, height);
}

/// The borders of the regions, the largest first.
/// @param around becomes what all of them together cover (px of the mask)
std::vector<Border> findBorders(const cv::Mat& mask, const cv::Point& origin, double minimumRadiusPx,
  const std::function<bool(const cv::Rect&)>& isKnown, cv::Rect& around)
{
  std::vector<Contour> contours;
  std::vector<cv::Vec4i> hierarchy;
  cv::findContours(mask, contours, hierarchy, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  const double minimumArea = minimumRadiusPx * minimumRadiusPx;
  std::vector<Region> regions;
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
      regions.push_back({ area, i, isRound(area, box) });
      around |= box;
    }
  }
  std::sort(regions.begin(), regions.end(), [](const Region& a, const Region& b) { return a.area > b.area; });
  std::vector<Border> borders;
  for (std::size_t i = 0; i < regions.size() && borders.size() < LargestRegions + RoundRegions; ++i)
  {
    const bool isOfLargest = i < LargestRegions;
    if (!isOfLargest && !regions[i].isRound)
    {
      continue;
    }
    const std::size_t outer = regions[i].contour;
    Border border{ std::move(contours[outer]), isOfLargest };
    for (int hole = hierarchy[outer][2]; hole >= 0; hole = hierarchy[std::size_t(hole)][0])
    {
      const Contour& rim = contours[std::size_t(hole)];
      if (double(rim.size()) > minimumRadiusPx && cv::contourArea(rim) > HighlightShare * regions[i].area)
      {
        border.pixels.insert(border.pixels.end(), rim.begin(), rim.end());
      }
    }
    borders.push_back(std::move(border));
  }
  return borders;
}

/// The best of the candidates.
void takeBest(std::vector<Candidate> candidates, std::size_t most, std::vector<SphereCone>& cones)
{
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  for (std::size_t i = 0; i < std::min(most, candidates.size()); ++i)
  {
    cones.push_back(candidates[i].cone);
  }
}

}  // namespace

BallCandidates findBallCandidates(const cv::Mat& mask, const cv::Point& origin, const RayGrid& grid, double focalPx,
  double minimumRadiusPx, const std::function<bool(const cv::Rect&)>& isKnown)
{
  BallCandidates result;
  std::vector<Candidate> ofLargest, ofRound;
  for (const Border& border : findBorders(mask, origin, minimumRadiusPx, isKnown, result.around))
  {
    BorderRays rays(border.pixels, origin, grid, focalPx);
    for (int k = 0; k < (border.isOfLargest ? MaximumConesPerRegion : 1); ++k)
    {
      const Candidate candidate = rays.bestCone(minimumRadiusPx);
      if (candidate.share < FewestSupport)
      {
        break;
      }
      (border.isOfLargest ? ofLargest : ofRound).push_back(candidate);
      rays.remove(candidate.cone);
    }
  }
  takeBest(std::move(ofLargest), MaximumCandidates, result.cones);
  takeBest(std::move(ofRound), MaximumRoundCandidates, result.cones);
  result.around += origin;
  return result;
}

}  // namespace handeye
