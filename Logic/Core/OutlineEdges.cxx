// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OutlineEdges.h"

#include "Statistics.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace handeye
{

namespace
{

constexpr double Pi = double(EIGEN_PI);
constexpr double CoarseStepPx = 0.5;
constexpr double FineStepPx = 0.25;
/// Least contrast (linear light) of an edge, in an image that is well lit: where the brighter side has WellLit. Less in the dark.
constexpr double MinimumContrast = 0.08;
constexpr double WellLit = 0.25;
/// How much the light varies: by noise (of full light), and along its own colour by shading (of itself). As long as the outline is not
/// known the light that shading takes away towards the limb must not be taken for it: there it is the colour that counts.
constexpr float LightNoise = 0.02F;
constexpr float ShadingRough = 1.0F;
constexpr float ShadingInside = 0.1F;
constexpr float ShadingOutside = 0.1F;
/// Width of the stretch inside and outside over which the light on either side is averaged.
constexpr double ReferencePx = 1.5;
/// The references start this many blurs from the edge, but not closer than NearestReferencePx.
constexpr double BlursToReference = 1.25;
constexpr double NearestReferencePx = 1.5;
constexpr double FurthestReferencePx = 5;
/// An edge this far (px) from the expected outline counts half.
constexpr double NearEnoughPx = 8;
constexpr double UnknownBlurPx = 1.0;
/// How far from the outline the light is that an edge's width is measured between.
constexpr double WidthReferencePx = 7;
/// Waves of the width are told apart where this share of the outline is seen.
constexpr double FewestWidths = 0.4;
/// Neighbours along the outline whose references are averaged, to either side, where they differ by less than this share of the
/// contrast.
constexpr int NeighboursToEitherSide = 4;
constexpr float AlikeShare = 0.25F;
/// The blurred step that is fitted is never sharper than this (px): bilinear sampling alone blurs that much.
constexpr double SharpestPx = 0.35;
/// Light above this is clipped, and nobody knows by how much: so much of the step may be missing.
constexpr float ClippedLight = 0.97F;
constexpr double ClippedLevel = 0.2;
/// Even without light there is noise, as much as this light makes.
constexpr float DarkLight = 0.05F;
constexpr int MatchingRounds = 3;

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
      table_[std::size_t(i)] = { 0.5 * std::erfc(-x / std::sqrt(2.0)), std::exp(-x * x / 2) / std::sqrt(2 * Pi) };
    }
  }

  std::array<Value, Steps + 1> table_;
};

/// The light on either side of the edge.
struct Sides
{
  Eigen::Vector3f inside = Eigen::Vector3f::Zero();
  Eigen::Vector3f outside = Eigen::Vector3f::Zero();
  Eigen::Vector3f insideChange = Eigen::Vector3f::Zero();   ///< from further in to `inside`
  Eigen::Vector3f outsideChange = Eigen::Vector3f::Zero();  ///< from further out to `outside`

  float contrast() const { return (inside - outside).norm(); }
  bool isEdge() const
  {
    const double brighter = double(std::max(inside.norm(), outside.norm()));
    return double(contrast()) >= MinimumContrast * std::min(1.0, brighter / WellLit);
  }

  /// The direction of colour along which inside and outside are told apart, scaled so that they are 1 apart: Fisher's discriminant
  /// for light that varies by noise and, on either side, along its own colour by shading. A ball that darkens towards its limb
  /// keeps its colour; so where the background differs in colour its brightness hardly counts, and where it does not, brightness is
  /// what there is.
  Eigen::Vector3f discriminant(float shadingInside) const
  {
    const Eigen::Matrix3f variation = LightNoise * LightNoise * Eigen::Matrix3f::Identity() +
      shadingInside * shadingInside * inside * inside.transpose() + ShadingOutside * ShadingOutside * outside * outside.transpose();
    const Eigen::Vector3f across = inside - outside;
    const Eigen::Vector3f direction = variation.inverse() * across;
    return direction / direction.dot(across);
  }
};

/// Where the step of a profile is, and how wide.
struct Step
{
  double place = 0;
  double blur = 0;
};

/// The light along the normals of an outline.
class Profiles
{
public:
  Profiles(const LinearLightImage& image, const SphereCone::Outline& outline, double reachPx, double referencePx, double stepPx,
    float shading)
    : step_(stepPx)
    , shading_(shading)
    , reach_(reachPx)
    , reference_(referencePx)
    , half_(int(std::ceil((reachPx + referencePx + 2 * ReferencePx) / stepPx)))
    , isUsable_(outline.points_Image.size())
    , light_(outline.points_Image.size() * std::size_t(2 * half_ + 1))
  {
    for (std::size_t i = 0; i < isUsable_.size(); ++i)
    {
      const Eigen::Vector2d &point = outline.points_Image[i], along = stepPx * outline.normals_Image[i];
      isUsable_[i] = image.inside(point + half_ * along) && image.inside(point - half_ * along);
      for (int k = -half_; k <= half_ && isUsable_[i]; ++k)
      {
        const Eigen::Vector2d at = point + k * along;
        light(i)[k + half_] = image.at(at.x(), at.y());
      }
    }
  }

  std::size_t count() const { return isUsable_.size(); }
  bool isUsable(std::size_t i) const { return isUsable_[i]; }

  /// Where the light changes most; changes along the ball's own colour count less, and so do changes further away: a highlight has a rim,
  /// too.
  double steepest(std::size_t i) const
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

  /// The light on either side of a place.
  Sides sides(std::size_t i, double centre) const
  {
    const double far = reference_ + ReferencePx, furthest = far + ReferencePx;
    Sides sides;
    sides.inside = mean(i, centre - far, centre - reference_);
    sides.outside = mean(i, centre + reference_, centre + far);
    sides.insideChange = sides.inside - mean(i, centre - furthest, centre - far);
    sides.outsideChange = sides.outside - mean(i, centre + far, centre + furthest);
    return sides;
  }

  /// The step by the area under the profile, which uses every sample; false unless the profile falls once.
  bool byArea(std::size_t i, const Sides& sides, double centre, Step& found) const
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

  /// The blurred step that fits the profile best, every sample by its noise: encoded light is noisier where it is brighter.
  bool byMatching(std::size_t i, const Sides& sides, double blurPx, double& place) const
  {
    const Eigen::Vector3f direction = sides.discriminant(shading_);
    const float offset = sides.outside.dot(direction);
    const double blur = std::max(blurPx, SharpestPx), start = place;
    const double inside = noiseVariance(sides.inside, direction), outside = noiseVariance(sides.outside, direction);
    for (int round = 0; round < MatchingRounds; ++round)
    {
      const int first = index((place - 3 * blur) / step_), last = index((place + 3 * blur) / step_);
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

  /// Of the level along a direction, up to a factor: a gamma near 2 makes the noise of encoded light grow with the root of the light.
  static double noiseVariance(const Eigen::Vector3f& light, const Eigen::Vector3f& direction)
  {
    return double((direction.cwiseAbs2().array() * (light.array().max(0) + DarkLight)).sum());
  }

  /// How far apart (px) the places nearest to the outline are where the light has fallen to three quarters and to a quarter; false where
  /// there are none.
  bool width(std::size_t i, double& widthPx) const
  {
    const Sides both = sides(i, 0);
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

  /// The place that is found moves by this much per level that a side is wrong by; and a side is wrong by what it changes on the way to
  /// the edge, and by what was clipped.
  double shadingPx(const Sides& sides, double blurPx) const
  {
    const Eigen::Vector3f direction = sides.discriminant(shading_);
    const bool isClipped = std::max(sides.inside.maxCoeff(), sides.outside.maxCoeff()) > ClippedLight;
    const double wrong = std::hypot(double(sides.insideChange.dot(direction)), double(sides.outsideChange.dot(direction))) +
      (isClipped ? ClippedLevel : 0);
    return std::sqrt(Pi) * std::max(blurPx, SharpestPx) * wrong;
  }

private:
  int index(double steps) const { return std::clamp(int(std::lround(steps)) + half_, 0, 2 * half_); }
  Eigen::Vector3f* light(std::size_t i) { return light_.data() + i * std::size_t(2 * half_ + 1); }
  const Eigen::Vector3f* light(std::size_t i) const { return light_.data() + i * std::size_t(2 * half_ + 1); }

  Eigen::Vector3f mean(std::size_t i, double from, double to) const
  {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    const int first = index(from / step_), last = index(to / step_);
    for (int k = first; k <= last; ++k)
    {
      sum += light(i)[k];
    }
    return sum / float(last - first + 1);
  }

  double step_;
  float shading_;
  double reach_;
  double reference_;
  int half_;
  std::vector<char> isUsable_;
  std::vector<Eigen::Vector3f> light_;
};

/// The expected outline is rough: the edge is near the steepest fall, and the references move with it.
OutlineEdges findRoughly(const Profiles& profiles, double reachPx, std::vector<double>& blurs)
{
  OutlineEdges result;
  for (std::size_t i = 0; i < profiles.count(); ++i)
  {
    Step step;
    bool isFound = profiles.isUsable(i);
    step.place = isFound ? profiles.steepest(i) : 0;
    double contrast = 0;
    for (int round = 0; round < 2 && isFound; ++round)
    {
      const Sides sides = profiles.sides(i, step.place);
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
std::vector<Sides> smooth(const std::vector<Sides>& own, const std::vector<char>& isGood)
{
  std::vector<Sides> smoothed = own;
  const int count = int(own.size());
  for (int i = 0; i < count; ++i)
  {
    const Sides& centre = own[std::size_t(i)];
    const float alike = AlikeShare * centre.contrast();
    Sides sum;
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

/// The expected outline is good to a pixel and the blur is known: the light is compared on either side of the outline itself, so that
/// a shadow on the ball does not draw the edge inwards.
OutlineEdges findFinely(const Profiles& profiles, const OutlineSearch& search, double referencePx, std::vector<double>& blurs)
{
  std::vector<Sides> own(profiles.count());
  std::vector<char> isGood(profiles.count());
  for (std::size_t i = 0; i < profiles.count(); ++i)
  {
    if (profiles.isUsable(i))
    {
      own[i] = profiles.sides(i, 0);
      isGood[i] = own[i].isEdge();
    }
  }
  std::vector<Sides> sides = smooth(own, isGood);
  // The references lie in the tails of the blurred step: what is left of the other side in them is taken out.
  const double tail =
    Bell::at(-std::min((referencePx + ReferencePx / 2) / std::max(search.blurPx, SharpestPx), Bell::Reach)).integral;
  for (Sides& each : sides)
  {
    const Eigen::Vector3f missing = float(tail / (1 - 2 * tail)) * (each.inside - each.outside);
    each.inside += missing;
    each.outside -= missing;
  }
  OutlineEdges result;
  for (std::size_t i = 0; i < profiles.count(); ++i)
  {
    Step step;
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
  const Profiles profiles(
    image, expected, reach, reference, isRough ? CoarseStepPx : FineStepPx, isRough ? ShadingRough : ShadingInside);
  std::vector<double> blurs;
  OutlineEdges result = isRough ? findRoughly(profiles, reach, blurs) : findFinely(profiles, search, reference, blurs);
  result.blurPx = blurs.empty() ? 0 : median(blurs);
  return result;
}

EdgeWidths measureEdgeWidths(const LinearLightImage& image, const SphereCone::Outline& outline, double radiusPx)
{
  const double reference = std::min(WidthReferencePx, 0.4 * radiusPx);
  const Profiles profiles(image, outline, 0, reference, CoarseStepPx, ShadingRough);
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
