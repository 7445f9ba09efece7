// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace handeye
{

/// Points of an outline that follow one another; `first` may go on beyond the last point, from the beginning.
struct OutlineRun
{
  int first = 0;
  int count = 0;
};

/// The runs of points, all around, that are flagged; none where all are.
std::vector<OutlineRun> runsOf(const std::vector<char>& flags);

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

/// Of a light's channels, were the noise of their encoded values 1.
Eigen::Vector3f lightVariance(const Eigen::Vector3f& light);

/// The light on one side of an outline, normal by normal, where it is even. Internal to the detection.
class OutlineSide
{
public:
  explicit OutlineSide(std::size_t count)
    : near_(count)
    , far_(count)
    , levels_(count, Eigen::Vector3f::Zero())
    , variances_(count, Eigen::Vector3f::Ones())
    , isKnown_(count)
  {
  }

  /// Forgets what was added.
  void clear();
  void add(std::size_t normal, bool isNear, const Eigen::Vector3f& light) { (isNear ? near_ : far_)[normal].add(light); }

  bool isKnown(std::size_t normal) const { return isKnown_[normal]; }
  const Eigen::Vector3f& level(std::size_t normal) const { return levels_[normal]; }
  const Eigen::Vector3f& variance(std::size_t normal) const { return variances_[normal]; }

  /// Averages over neighbours among the normals that are good; the others have the light of their good neighbours, or of the nearest
  /// that have any.
  void average(const std::vector<char>& isGood);

  /// Of the light between the nearer and the further half of the stretch: median of the square, in units of its variance were the
  /// noise of the encoded value 1. Infinite where nothing is known; 0 where the stretches are too short to have two halves.
  double change() const;

  /// Where the light is the same but for the noise, all of it is averaged.
  void gather(float noiseVariance, const std::vector<char>& isGood);

private:
  void spread();

  std::vector<LightSum> near_, far_;
  std::vector<LightSum> sums_;
  std::vector<Eigen::Vector3f> levels_, variances_;
  std::vector<char> isKnown_;
  std::vector<double> changes_;
};

/// Mean squares of pixels' differences, normal by normal; each with the two beside it.
class OutlineScatter
{
public:
  explicit OutlineScatter(std::size_t count)
    : squares_(count)
    , counts_(count)
  {
  }

  void add(std::size_t normal, float square)
  {
    squares_[normal] += square;
    counts_[normal] += 3;
  }

  /// Of the normals that have any and are asked for.
  std::vector<double> shares(const std::vector<char>& isAskedFor) const;

  /// Those with a smaller one, and with no larger one within some normals to either side.
  std::vector<char> areBelow(float limit, int beside) const;

private:
  float share(std::size_t i) const;

  std::vector<float> squares_, counts_;
};

}  // namespace handeye
