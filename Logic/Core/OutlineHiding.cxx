// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OutlineHiding.h"

#include "EdgeProfiles.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

namespace handeye
{

namespace
{

constexpr double Pi = double(EIGEN_PI);
/// What hides covers at least so much of the outline, px; less that is seen in between does not count.
constexpr double ShortestHiddenPx = 4;
constexpr double ShortestSeenPx = 3;
constexpr std::size_t MostEdges = 4;
/// Its light is taken from so many px of the outline, and not from closer to where the outline seems to go under than this, if there is
/// so much.
constexpr double LightStretchPx = 12;
constexpr double LightAwayPx = 10;
/// That light scatters by no more than this, in units of the noise's variance, or of the least noise.
constexpr float LargestScatter = 4;
constexpr float LeastNoise = 2 / 255.0F;
/// Lights are told apart by squares of their difference of at least so many variances of the noise, or of the least noise.
constexpr float Distinct = 36;
/// To either side along the outline whose pixels say together whether they are hidden, px.
constexpr double AlongPx = 2;
/// How far back along the outline, from where it seems to go under, the edge is looked for, px.
constexpr double BackPx = 8;
/// Normals closer to each other than this are not told apart.
constexpr double LargestCosine = 0.97;

/// Points of an outline, all around.
class Round
{
public:
  explicit Round(std::size_t count)
    : count_(int(count))
  {
  }
  std::size_t operator()(int i) const { return std::size_t(((i % count_) + count_) % count_); }
  int count() const { return count_; }

private:
  int count_;
};

/// Looks for the edges at both ends of what is hidden.
class Finder
{
public:
  explicit Finder(const HidingSearch& search)
    : search_(search)
    , at_(search.outline.points_Image.size())
    , noise_(std::max(search.noiseVariance, LeastNoise * LeastNoise))
    , pixelsOf_(search.outline.points_Image.size())
  {
    for (const OutlinePixel& pixel : search.pixels)
    {
      pixelsOf_[pixel.index].push_back(&pixel);
    }
    double length = 0;
    for (int i = 0; i < at_.count(); ++i)
    {
      length += (point(i + 1) - point(i)).norm();
    }
    spacingPx_ = length / at_.count();
  }

  std::vector<HidingEdge> find() const
  {
    std::vector<char> isHidden(search_.isEdge.size());
    std::transform(search_.isEdge.begin(), search_.isEdge.end(), isHidden.begin(), [](char edge) { return char(edge == 0); });
    for (const OutlineRun& seen : runsOf(search_.isEdge))
    {
      for (int i = 0; seen.count * spacingPx_ < ShortestSeenPx && i < seen.count; ++i)
      {
        isHidden[at_(seen.first + i)] = 1;
      }
    }
    std::vector<HidingEdge> edges;
    for (const OutlineRun& run : runsOf(isHidden))
    {
      if (run.count * spacingPx_ < ShortestHiddenPx)
      {
        continue;
      }
      for (const auto& [end, direction] : { std::pair(run.first, 1), std::pair(run.first + run.count - 1, -1) })
      {
        const std::optional<HidingEdge> edge = findAt(end, direction, run.count / 2);
        if (edge && edges.size() < MostEdges)
        {
          edges.push_back(*edge);
        }
      }
    }
    return edges;
  }

private:
  const Eigen::Vector2d& point(int i) const { return search_.outline.points_Image[at_(i)]; }
  const Eigen::Vector2d& normal(int i) const { return search_.outline.normals_Image[at_(i)]; }
  int points(double px) const { return int(std::lround(px / spacingPx_)); }

  /// @param end the first point that seems to be hidden, those in the `direction` follow, `half` to their middle
  std::optional<HidingEdge> findAt(int end, int direction, int half) const
  {
    HidingEdge edge;
    edge.towardsHidden = direction;
    const int away = std::min(half / 2, points(LightAwayPx)), middle = std::min(half, away + points(LightStretchPx));
    if (!lightOf(end, direction, away, middle, edge))
    {
      return std::nullopt;
    }
    const std::optional<Crossing> inside = crossing(end, direction, middle, -1, search_.inside, edge);
    const std::optional<Crossing> outside = crossing(end, direction, middle, 1, search_.outside, edge);
    if (!inside && !outside)
    {
      return std::nullopt;
    }
    // The edge goes through both crossings; where there is only one, across the outline.
    const Crossing& one = inside ? *inside : *outside;
    const Crossing& other = outside ? *outside : *inside;
    const double corner = (one.index + other.index) / 2;
    const int nearest = int(std::lround(corner));
    const Eigen::Vector2d along = inside && outside ? Eigen::Vector2d(other.place_Image - one.place_Image) : normal(nearest);
    edge.corner = at_(nearest);
    edge.hiddenCount = std::size_t(std::max(0, direction * (end - nearest) + half));
    edge.pivot_Image = point(nearest);
    edge.normal_Image = Eigen::Vector2d(along.y(), -along.x()).normalized();
    const Eigen::Vector2d deeper = point(nearest + direction) - point(nearest);
    if (edge.normal_Image.dot(deeper) < 0)
    {
      edge.normal_Image = -edge.normal_Image;
    }
    edge.offsetPx = edge.normal_Image.dot((one.place_Image + other.place_Image) / 2 - edge.pivot_Image);
    return edge;
  }

  /// The light outside of the outline where it is hidden for certain.
  bool lightOf(int end, int direction, int away, int middle, HidingEdge& edge) const
  {
    LightSum sum;
    Eigen::Vector3f squares = Eigen::Vector3f::Zero();
    for (int k = away; k <= middle; ++k)
    {
      for (const OutlinePixel* pixel : pixelsOf_[at_(end + direction * k)])
      {
        if (double(pixel->offsetPx) > search_.nearPx)
        {
          sum.add(pixel->light);
          squares += pixel->light.cwiseAbs2();
        }
      }
    }
    if (sum.count < 4)
    {
      return false;
    }
    edge.light = sum.mean();
    edge.variance = lightVariance(edge.light);
    const Eigen::Vector3f scatter = squares / sum.count - edge.light.cwiseAbs2();
    return scatter.cwiseQuotient(edge.variance).sum() / 3 <= LargestScatter * noise_;
  }

  struct Crossing
  {
    double index;
    Eigen::Vector2d place_Image;
  };

  /// Where on one side of the outline (-1 inside, 1 outside) what hides ends.
  std::optional<Crossing> crossing(
    int end, int direction, int middle, int side, const OutlineSide& seen, const HidingEdge& edge) const
  {
    const int reach = points(AlongPx);
    bool isHidden = false;
    for (int k = middle; k >= -points(BackPx); --k)
    {
      const int centre = end + direction * k;
      double share = 0, count = 0, offset = 0;
      for (int i = centre - reach; i <= centre + reach; ++i)
      {
        const Eigen::Vector3f& light = seen.level(at_(i));
        const Eigen::Vector3f across = edge.light - light;
        const Eigen::Vector3f weighted = across.cwiseQuotient(edge.variance);
        if (!seen.isKnown(at_(i)) || across.dot(weighted) < Distinct * noise_)
        {
          continue;
        }
        for (const OutlinePixel* pixel : pixelsOf_[at_(i)])
        {
          if (side * double(pixel->offsetPx) > search_.nearPx)
          {
            share += double((pixel->light - light).dot(weighted) / across.dot(weighted));
            offset += double(pixel->offsetPx);
            ++count;
          }
        }
      }
      if (count == 0)
      {
        continue;
      }
      if (share < 0.5 * count)
      {
        return isHidden ? std::optional(Crossing{ double(centre), point(centre) + offset / count * normal(centre) }) : std::nullopt;
      }
      isHidden = true;
    }
    return std::nullopt;
  }

  const HidingSearch& search_;
  Round at_;
  float noise_;
  std::vector<std::vector<const OutlinePixel*>> pixelsOf_;
  double spacingPx_ = 1;
};

/// Nodes and weights of Gauss and Legendre's rule with ten points on (0, 1), the first half; the others are symmetric.
constexpr double Nodes[] = { 0.013046735741414, 0.067468316655507, 0.160295215850488, 0.283302302935376, 0.425562830509184 };
constexpr double Weights[] = { 0.033335672154344, 0.074725674575290, 0.109543181257991, 0.134633359654998, 0.147762112357376 };

}  // namespace

void HidingEdge::move(double offset, double turn)
{
  offsetPx += offset;
  const Eigen::Vector2d tangent_Image(-normal_Image.y(), normal_Image.x());
  normal_Image = (normal_Image + turn * tangent_Image).normalized();
}

std::vector<HidingEdge> findHidingEdges(const HidingSearch& search)
{
  return Finder(search).find();
}

WedgeShare shareOfWedge(double inside, double seen, double cosine)
{
  const double h = std::clamp(inside, -Bell::Reach, Bell::Reach), k = std::clamp(seen, -Bell::Reach, Bell::Reach);
  const double correlation = std::clamp(cosine, -LargestCosine, LargestCosine);
  const Bell::Value ofInside = Bell::at(h), ofSeen = Bell::at(k);
  // Plackett's: the derivative by the correlation is the bivariate density; the sine takes the root out of it (Drezner and Wesolowsky,
  // 1990).
  const double angle = std::asin(correlation);
  double sum = 0;
  for (std::size_t i = 0; i < std::size(Nodes); ++i)
  {
    for (const double node : { Nodes[i], 1 - Nodes[i] })
    {
      const double sine = std::sin(angle * node);
      sum += Weights[i] * std::exp(-(h * h + k * k - 2 * h * k * sine) / (2 * (1 - sine * sine)));
    }
  }
  const double root = std::sqrt(1 - correlation * correlation);
  const auto integral = [](double x) { return Bell::at(std::clamp(x, -Bell::Reach, Bell::Reach)).integral; };
  return { ofInside.integral * ofSeen.integral + angle * sum / (2 * Pi), ofInside.density * integral((k - correlation * h) / root),
    ofSeen.density * integral((h - correlation * k) / root) };
}

}  // namespace handeye
