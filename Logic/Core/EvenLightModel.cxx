// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EvenLightModel.h"

#include "EdgeProfiles.h"

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

/// The stretches that the light on either side is averaged over start this many blurs from the outline, and are so wide (px).
constexpr double BlursToStretch = 2.5;
constexpr double StretchPx = 4;
/// Deeper inside than this share of the radius there is no outline.
constexpr double DeepestShare = 0.9;
constexpr double ShallowShare = 0.6;
constexpr double ShallowestPx = 1;
/// The edge of what hides is straight for so many px to either side; and normals so many px from where the outline goes under may have
/// pixels that it crosses.
constexpr double StraightPx = 7;
constexpr double CrossedPx = 16;
/// Steps that are taken at once: of the blur (its share), of a hiding edge (px, rad).
constexpr double LargestBlurRatio = 1.4;
constexpr double LargestOffsetPx = 1;
constexpr double LargestTurn = 0.3;

/// Of normals: no hiding edge is near; something hides the outline there.
constexpr int Free = -1;
constexpr int Hidden = -2;

Bell::Value bellAt(double x)
{
  const Bell::Value value = Bell::at(std::clamp(x, -Bell::Reach, Bell::Reach));
  return { value.integral, std::abs(x) < Bell::Reach ? value.density : 0 };
}

}  // namespace

EvenLightModel::EvenLightModel(const SphereCone::Outline& outline, double radiusPx, double blurPx)
  : outline_(outline)
  , nearPx_(BlursToStretch * blurPx)
  , deepestPx_(std::min(nearPx_ + StretchPx, DeepestShare * radiusPx))
  , radiusPx_(radiusPx)
  , spacingPx_(2 * double(EIGEN_PI) * radiusPx / double(outline.points_Image.size()))
  , blurPx_(blurPx)
  , inside_(outline.points_Image.size())
  , outside_(outline.points_Image.size())
  , edgeOf_(outline.points_Image.size(), Free)
{
}

double EvenLightModel::shallowPx() const
{
  return std::min(deepestPx_, std::max(nearPx_ + ShallowestPx, ShallowShare * radiusPx_));
}

double EvenLightModel::furthestPx() const
{
  return nearPx_ + StretchPx;
}

void EvenLightModel::place(const Eigen::Vector3d& step, double blurPx, const std::vector<HidingEdge>& edges)
{
  step_ = step;
  blurPx_ = blurPx;
  edges_ = edges;
  assignEdges();
}

void EvenLightModel::move(const Vector& by)
{
  step_ += by.head<3>();
  blurPx_ = std::clamp(blurPx_ + by[3], blurPx_ / LargestBlurRatio, LargestBlurRatio * blurPx_);
  for (std::size_t i = 0; i < edges_.size(); ++i)
  {
    const auto first = Eigen::Index(OfOutline + OfEdge * i);
    edges_[i].move(std::clamp(by[first], -LargestOffsetPx, LargestOffsetPx), std::clamp(by[first + 1], -LargestTurn, LargestTurn));
  }
}

void EvenLightModel::assignEdges()
{
  const int count = int(edgeOf_.size()), reach = int(std::lround(CrossedPx / spacingPx_));
  std::fill(edgeOf_.begin(), edgeOf_.end(), Free);
  std::vector<int> apart(edgeOf_.size(), count);
  for (std::size_t e = 0; e < edges_.size(); ++e)
  {
    const HidingEdge& edge = edges_[e];
    for (int k = -reach; k <= int(edge.hiddenCount); ++k)
    {
      const int place = int(edge.corner) + edge.towardsHidden * k;
      const auto i = std::size_t((place % count + count) % count);
      if (std::abs(k) < apart[i])
      {
        apart[i] = std::abs(k);
        edgeOf_[i] = k <= reach ? int(e) : Hidden;
      }
    }
  }
}

EvenLightModel::Hiding EvenLightModel::hidingOf(const OutlinePixel& pixel) const
{
  const int index = edgeOf_[pixel.index];
  if (index < 0)
  {
    return { index == Free, -1, 0 };
  }
  const HidingEdge& edge = edges_[std::size_t(index)];
  const Eigen::Vector2d place = pixel.place_Image.cast<double>();
  const double beyondPx = edge.beyondPx(place);
  if (beyondPx < -Bell::Reach * blurPx_)
  {
    return {};
  }
  const bool isModelled = (place - edge.pivot_Image).squaredNorm() <= StraightPx * StraightPx && beyondPx <= Bell::Reach * blurPx_;
  return { isModelled, isModelled ? index : -1, beyondPx };
}

bool EvenLightModel::isHidden(std::size_t normal) const
{
  const int index = edgeOf_[normal];
  return index == Hidden || (index != Free && edges_[std::size_t(index)].beyondPx(outline_.points_Image[normal]) > 0);
}

void EvenLightModel::collect(const std::vector<OutlinePixel>& pixels, double deepestPx)
{
  inside_.clear();
  outside_.clear();
  for (const OutlinePixel& pixel : pixels)
  {
    const double offset = double(pixel.offsetPx) - shift(pixel.index);
    if (std::abs(offset) <= nearPx_)
    {
      continue;
    }
    const Hiding hiding = hidingOf(pixel);
    if (!hiding.isCounted || (hiding.edge >= 0 && hiding.beyondPx > -nearPx_))
    {
      continue;
    }
    if (offset < 0)
    {
      if (offset >= -deepestPx)
      {
        inside_.add(pixel.index, offset > -(nearPx_ + deepestPx) / 2, pixel.light);
      }
    }
    else
    {
      outside_.add(pixel.index, offset < nearPx_ + StretchPx / 2, pixel.light);
    }
  }
}

void EvenLightModel::average(const std::vector<char>& isGood)
{
  inside_.average(isGood);
  outside_.average(isGood);
}

void EvenLightModel::gather(float noiseVariance, const std::vector<char>& isGood)
{
  inside_.gather(noiseVariance, isGood);
  outside_.gather(noiseVariance, isGood);
}

double EvenLightModel::change() const
{
  return std::max(inside_.change(), outside_.change());
}

PixelDifference EvenLightModel::differenceOf(const OutlinePixel& pixel) const
{
  PixelDifference result;
  const Hiding hiding = hidingOf(pixel);
  if (!hiding.isCounted || !inside_.isKnown(pixel.index) || !outside_.isKnown(pixel.index))
  {
    return result;
  }
  result.isCounted = true;
  result.inside = (shift(pixel.index) - double(pixel.offsetPx)) / blurPx_;
  result.edge = hiding.edge;
  if (hiding.edge < 0)
  {
    compareWithTwo(pixel, result);
  }
  else
  {
    result.seen = -hiding.beyondPx / blurPx_;
    compareWithThree(pixel, result);
  }
  return result;
}

void EvenLightModel::compareWithTwo(const OutlinePixel& pixel, PixelDifference& result) const
{
  const std::size_t i = pixel.index;
  const Eigen::Vector3f across = inside_.level(i) - outside_.level(i);
  const Bell::Value bell = bellAt(result.inside);
  const float share = float(bell.integral);
  const Eigen::Array3f noise = (outside_.variance(i) + share * (inside_.variance(i) - outside_.variance(i))).array().rsqrt();
  result.difference = ((pixel.light - outside_.level(i) - share * across).array() * noise).matrix();
  result.byInside = (float(bell.density) * across.array() * noise).matrix();
}

void EvenLightModel::compareWithThree(const OutlinePixel& pixel, PixelDifference& result) const
{
  const std::size_t i = pixel.index;
  const HidingEdge& edge = edges_[std::size_t(result.edge)];
  result.turnRate = edge.turnRate(pixel.place_Image.cast<double>());
  const Bell::Value bell = bellAt(result.seen);
  const WedgeShare ball = shareOfWedge(result.inside, result.seen, outline_.normals_Image[i].dot(edge.normal_Image));
  const float seen = float(bell.integral), share = float(ball.share);
  const Eigen::Vector3f across = inside_.level(i) - outside_.level(i), behind = outside_.level(i) - edge.light;
  const Eigen::Vector3f variance =
    edge.variance + seen * (outside_.variance(i) - edge.variance) + share * (inside_.variance(i) - outside_.variance(i));
  const Eigen::Array3f noise = variance.array().rsqrt();
  result.difference = ((pixel.light - edge.light - seen * behind - share * across).array() * noise).matrix();
  result.byInside = (float(ball.byInside) * across.array() * noise).matrix();
  result.bySeen = ((float(bell.density) * behind + float(ball.bySeen) * across).array() * noise).matrix();
}

void EvenLightModel::add(
  const OutlinePixel& pixel, const PixelDifference& difference, double weight, Matrix& information, Vector& right) const
{
  Eigen::Vector4d ofInside;
  ofInside << outline_.rates[pixel.index], -difference.inside;
  ofInside /= blurPx_;
  information.topLeftCorner<4, 4>() += weight * double(difference.byInside.squaredNorm()) * ofInside * ofInside.transpose();
  right.head<4>() += weight * double(difference.byInside.dot(difference.difference)) * ofInside;
  if (difference.edge < 0)
  {
    return;
  }
  const auto first = Eigen::Index(OfOutline + OfEdge * difference.edge);
  Vector ofSeen = Vector::Zero(information.rows()), ofInsideToo = Vector::Zero(information.rows());
  ofInsideToo.head<4>() = ofInside;
  ofSeen[3] = -difference.seen / blurPx_;
  ofSeen[first] = 1 / blurPx_;
  ofSeen[first + 1] = -difference.turnRate / blurPx_;
  const double both = weight * double(difference.byInside.dot(difference.bySeen));
  information += both * (ofInsideToo * ofSeen.transpose() + ofSeen * ofInsideToo.transpose());
  information += weight * double(difference.bySeen.squaredNorm()) * ofSeen * ofSeen.transpose();
  right += weight * double(difference.bySeen.dot(difference.difference)) * ofSeen;
}

}  // namespace handeye
