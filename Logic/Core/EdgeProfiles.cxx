// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeProfiles.h"

#include <Eigen/LU>

namespace handeye
{

namespace
{

constexpr double Pi = double(EIGEN_PI);
/// Least contrast (linear light) of an edge, in an image that is well lit: where the brighter side has WellLit. Less in the dark.
constexpr double MinimumContrast = 0.08;
constexpr double WellLit = 0.25;
/// How much the light varies: by noise (of full light), and along its own colour by shading (of itself).
constexpr float LightNoise = 0.02F;
constexpr float ShadingOutside = 0.1F;
/// An edge this far (px) from the expected outline counts half.
constexpr double NearEnoughPx = 8;
/// Light above this is clipped, and nobody knows by how much: so much of the step may be missing.
constexpr float ClippedLight = 0.97F;
constexpr double ClippedLevel = 0.2;
/// Even without light there is noise, as much as this light makes.
constexpr float DarkLight = 0.05F;
constexpr int MatchingRounds = 3;

}  // namespace

bool EdgeSides::isEdge() const
{
  const double brighter = double(std::max(inside.norm(), outside.norm()));
  return brighter > 0 && double(contrast()) >= MinimumContrast * std::min(1.0, brighter / WellLit);
}

Eigen::Vector3f EdgeSides::discriminant(float shadingInside) const
{
  const Eigen::Matrix3f variation = LightNoise * LightNoise * Eigen::Matrix3f::Identity() +
    shadingInside * shadingInside * inside * inside.transpose() + ShadingOutside * ShadingOutside * outside * outside.transpose();
  const Eigen::Vector3f across = inside - outside;
  const Eigen::Vector3f direction = variation.inverse() * across;
  return direction / direction.dot(across);
}

EdgeProfiles::EdgeProfiles(const LinearLightImage& image, const SphereCone::Outline& outline, const EdgeSampling& sampling)
  : step_(sampling.stepPx)
  , shading_(sampling.shading)
  , reach_(sampling.reachPx)
  , reference_(sampling.referencePx)
  , half_(int(std::ceil(sampling.extentPx / sampling.stepPx)))
  , isUsable_(outline.points_Image.size())
  , light_(outline.points_Image.size() * std::size_t(2 * half_ + 1))
{
  for (std::size_t i = 0; i < isUsable_.size(); ++i)
  {
    const Eigen::Vector2d &point = outline.points_Image[i], along = step_ * outline.normals_Image[i];
    isUsable_[i] = image.inside(point + half_ * along) && image.inside(point - half_ * along);
    if (isUsable_[i])
    {
      image.along(point - half_ * along, along, 2 * half_ + 1, light(i));
    }
  }
}

double EdgeProfiles::steepest(std::size_t i) const
{
  const int gap = std::max(1, int(1.0 / step_)), limit = int(reach_ / step_);
  float most = 0;
  int where = 0;
  for (int k = -limit; k <= limit; ++k)
  {
    const Eigen::Vector3f &inside = light(i)[k + half_ - gap], change = light(i)[k + half_ + gap] - inside;
    const float size = inside.norm(), along = size > 0 ? change.dot(inside) / size : 0;
    const float across = std::max(0.0F, change.squaredNorm() - along * along);
    const float shading = shading_ * size;
    const float apart = float(k * step_ / NearEnoughPx);
    const float distinct =
      (across / (LightNoise * LightNoise) + along * along / (LightNoise * LightNoise + shading * shading)) / (1 + apart * apart);
    if (distinct > most)
    {
      most = distinct;
      where = k;
    }
  }
  return where * step_;
}

EdgeSides EdgeProfiles::sides(std::size_t i, double centre) const
{
  const double far = reference_ + StretchPx, furthest = far + StretchPx;
  EdgeSides sides;
  sides.inside = mean(i, centre - far, centre - reference_);
  sides.outside = mean(i, centre + reference_, centre + far);
  sides.insideChange = sides.inside - mean(i, centre - furthest, centre - far);
  sides.outsideChange = sides.outside - mean(i, centre + far, centre + furthest);
  return sides;
}

bool EdgeProfiles::byArea(std::size_t i, const EdgeSides& sides, double centre, EdgeStep& found) const
{
  const Eigen::Vector3f direction = sides.discriminant(shading_);
  const float offset = sides.outside.dot(direction);
  const int first = index((centre - reference_) / step_), last = index((centre + reference_) / step_);
  double area = 0, spread = 0;
  int crossings = 0;
  float before = 0;
  for (int k = first; k <= last; ++k)
  {
    const float level = light(i)[k].dot(direction) - offset;
    const double share = k == first || k == last ? 0.5 : 1;
    area += share * step_ * double(level);
    spread += share * step_ * std::max(0.0, double(level) * (1 - double(level)));
    crossings += k > first && ((before >= 0.5F) != (level >= 0.5F)) ? 1 : 0;
    before = level;
  }
  found = { (first - half_) * step_ + area, spread * std::sqrt(Pi) };
  return crossings == 1;
}

bool EdgeProfiles::byMatching(std::size_t i, const EdgeSides& sides, double blurPx, double& place) const
{
  const Eigen::Vector3f direction = sides.discriminant(shading_);
  const float offset = sides.outside.dot(direction);
  const double blur = std::max(blurPx, SharpestPx), start = place;
  const double inside = noiseVariance(sides.inside, direction), outside = noiseVariance(sides.outside, direction);
  for (int round = 0; round < MatchingRounds; ++round)
  {
    const int first = index((place - BlursOfTail * blur) / step_), last = index((place + BlursOfTail * blur) / step_);
    double sum = 0, weight = 0;
    for (int k = first; k <= last; ++k)
    {
      const Bell::Value bell = Bell::at((place - (k - half_) * step_) / blur);
      const double weighted = bell.density / (outside + bell.integral * (inside - outside));
      sum += weighted * (double(light(i)[k].dot(direction) - offset) - bell.integral);
      weight += weighted * bell.density;
    }
    place += sum / weight * blur;
    if (!(std::abs(place - start) <= reference_))
    {
      return false;
    }
  }
  return true;
}

double EdgeProfiles::noiseVariance(const Eigen::Vector3f& light, const Eigen::Vector3f& direction)
{
  return double((direction.cwiseAbs2().array() * (light.array().max(0) + DarkLight)).sum());
}

bool EdgeProfiles::width(std::size_t i, double& widthPx) const
{
  const EdgeSides both = sides(i, 0);
  if (!both.isEdge())
  {
    return false;
  }
  const Eigen::Vector3f direction = both.discriminant(shading_);
  const float offset = both.outside.dot(direction);
  const auto level = [&](int k) { return light(i)[k + half_].dot(direction) - offset; };
  const int limit = int(reference_ / step_);
  int quarter = 0, threeQuarters = 0;
  while (quarter < limit && level(quarter) > 0.25F)
  {
    ++quarter;
  }
  while (quarter > -limit && level(quarter - 1) < 0.25F)
  {
    --quarter;
  }
  threeQuarters = quarter;
  while (threeQuarters > -limit && level(threeQuarters) < 0.75F)
  {
    --threeQuarters;
  }
  widthPx = (quarter - threeQuarters) * step_;
  return true;
}

double EdgeProfiles::shadingPx(const EdgeSides& sides, double blurPx) const
{
  const Eigen::Vector3f direction = sides.discriminant(shading_);
  const bool isClipped = std::max(sides.inside.maxCoeff(), sides.outside.maxCoeff()) > ClippedLight;
  const double wrong = std::hypot(double(sides.insideChange.dot(direction)), double(sides.outsideChange.dot(direction))) +
    (isClipped ? ClippedLevel : 0);
  return std::sqrt(Pi) * std::max(blurPx, SharpestPx) * wrong;
}

Eigen::Vector3f EdgeProfiles::mean(std::size_t i, double from, double to) const
{
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  const int first = index(from / step_), last = index(to / step_);
  for (int k = first; k <= last; ++k)
  {
    sum += light(i)[k];
  }
  return sum / float(last - first + 1);
}

}  // namespace handeye
