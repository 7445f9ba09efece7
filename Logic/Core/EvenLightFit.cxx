// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EvenLightFit.h"

#include "EdgeProfiles.h"
#include "OutlinePixels.h"
#include "OutlineSide.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace handeye
{

namespace
{

/// The stretches that the light on either side is averaged over start this many blurs from the outline, and are so wide (px).
constexpr double BlursToStretch = 3;
constexpr double StretchPx = 4;
/// Deeper inside than this share of the radius there is no outline.
constexpr double DeepestShare = 0.9;
/// Pixels so many blurs from the edge say whether it is one; pixels so many blurs from it have a say in where it is.
constexpr float BlursOfEdge = 2.5F;
constexpr float BlursThatCount = 3;
constexpr std::size_t FewestNormals = 12;
constexpr int Rounds = 4;
/// Squares of differences in units of the noise' variance: of normals that have what the model says, all across and near the
/// edge, and
/// of a pixel that counts.
constexpr float LargestOfNormal = 2;
constexpr float LargestOfEdge = 4;
constexpr float LargestOfPixel = 36;
/// Normals beside such a one are left out, too.
constexpr int BesideWrong = 1;
/// At least so many of the normals that there is light for have what the model says.
constexpr double CleanShare = 0.3;
/// Of the change of the light between the nearer and the further half of a stretch.
constexpr float LargestChange = 3;
/// A larger scatter (of full light's encoded value) is not the noise of a camera alone.
constexpr float LargestNoise = 4 / 255.0F;
/// The light is not even where fewer normals than this share of those with a right edge have what the model says.
constexpr double LeastGood = 0.7;
/// A fit that ends further than this from where it started has followed something else.
constexpr double LargestMovePx = 1;

/// The fit to the pixels, round by round.
class EvenLightFitter
{
public:
  EvenLightFitter(const LinearLightImage& light, const SphereCone::Outline& outline, const EvenLightStart& start)
    : outline_(outline)
    , start_(start.step)
    , step_(start.step)
    , blur_(std::max(start.blurPx, EdgeProfiles::SharpestPx))
    , inside_(outline.points_Image.size())
    , outside_(outline.points_Image.size())
    , isEven_(outline.points_Image.size(), 0)
    , support_(start.support.size())
  {
    for (const std::size_t index : start.support)
    {
      isEven_[index] = 1;
    }
    const double near = BlursToStretch * blur_, far = near + StretchPx;
    const double deepest = std::min(far, DeepestShare * start.radiusPx);
    pixels_ = pixelsAlongOutline(light, outline, start.radiusPx, deepest, far);
    for (const OutlinePixel& pixel : pixels_)
    {
      const double offset = double(pixel.offsetPx) - shift(pixel.index);
      if (offset < -near)
      {
        inside_.add(pixel.index, offset > -(near + deepest) / 2, pixel.light);
      }
      else if (offset > near)
      {
        outside_.add(pixel.index, offset < (near + far) / 2, pixel.light);
      }
    }
  }

  std::optional<Eigen::Vector3d> fit()
  {
    average();
    noise_ = LargestNoise * LargestNoise;
    if (!isEven())
    {
      return std::nullopt;
    }
    for (int round = 0; round < Rounds; ++round)
    {
      if (!judgeNormals())
      {
        return std::nullopt;
      }
      average();
      if (!isEven())
      {
        return std::nullopt;
      }
      inside_.gather(noise_, isEven_);
      outside_.gather(noise_, isEven_);
      if (!move())
      {
        return std::nullopt;
      }
    }
    const auto good = std::count(isEdge_.begin(), isEdge_.end(), char(1));
    const bool isRight = double(good) >= LeastGood * double(support_) && movedPx() <= LargestMovePx;
    return isRight ? std::optional(step_) : std::nullopt;
  }

private:
  double shift(std::size_t normal) const { return outline_.rates[normal].dot(step_); }
  bool isKnown(std::size_t normal) const { return inside_.isKnown(normal) && outside_.isKnown(normal); }

  /// From where the fit started, at most along the outline.
  double movedPx() const
  {
    double most = 0;
    for (const Eigen::Vector3d& rate : outline_.rates)
    {
      most = std::max(most, std::abs(rate.dot(step_ - start_)));
    }
    return most;
  }

  /// The scatter about the model is that of noise, and the light on either side changes by no more.
  bool isEven() const
  {
    return noise_ <= LargestNoise * LargestNoise && std::max(inside_.change(), outside_.change()) < double(LargestChange * noise_);
  }

  void average()
  {
    inside_.average(isEven_);
    outside_.average(isEven_);
  }

  /// What a pixel should be, and is.
  struct Difference
  {
    Eigen::Vector3f contrast;    ///< in units of the noise of full slope
    Eigen::Vector3f difference;  ///< in the same
    float x;                     ///< of the pixel, inwards from the outline, in blurs
    float density;               ///< of the bell there
    float square() const { return difference.squaredNorm(); }
  };

  Difference differenceOf(const OutlinePixel& pixel) const
  {
    const std::size_t i = pixel.index;
    const double x = (shift(i) - double(pixel.offsetPx)) / blur_;
    const Bell::Value bell = Bell::at(std::clamp(x, -Bell::Reach, Bell::Reach));
    const float share = float(bell.integral);
    const Eigen::Vector3f across = inside_.level(i) - outside_.level(i), expected = outside_.level(i) + share * across;
    const Eigen::Array3f noise = (outside_.variance(i) + share * (inside_.variance(i) - outside_.variance(i))).array().rsqrt();
    return { (across.array() * noise).matrix(), ((pixel.light - expected).array() * noise).matrix(), float(x),
      std::abs(x) < Bell::Reach ? float(bell.density) : 0 };
  }

  /// Finds the noise, and the normals across which there is something else than the ball and what is around it: near the edge, or
  /// anywhere.
  bool judgeNormals()
  {
    OutlineScatter everywhere(isEven_.size()), nearEdge(isEven_.size());
    for (const OutlinePixel& pixel : pixels_)
    {
      if (isKnown(pixel.index))
      {
        const Difference difference = differenceOf(pixel);
        everywhere.add(pixel.index, difference.square());
        if (std::abs(difference.x) < BlursOfEdge)
        {
          nearEdge.add(pixel.index, difference.square());
        }
      }
    }
    std::vector<double> known = everywhere.shares();
    if (known.size() < FewestNormals)
    {
      return false;
    }
    const auto nth = known.begin() + std::ptrdiff_t(CleanShare * double(known.size()));
    std::nth_element(known.begin(), nth, known.end());
    noise_ = float(*nth);
    isEven_ = everywhere.areBelow(LargestOfNormal * noise_, BesideWrong);
    isEdge_ = nearEdge.areBelow(LargestOfEdge * noise_, 0);
    return true;
  }

  /// A step of Gauss and Newton.
  bool move()
  {
    Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const OutlinePixel& pixel : pixels_)
    {
      if (!isEdge_[pixel.index] || !isKnown(pixel.index))
      {
        continue;
      }
      const Difference difference = differenceOf(pixel);
      const float square = difference.square() / (LargestOfPixel * noise_);
      if (std::abs(difference.x) >= BlursThatCount || square >= 1)
      {
        continue;
      }
      const double weight = double((1 - square) * (1 - square));
      Eigen::Vector4d rate;
      rate << outline_.rates[pixel.index], -double(difference.x);
      rate *= double(difference.density) / blur_;
      information += weight * double(difference.contrast.squaredNorm()) * rate * rate.transpose();
      right += weight * double(difference.contrast.dot(difference.difference)) * rate;
    }
    const Eigen::Vector4d moved = information.ldlt().solve(right);
    if (!moved.allFinite())
    {
      return false;
    }
    step_ += moved.head<3>();
    blur_ = std::clamp(blur_ + moved[3], 0.7 * blur_, 1.4 * blur_);
    return true;
  }

  const SphereCone::Outline& outline_;
  Eigen::Vector3d start_;
  Eigen::Vector3d step_;
  double blur_;
  OutlineSide inside_, outside_;
  std::vector<char> isEven_;  ///< the light across the normal is the model's
  std::vector<char> isEdge_;  ///< near the edge it is
  std::size_t support_;
  std::vector<OutlinePixel> pixels_;
  float noise_ = 0;  ///< variance of the encoded value
};

}  // namespace

std::optional<Eigen::Vector3d> fitInEvenLight(
  const LinearLightImage& light, const SphereCone::Outline& outline, const EvenLightStart& start)
{
  return EvenLightFitter(light, outline, start).fit();
}

}  // namespace handeye
