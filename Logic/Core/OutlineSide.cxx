// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OutlineSide.h"

#include "LinearLightImage.h"
#include "Statistics.h"

#include <algorithm>
#include <limits>

namespace handeye
{

namespace
{

/// Normals to either side whose light is averaged.
constexpr int NormalsToEitherSide = 8;
/// Places have the same light where the square of the difference is no more than this, in units of its variance.
constexpr float SameLight = 32;
constexpr std::size_t MostLights = 8;

/// Sums over the good normals within NormalsToEitherSide of each, all around.
std::vector<LightSum> sumAround(const std::vector<LightSum>& sums, const std::vector<char>& isGood)
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

}  // namespace

Eigen::Vector3f lightVariance(const Eigen::Vector3f& light)
{
  const Eigen::Vector3f slopes = light.unaryExpr([](float value) { return LinearLightImage::slope(value); });
  return slopes.cwiseAbs2();
}

std::vector<OutlineRun> runsOf(const std::vector<char>& flags)
{
  std::vector<OutlineRun> runs;
  const std::size_t count = flags.size();
  const auto first = std::size_t(std::find(flags.begin(), flags.end(), char(0)) - flags.begin());
  for (std::size_t i = first; first < count && i < first + count; ++i)
  {
    if (flags[i % count] == 0)
    {
      continue;
    }
    if (flags[(i + count - 1) % count] == 0)
    {
      runs.push_back({ int(i), 0 });
    }
    ++runs.back().count;
  }
  return runs;
}

void OutlineSide::clear()
{
  near_.assign(near_.size(), {});
  far_.assign(far_.size(), {});
}

void OutlineSide::average(const std::vector<char>& isGood)
{
  changes_.clear();
  sums_.assign(near_.size(), {});
  const std::vector<LightSum> nearSums = sumAround(near_, isGood), farSums = sumAround(far_, isGood);
  for (std::size_t i = 0; i < near_.size(); ++i)
  {
    const LightSum &near = nearSums[i], &far = farSums[i];
    isKnown_[i] = near.count + far.count > 0;
    if (isKnown_[i])
    {
      sums_[i] = near;
      sums_[i] += far;
      levels_[i] = sums_[i].mean();
      variances_[i] = lightVariance(levels_[i]);
      if (isGood[i] && near.count > 0 && far.count > 0)
      {
        const Eigen::Vector3f change = near.mean() - far.mean();
        changes_.push_back(double(change.cwiseAbs2().cwiseQuotient(variances_[i]).sum() / 3 / (1 / near.count + 1 / far.count)));
      }
    }
  }
  spread();
}

void OutlineSide::spread()
{
  const int count = int(isKnown_.size());
  const std::vector<char> isOwn = isKnown_;
  if (std::find(isOwn.begin(), isOwn.end(), char(1)) == isOwn.end())
  {
    return;
  }
  for (int i = 0; i < count; ++i)
  {
    int apart = 0;
    const auto at = [&](int k) { return std::size_t((i + k + count) % count); };
    while (!isOwn[at(apart)] && !isOwn[at(-apart)])
    {
      ++apart;
    }
    const std::size_t from = isOwn[at(apart)] ? at(apart) : at(-apart), to = std::size_t(i);
    sums_[to] = sums_[from];
    levels_[to] = levels_[from];
    variances_[to] = variances_[from];
    isKnown_[to] = 1;
  }
}

double OutlineSide::change() const
{
  const bool isNowhere = std::find(isKnown_.begin(), isKnown_.end(), char(1)) == isKnown_.end();
  return isNowhere ? std::numeric_limits<double>::infinity() : changes_.empty() ? 0 : median(changes_);
}

void OutlineSide::gather(float noiseVariance, const std::vector<char>& isGood)
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
      const Eigen::Vector3f mean = common.all.mean(), noise = lightVariance(mean);
      for (const std::size_t i : common.normals)
      {
        levels_[i] = mean;
        variances_[i] = noise;
      }
    }
  }
}

std::vector<double> OutlineScatter::shares(const std::vector<char>& isAskedFor) const
{
  std::vector<double> result;
  for (std::size_t i = 0; i < counts_.size(); ++i)
  {
    if (isAskedFor[i] != 0 && counts_[i] > 0)
    {
      result.push_back(double(share(i)));
    }
  }
  return result;
}

std::vector<char> OutlineScatter::areBelow(float limit, int beside) const
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

float OutlineScatter::share(std::size_t i) const
{
  const std::size_t before = (i + counts_.size() - 1) % counts_.size(), after = (i + 1) % counts_.size();
  return (squares_[before] + squares_[i] + squares_[after]) / (counts_[before] + counts_[i] + counts_[after]);
}

}  // namespace handeye
