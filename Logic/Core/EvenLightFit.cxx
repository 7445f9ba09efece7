// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EvenLightFit.h"

#include "EdgeProfiles.h"
#include "OutlinePixels.h"
#include "Statistics.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

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
/// Normals to either side whose light is averaged.
constexpr int NormalsToEitherSide = 8;
constexpr std::size_t FewestNormals = 12;
constexpr int Rounds = 4;
/// Squares of differences in units of their variance: between places that have the same light, of normals that have what the model says,
/// and of a pixel that counts.
constexpr float SameLight = 32;
constexpr float LargestOfNormal = 2;
constexpr float LargestOfEdge = 4;
constexpr float LargestOfPixel = 36;
/// Normals beside such a one are left out, too.
constexpr int BesideWrong = 1;
constexpr std::size_t MostLights = 8;
/// At least so many of the normals that there is light for have what the model says.
constexpr double CleanShare = 0.3;
/// Of the change of the light between the nearer and the further half of a stretch.
constexpr float LargestChange = 3;
/// A larger scatter (of full light's encoded value) is not the noise of a camera alone.
constexpr float LargestNoise = 4 / 255.0F;
/// The light is not even where fewer normals than this share of those with a right edge have what the model says.
constexpr double LeastGood = 0.7;

/// Sums over pixels.
struct LightSum
{
  Eigen::Vector3f light = Eigen::Vector3f::Zero();
  float count = 0;

  void add(const Eigen::Vector3f& value)
  {
    light += value;
    ++count;
  }
  LightSum& operator+=(const LightSum& other)
  {
    light += other.light;
    count += other.count;
    return *this;
  }
  Eigen::Vector3f mean() const { return light / count; }
};

/// Of a channel's light by the noise of its encoded value.
Eigen::Vector3f variance(const Eigen::Vector3f& light)
{
  const Eigen::Vector3f slopes = light.unaryExpr([](float value) { return LinearLightImage::slope(value); });
  return slopes.cwiseAbs2();
}

/// The light on one side of the outline, normal by normal.
class Side
{
public:
  explicit Side(std::size_t count)
    : near_(count)
    , far_(count)
    , levels_(count, Eigen::Vector3f::Zero())
    , variances_(count, Eigen::Vector3f::Ones())
    , isKnown_(count)
  {
  }

  void add(std::size_t normal, bool isNear, const Eigen::Vector3f& light) { (isNear ? near_ : far_)[normal].add(light); }

  bool isKnown(std::size_t normal) const { return isKnown_[normal]; }
  const Eigen::Vector3f& level(std::size_t normal) const { return levels_[normal]; }
  const Eigen::Vector3f& variance(std::size_t normal) const { return variances_[normal]; }

  /// Averages over neighbours among the normals that are good; the others have the light of their good neighbours.
  void average(const std::vector<char>& isGood)
  {
    changes_.clear();
    sums_.assign(near_.size(), {});
    const std::vector<LightSum> nearSums = sumAround(near_, isGood), farSums = sumAround(far_, isGood);
    for (std::size_t i = 0; i < near_.size(); ++i)
    {
      const LightSum &near = nearSums[i], &far = farSums[i];
      isKnown_[i] = near.count > 0 && far.count > 0;
      if (isKnown_[i])
      {
        sums_[i] = near;
        sums_[i] += far;
        set(i, sums_[i].mean());
        const Eigen::Vector3f change = near.mean() - far.mean();
        if (isGood[i])
        {
          changes_.push_back(double(change.cwiseAbs2().cwiseQuotient(variances_[i]).sum() / 3 / (1 / near.count + 1 / far.count)));
        }
      }
    }
  }

  /// In units of the noise' variance.
  double change() const { return changes_.empty() ? 0 : median(changes_); }

  /// Where the light is the same but for the noise, all of it is averaged.
  void gather(float noiseVariance, const std::vector<char>& isGood)
  {
    struct Common
    {
      Eigen::Vector3f level;
      LightSum all;
      std::vector<std::size_t> normals;
    };
    std::vector<Common> lights;
    for (std::size_t i = 0; i < near_.size(); ++i)
    {
      if (!isKnown_[i])
      {
        continue;
      }
      const auto isSame = [&](const Common& common) {
        return (common.level - levels_[i]).cwiseAbs2().cwiseQuotient(variances_[i]).sum() * sums_[i].count <
          SameLight * noiseVariance;
      };
      auto common = std::find_if(lights.begin(), lights.end(), isSame);
      if (common == lights.end())
      {
        if (lights.size() == MostLights)
        {
          continue;
        }
        lights.push_back({ levels_[i], {}, {} });
        common = lights.end() - 1;
      }
      if (isGood[i])
      {
        common->all += near_[i];
        common->all += far_[i];
      }
      common->normals.push_back(i);
    }
    for (const Common& common : lights)
    {
      if (common.all.count > 0)
      {
        const Eigen::Vector3f mean = common.all.mean(), noise = handeye::variance(mean);
        for (const std::size_t i : common.normals)
        {
          levels_[i] = mean;
          variances_[i] = noise;
        }
      }
    }
  }

private:
  void set(std::size_t i, const Eigen::Vector3f& level)
  {
    levels_[i] = level;
    variances_[i] = handeye::variance(level);
  }

  /// Sums over the good normals within NormalsToEitherSide of each, all around.
  static std::vector<LightSum> sumAround(const std::vector<LightSum>& sums, const std::vector<char>& isGood)
  {
    const int count = int(sums.size()), reach = std::min(NormalsToEitherSide, (count - 1) / 2);
    std::vector<LightSum> upTo(std::size_t(count + 2 * reach + 1));
    for (int k = 0; k < count + 2 * reach; ++k)
    {
      const auto from = std::size_t((k - reach + count) % count), to = std::size_t(k);
      upTo[to + 1] = upTo[to];
      if (isGood[from])
      {
        upTo[to + 1] += sums[from];
      }
    }
    std::vector<LightSum> around(sums.size());
    for (std::size_t i = 0; i < around.size(); ++i)
    {
      const LightSum &before = upTo[i], &after = upTo[i + std::size_t(2 * reach + 1)];
      around[i] = { after.light - before.light, after.count - before.count };
    }
    return around;
  }

  std::vector<LightSum> near_, far_;
  std::vector<LightSum> sums_;
  std::vector<Eigen::Vector3f> levels_, variances_;
  std::vector<char> isKnown_;
  std::vector<double> changes_;
};

/// Mean squares of pixels' differences, normal by normal; each with the two beside it.
class Scatter
{
public:
  explicit Scatter(std::size_t count)
    : squares_(count)
    , counts_(count)
  {
  }

  void add(std::size_t normal, float square)
  {
    squares_[normal] += square;
    counts_[normal] += 3;
  }

  /// Of the normals that have any.
  std::vector<double> shares() const
  {
    std::vector<double> result;
    for (std::size_t i = 0; i < counts_.size(); ++i)
    {
      if (counts_[i] > 0)
      {
        result.push_back(double(share(i)));
      }
    }
    return result;
  }

  /// Those with a smaller one, and with no larger one within some normals to either side.
  std::vector<char> areBelow(float limit, int beside) const
  {
    const int count = int(counts_.size());
    std::vector<char> result(counts_.size(), 1);
    for (int i = 0; i < count; ++i)
    {
      if (counts_[std::size_t(i)] == 0 || share(std::size_t(i)) >= limit)
      {
        for (int k = -beside; k <= beside; ++k)
        {
          result[std::size_t((i + k + count) % count)] = 0;
        }
      }
    }
    return result;
  }

private:
  float share(std::size_t i) const
  {
    const std::size_t before = (i + counts_.size() - 1) % counts_.size(), after = (i + 1) % counts_.size();
    return (squares_[before] + squares_[i] + squares_[after]) / (counts_[before] + counts_[i] + counts_[after]);
  }

  std::vector<float> squares_, counts_;
};

/// The fit to the pixels, round by round.
class EvenLightFitter
{
public:
  EvenLightFitter(const LinearLightImage& light, const SphereCone::Outline& outline, const EvenLightStart& start)
    : outline_(outline)
    , step_(start.step)
    , blur_(std::max(start.blurPx, EdgeProfiles::SharpestPx))
    , inside_(outline.points_Image.size())
    , outside_(outline.points_Image.size())
    , isEven_(outline.points_Image.size(), 0)
  {
    support_ = start.support.size();
    for (const std::size_t index : start.support)
    {
      isEven_[index] = 1;
    }
    const double near = BlursToStretch * blur_, far = near + StretchPx;
    const double deepest = std::min(far, DeepestShare * start.radiusPx);
    pixels_ = pixelsAlongOutline(light, outline, start.radiusPx, deepest, far);
    for (OutlinePixel& pixel : pixels_)
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
    return double(good) >= LeastGood * double(support_) ? std::optional(step_) : std::nullopt;
  }

private:
  double shift(std::size_t normal) const { return outline_.rates[normal].dot(step_); }
  bool isKnown(std::size_t normal) const { return inside_.isKnown(normal) && outside_.isKnown(normal); }

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
    float density;
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
    Scatter everywhere(isEven_.size()), nearEdge(isEven_.size());
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
  Eigen::Vector3d step_;
  double blur_;
  Side inside_, outside_;
  std::vector<char> isEven_;  ///< the light across the normal is the model's
  std::vector<char> isEdge_;  ///< near the edge it is
  std::vector<OutlinePixel> pixels_;
  float noise_ = 0;
  std::size_t support_ = 0;
};

}  // namespace

std::optional<Eigen::Vector3d> fitInEvenLight(
  const LinearLightImage& light, const SphereCone::Outline& outline, const EvenLightStart& start)
{
  return EvenLightFitter(light, outline, start).fit();
}

}  // namespace handeye
