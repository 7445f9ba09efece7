// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OutlineEdges.h"

#include "EdgeProfiles.h"
#include "Statistics.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

constexpr double CoarseStepPx = 0.5;
constexpr double FineStepPx = 0.25;
/// How much the light varies along the ball's own colour by shading, of itself. As long as the outline is not known the light that
/// shading takes away towards the limb must not be taken for it: there it is the colour that counts.
constexpr float ShadingRough = 1.0F;
constexpr float ShadingInside = 0.1F;
/// The references start this many blurs from the edge, but not closer than NearestReferencePx.
constexpr double BlursToReference = 1.25;
constexpr double NearestReferencePx = 1.5;
constexpr double FurthestReferencePx = 5;
constexpr double UnknownBlurPx = 1.0;
/// How far from the outline the light is that an edge's width is measured between.
constexpr double WidthReferencePx = 7;
/// Waves of the width are told apart where this share of the outline is seen.
constexpr double FewestWidths = 0.4;
/// Neighbours along the outline whose references are averaged, to either side, where they differ by less than this share of the
/// contrast.
constexpr int NeighboursToEitherSide = 4;
constexpr float AlikeShare = 0.25F;

/// The expected outline is rough: the edge is near the steepest fall, and the references move with it.
OutlineEdges findRoughly(const EdgeProfiles& profiles, double reachPx, std::vector<double>& blurs)
{
  OutlineEdges result;
  for (std::size_t i = 0; i < profiles.count(); ++i)
  {
    EdgeStep step;
    bool isFound = profiles.isUsable(i);
    step.place = isFound ? profiles.steepest(i) : 0;
    double contrast = 0;
    for (int round = 0; round < 2 && isFound; ++round)
    {
      const EdgeSides sides = profiles.sides(i, step.place);
      contrast = double(sides.contrast());
      isFound = sides.isEdge() && profiles.byArea(i, sides, step.place, step) && std::abs(step.place) <= reachPx;
    }
    if (isFound)
    {
      result.edges.push_back({ i, step.place, contrast, 0 });
      blurs.push_back(step.blur);
    }
  }
  return result;
}

/// References of their own are noisy: each is averaged with those beside it that are alike.
std::vector<EdgeSides> smooth(const std::vector<EdgeSides>& own, const std::vector<char>& isGood)
{
  std::vector<EdgeSides> smoothed = own;
  const int count = int(own.size());
  for (int i = 0; i < count; ++i)
  {
    const EdgeSides& centre = own[std::size_t(i)];
    const float alike = AlikeShare * centre.contrast();
    EdgeSides sum;
    float inside = 0, outside = 0;
    for (int k = -NeighboursToEitherSide; k <= NeighboursToEitherSide && isGood[std::size_t(i)]; ++k)
    {
      const auto j = std::size_t((i + k + count) % count);
      const bool isInsideAlike = isGood[j] && (own[j].inside - centre.inside).norm() < alike;
      const bool isOutsideAlike = isGood[j] && (own[j].outside - centre.outside).norm() < alike;
      if (isInsideAlike)
      {
        sum.inside += own[j].inside;
        sum.insideChange += own[j].insideChange;
        ++inside;
      }
      if (isOutsideAlike)
      {
        sum.outside += own[j].outside;
        sum.outsideChange += own[j].outsideChange;
        ++outside;
      }
    }
    if (inside > 0 && outside > 0)
    {
      smoothed[std::size_t(i)] = { sum.inside / inside, sum.outside / outside, sum.insideChange / inside,
        sum.outsideChange / outside };
    }
  }
  return smoothed;
}

/// The expected outline is good to a pixel and the blur is known: the light is compared on either side of the outline itself,
/// so that
/// a shadow on the ball does not draw the edge inwards.
OutlineEdges findFinely(const EdgeProfiles& profiles, const OutlineSearch& search, double referencePx, std::vector<double>& blurs)
{
  std::vector<EdgeSides> own(profiles.count());
  std::vector<char> isGood(profiles.count());
  for (std::size_t i = 0; i < profiles.count(); ++i)
  {
    if (profiles.isUsable(i))
    {
      own[i] = profiles.sides(i, 0);
      isGood[i] = own[i].isEdge();
    }
  }
  std::vector<EdgeSides> sides = smooth(own, isGood);
  // The references lie in the tails of the blurred step: what is left of the other side in them is taken out.
  const double tail = Bell::at(
    -std::min((referencePx + EdgeProfiles::StretchPx / 2) / std::max(search.blurPx, EdgeProfiles::SharpestPx), Bell::Reach))
                        .integral;
  for (EdgeSides& each : sides)
  {
    const Eigen::Vector3f missing = float(tail / (1 - 2 * tail)) * (each.inside - each.outside);
    each.inside += missing;
    each.outside -= missing;
  }
  OutlineEdges result;
  for (std::size_t i = 0; i < profiles.count(); ++i)
  {
    EdgeStep step;
    if (isGood[i] && profiles.byArea(i, sides[i], 0, step) && profiles.byMatching(i, sides[i], search.blurPx, step.place) &&
      std::abs(step.place) <= search.reachPx)
    {
      result.edges.push_back({ i, step.place, double(sides[i].contrast()), profiles.shadingPx(sides[i], search.blurPx) });
      blurs.push_back(step.blur);
    }
  }
  return result;
}

}  // namespace

OutlineEdges findOutlineEdges(const LinearLightImage& image, const SphereCone::Outline& expected, const OutlineSearch& search)
{
  const bool isRough = !(search.blurPx > 0);
  const double blur = isRough ? UnknownBlurPx : search.blurPx;
  const double reference =
    std::min(std::clamp(BlursToReference * blur, NearestReferencePx, FurthestReferencePx), 0.4 * search.radiusPx);
  const double reach = std::min(search.reachPx, 0.6 * search.radiusPx);
  // Light is compared about the edge where that is not known, else about the outline; the step that is fitted has tails.
  const double compared = reference + 2 * EdgeProfiles::StretchPx;
  const double extent =
    isRough ? reach + compared : std::max(compared, reach + EdgeProfiles::BlursOfTail * std::max(blur, EdgeProfiles::SharpestPx));
  const EdgeProfiles profiles(
    image, expected, { reach, reference, extent, isRough ? CoarseStepPx : FineStepPx, isRough ? ShadingRough : ShadingInside });
  std::vector<double> blurs;
  OutlineEdges result = isRough ? findRoughly(profiles, reach, blurs) : findFinely(profiles, search, reference, blurs);
  result.blurPx = blurs.empty() ? 0 : median(blurs);
  return result;
}

EdgeWidths measureEdgeWidths(const LinearLightImage& image, const SphereCone::Outline& outline, double radiusPx)
{
  const double reference = std::min(WidthReferencePx, 0.4 * radiusPx);
  const EdgeProfiles profiles(
    image, outline, { 0, reference, reference + 2 * EdgeProfiles::StretchPx, CoarseStepPx, ShadingRough });
  using Waves = Eigen::Matrix<double, 5, 1>;
  Eigen::Matrix<double, 5, 5> matrix = Eigen::Matrix<double, 5, 5>::Zero();
  Waves right = Waves::Zero();
  std::vector<double> widths;
  for (std::size_t i = 0; i < profiles.count(); ++i)
  {
    double width = 0;
    if (profiles.isUsable(i) && profiles.width(i, width))
    {
      const double turn = outline.turns[i];
      Waves waves;
      waves << 1, std::cos(turn), std::sin(turn), std::cos(2 * turn), std::sin(2 * turn);
      matrix += waves * waves.transpose();
      right += width * waves;
      widths.push_back(width);
    }
  }
  EdgeWidths result;
  if (!widths.empty())
  {
    std::nth_element(widths.begin(), widths.begin() + std::ptrdiff_t(widths.size() / 4), widths.end());
    result.narrowPx = widths[widths.size() / 4];
  }
  if (double(widths.size()) >= FewestWidths * double(profiles.count()))
  {
    const Waves sizes = matrix.ldlt().solve(right);
    result.twoSidedPx = sizes.tail<2>().norm() > sizes.segment<2>(1).norm() ? sizes.tail<2>().norm() : 0;
  }
  return result;
}

}  // namespace handeye
