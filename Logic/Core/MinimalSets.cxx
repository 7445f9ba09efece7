// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MinimalSets.h"

#include <random>
#include <utility>

namespace handeye
{

namespace
{

constexpr int MostDraws = 300;

}  // namespace

std::vector<std::vector<int>> minimalSets(int count)
{
  std::vector<std::vector<int>> sets;
  const double combinations = double(count) * (count - 1) * (count - 2) * (count - 3) / 24;
  if (combinations <= MostDraws)
  {
    for (int a = 0; a < count; ++a)
      for (int b = a + 1; b < count; ++b)
        for (int c = b + 1; c < count; ++c)
          for (int d = c + 1; d < count; ++d)
            sets.push_back({ a, b, c, d });
    return sets;
  }
  std::mt19937 random(1590);
  std::vector<int> order(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
  {
    order[std::size_t(i)] = i;
  }
  for (int draw = 0; draw < MostDraws; ++draw)
  {
    for (std::size_t k = 0; k < MinimalSet; ++k)
    {
      std::uniform_int_distribution<std::size_t> any(k, order.size() - 1);
      std::swap(order[k], order[any(random)]);
    }
    sets.emplace_back(order.begin(), order.begin() + MinimalSet);
  }
  return sets;
}

}  // namespace handeye
