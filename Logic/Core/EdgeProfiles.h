// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearLightImage.h"
#include "SphereCone.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace handeye
{

/// A normal distribution: its integral and its density, tabulated.
class Bell
{
public:
  static constexpr double Reach = 4;

  struct Value
  {
    double integral;
    double density;
  };

  /// @param x within Reach
  static Value at(double x)
  {
    static const Bell bell;
    const double place = (x + Reach) * PerUnit;
    const int i = std::clamp(int(place), 0, Steps - 1);
    const double f = place - i;
    const Value &low = bell.table_[std::size_t(i)], &high = bell.table_[std::size_t(i) + 1];
    return { low.integral + f * (high.integral - low.integral), low.density + f * (high.density - low.density) };
  }

private:
  static constexpr int PerUnit = 64;
  static constexpr int Steps = int(2 * Reach) * PerUnit;

  Bell()
  {
    for (int i = 0; i <= Steps; ++i)
    {
      const double x = double(i) / PerUnit - Reach;
      table_[std::size_t(i)] = { 0.5 * std::erfc(-x / std::sqrt(2.0)), std::exp(-x * x / 2) / std::sqrt(2 * double(EIGEN_PI)) };
    }
  }

  std::array<Value, Steps + 1> table_;
};

/// The light on either side of the edge.
struct EdgeSides
{
  Eigen::Vector3f inside = Eigen::Vector3f::Zero();
  Eigen::Vector3f outside = Eigen::Vector3f::Zero();
  Eigen::Vector3f insideChange = Eigen::Vector3f::Zero();   ///< from further in to `inside`
  Eigen::Vector3f outsideChange = Eigen::Vector3f::Zero();  ///< from further out to `outside`

  float contrast() const { return (inside - outside).norm(); }
  bool isEdge() const;

  /// The direction of colour along which inside and outside are told apart, scaled so that they are 1 apart: Fisher's discriminant
  /// for light that varies by noise and, on either side, along its own colour by shading. A ball that darkens towards its limb
  /// keeps its colour; so where the background differs in colour its brightness hardly counts, and where it does not, brightness is
  /// what there is.
  Eigen::Vector3f discriminant(float shadingInside) const;
};

/// Where the step of a profile is, and how wide.
struct EdgeStep
{
  double place = 0;
  double blur = 0;
};

/// How the light along a normal is read.
struct EdgeSampling
{
  double reachPx = 0;      ///< how far from the outline an edge is looked for
  double referencePx = 0;  ///< the stretches whose light counts as that of either side start so far from the edge
  double extentPx = 0;     ///< how far from the outline light is read
  double stepPx = 0.5;     ///< between samples
  float shading = 0;       ///< how much the ball's light varies along its own colour, as a share of itself
};

/// The light along the normals of an outline, and where on them the edge is. Internal to the detection.
///
/// A normal's samples are numbered from the inside; places on it are in px from the outline, outwards positive.
class EdgeProfiles
{
public:
  /// Width of the stretch inside and outside over which the light on either side is averaged.
  static constexpr double StretchPx = 1.5;
  /// The blurred step that is fitted is never sharper than this (px): bilinear sampling alone blurs that much.
  static constexpr double SharpestPx = 0.35;
  /// The step goes on for so many blurs to either side.
  static constexpr double BlursOfTail = 3;

  EdgeProfiles(const LinearLightImage& image, const SphereCone::Outline& outline, const EdgeSampling& sampling);

  std::size_t count() const { return isUsable_.size(); }
  bool isUsable(std::size_t i) const { return isUsable_[i]; }

  /// Where the light changes most; changes along the ball's own colour count less, and so do changes further away: a highlight
  /// has a rim,
  /// too.
  double steepest(std::size_t i) const;

  /// The light on either side of a place.
  EdgeSides sides(std::size_t i, double centre) const;

  /// The step by the area under the profile, which uses every sample; false unless the profile falls once.
  bool byArea(std::size_t i, const EdgeSides& sides, double centre, EdgeStep& found) const;

  /// The blurred step that fits the profile best, every sample by its noise: encoded light is noisier where it is brighter.
  bool byMatching(std::size_t i, const EdgeSides& sides, double blurPx, double& place) const;

  /// Of the level along a direction, up to a factor: a gamma near 2 makes the noise of encoded light grow with the root of the
  /// light.
  static double noiseVariance(const Eigen::Vector3f& light, const Eigen::Vector3f& direction);

  /// How far apart (px) the places nearest to the outline are where the light has fallen to three quarters and to a quarter;
  /// false where
  /// there are none.
  bool width(std::size_t i, double& widthPx) const;

  /// The place that is found moves by this much per level that a side is wrong by; and a side is wrong by what it changes on
  /// the way to
  /// the edge, and by what was clipped.
  double shadingPx(const EdgeSides& sides, double blurPx) const;

private:
  int index(double steps) const { return std::clamp(int(std::lround(steps)) + half_, 0, 2 * half_); }
  Eigen::Vector3f* light(std::size_t i) { return light_.data() + i * std::size_t(2 * half_ + 1); }
  const Eigen::Vector3f* light(std::size_t i) const { return light_.data() + i * std::size_t(2 * half_ + 1); }

  Eigen::Vector3f mean(std::size_t i, double from, double to) const;

  double step_;
  float shading_;
  double reach_;
  double reference_;
  int half_;
  std::vector<char> isUsable_;
  std::vector<Eigen::Vector3f> light_;
};

}  // namespace handeye
