// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointLineMethods.h"
#include "RigidTransform.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

using Status = PointLineResult::Status;

constexpr std::size_t EnoughPairs = 4;
/// With this many pairs, noise does not make a solution behind the camera fit better by this ratio of the costs.
constexpr std::size_t EnoughToTell = 8;
constexpr double MirroredRatio = 100;
/// Noise moves the difference of two minima's costs by this many variances, three standard deviations.
constexpr double RivalChi2 = 9;
/// Two minima closer than this (rad) are one.
constexpr double SameRotation = 1e-4;

/// The 60 rotations of the icosahedron: no rotation is further than 45 degrees from one of them.
std::vector<Eigen::Matrix3d> icosahedralRotations()
{
  const double golden = (1 + std::sqrt(5.0)) / 2;
  const Eigen::Matrix3d fifth = Eigen::AngleAxisd(2 * EIGEN_PI / 5, Eigen::Vector3d(0, 1, golden).normalized()).toRotationMatrix();
  const Eigen::Matrix3d third = Eigen::AngleAxisd(2 * EIGEN_PI / 3, Eigen::Vector3d::Ones().normalized()).toRotationMatrix();
  std::vector<Eigen::Matrix3d> group = { Eigen::Matrix3d::Identity() };
  for (std::size_t i = 0; i < group.size(); ++i)
  {
    for (const Eigen::Matrix3d& generator : { fifth, third })
    {
      const Eigen::Matrix3d product = nearestRotation(generator * group[i]);
      const auto same = [&](const Eigen::Matrix3d& other) { return (other - product).norm() < 1e-6; };
      if (std::none_of(group.begin(), group.end(), same))
      {
        group.push_back(product);
      }
    }
  }
  return group;
}

struct Minimum
{
  Eigen::Matrix3d rotation;
  double cost;
};

/// All different local minima that a start close by and the starts all over SO(3) lead to, the lowest first.
std::vector<Minimum> findMinima(const PointLineQuadraticForm& form, const Eigen::Matrix3d& first, int& steps)
{
  static const std::vector<Eigen::Matrix3d> starts = icosahedralRotations();
  std::vector<Minimum> minima = { { first, form.cost(first) } };
  for (const Eigen::Matrix3d& start : starts)
  {
    const Eigen::Matrix3d rotation = form.descend(start, steps);
    const auto same = [&](const Minimum& other)
    { return (other.rotation - rotation).squaredNorm() < 2 * SameRotation * SameRotation; };
    if (std::none_of(minima.begin(), minima.end(), same))
    {
      minima.push_back({ rotation, form.cost(rotation) });
    }
  }
  std::sort(minima.begin(), minima.end(), [](const Minimum& a, const Minimum& b) { return a.cost < b.cost; });
  return minima;
}

/// A cost below which all is rounding: that of the quadratic form, whose terms are this large and cancel.
double roundingCost(const PointLinePairs& pairs)
{
  double scale = 0;
  for (const PointLinePair& pair : pairs)
  {
    scale += pair.weight * (pair.point_Points.squaredNorm() + pair.origin_Lines.squaredNorm());
  }
  return 1e-15 * scale;
}

/// Takes the lowest minimum, for rays the lowest in front, and those that cannot be told apart from it.
void choose(const PointLinePairs& pairs, const PointLineQuadraticForm& form, const std::vector<Minimum>& minima,
  const PointLineOptions& options, PointLineResult& result)
{
  const auto isInFront = [&](const Minimum& minimum) { return areMostInFront(pairs, form.pointsToLines(minimum.rotation)); };
  auto chosen = minima.begin();
  if (options.linesAreRays)
  {
    chosen = std::find_if(minima.begin(), minima.end(), isInFront);
    if (chosen == minima.end())
    {
      result.status = Status::Mirrored;
      result.message = "no solution has the points in front of the camera: points and rays do not belong together";
      return;
    }
    if (pairs.size() >= EnoughToTell && chosen->cost > MirroredRatio * minima.front().cost + 1e4 * roundingCost(pairs))
    {
      result.status = Status::Mirrored;
      result.message = "the rays point the wrong way: with the points behind the camera they fit far better than in front of it";
      return;
    }
  }
  const double freedoms = 2.0 * double(pairs.size()) - 6;
  const double byNoise = options.findRivals && freedoms > 0 ? RivalChi2 * chosen->cost / freedoms : 0;
  const double indistinguishable = 1.0001 * chosen->cost + byNoise + roundingCost(pairs);
  const auto firstWorse =
    std::find_if(chosen, minima.end(), [&](const Minimum& minimum) { return minimum.cost > indistinguishable; });
  // Points of a plane seen along lines through one centre have a twin behind it: directions have a sense, so the one in front is
  // meant.
  const auto inFront = std::find_if(chosen, firstWorse, isInFront);
  chosen = inFront != firstWorse ? inFront : chosen;
  result.pointsToLines = form.pointsToLines(chosen->rotation);
  result.status = Status::Ok;
  for (auto other = minima.begin(); other != firstWorse; ++other)
  {
    const bool isRival = other != chosen && (isInFront(*other) || (!options.linesAreRays && inFront == firstWorse));
    if (isRival)
    {
      if (result.solutions.empty())
      {
        result.solutions.push_back(result.pointsToLines);
      }
      result.solutions.push_back(form.pointsToLines(other->rotation));
      result.status = Status::Ambiguous;
      result.message = "two different solutions fit equally well: add points that differ in depth and place";
    }
  }
}

}  // namespace

void solveGlobal(
  const PointLinePairs& pairs, const PointLineQuadraticForm& form, const PointLineOptions& options, PointLineResult& result)
{
  if (!form.determinesTranslation())
  {
    result.status = Status::NotObservable;
    result.rank = 5;
    result.message = "a translation is not determined: all lines are parallel, nothing fixes the place along them";
    return;
  }
  const Eigen::Matrix3d first = form.descend(form.linearStart(), result.iterations);
  // Fewer points than this leave the quadratic form flat somewhere, where there is nothing to prove.
  if (!options.findRivals && pairs.size() > EnoughPairs && form.isCertainlyGlobal(first))
  {
    result.pointsToLines = form.pointsToLines(first);
    const std::size_t inFront = measureResiduals(pairs, form, result);
    if (!options.linesAreRays || 2 * inFront > pairs.size())
    {
      result.minimaCount = 1;
      result.status = Status::Ok;
      return;
    }
    result.residualsMm.clear();
  }
  const std::vector<Minimum> minima = findMinima(form, first, result.iterations);
  result.minimaCount = int(minima.size());
  choose(pairs, form, minima, options, result);
}

}  // namespace handeye
