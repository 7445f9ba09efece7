// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointLineRegistration.h"

#include "PointLineQuadraticForm.h"
#include "RigidTransform.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace handeye
{

namespace
{

using Pairs = std::vector<PointLinePair>;
using Status = PointLineResult::Status;

constexpr std::size_t MinimumPairs = 4;
/// Two minima closer than this (rad) are one.
constexpr double SameRotation = 1e-4;
/// The information matrix of observable data is better conditioned than this.
constexpr double WorstCondition = 1e12;

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

/// All different local minima that the starts lead to, the lowest first.
std::vector<Minimum> findMinima(const PointLineQuadraticForm& form, int& steps)
{
  static const std::vector<Eigen::Matrix3d> starts = icosahedralRotations();
  std::vector<Minimum> minima;
  for (const Eigen::Matrix3d& start : starts)
  {
    const Eigen::Matrix3d rotation = form.descend(start, steps);
    const auto same = [&](const Minimum& other) { return rotationAngle(other.rotation.transpose() * rotation) < SameRotation; };
    if (std::none_of(minima.begin(), minima.end(), same))
    {
      minima.push_back({ rotation, form.cost(rotation) });
    }
  }
  std::sort(minima.begin(), minima.end(), [](const Minimum& a, const Minimum& b) { return a.cost < b.cost; });
  return minima;
}

Eigen::Vector3d fromLine(const PointLinePair& pair, const Eigen::Isometry3d& pointsToLines)
{
  const Eigen::Vector3d offset = pointsToLines * pair.point_Points - pair.origin_Lines;
  const Eigen::Vector3d unit = pair.direction_Lines.normalized();
  return offset - unit * unit.dot(offset);
}

/// How many points lie in front of their ray's origin.
int countInFront(const Pairs& pairs, const Eigen::Isometry3d& pointsToLines)
{
  return int(std::count_if(pairs.begin(), pairs.end(),
    [&](const PointLinePair& pair)
    { return pair.direction_Lines.dot(pointsToLines * pair.point_Points - pair.origin_Lines) > 0; }));
}

/// A cost below which all is rounding: that of the quadratic form, whose terms are this large and cancel.
double roundingCost(const Pairs& pairs)
{
  double scale = 0;
  for (const PointLinePair& pair : pairs)
  {
    scale += pair.weight * (pair.point_Points.squaredNorm() + pair.origin_Lines.squaredNorm());
  }
  return 1e-15 * scale;
}

void solveGlobal(const Pairs& pairs, const PointLineOptions& options, PointLineResult& result)
{
  const PointLineQuadraticForm form(pairs);
  if (!form.determinesTranslation())
  {
    result.status = Status::NotObservable;
    result.message = "all lines are parallel: nothing fixes the translation along them";
    return;
  }
  const std::vector<Minimum> minima = findMinima(form, result.iterations);
  result.minimaCount = int(minima.size());
  const auto transform = [&](const Minimum& minimum)
  {
    Eigen::Isometry3d pointsToLines = Eigen::Isometry3d::Identity();
    pointsToLines.linear() = minimum.rotation;
    pointsToLines.translation() = form.translation(minimum.rotation);
    return pointsToLines;
  };
  const auto isInFront = [&](const Minimum& minimum) { return 2 * countInFront(pairs, transform(minimum)) > int(pairs.size()); };

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
  }
  const double indistinguishable = 1.0001 * chosen->cost + roundingCost(pairs);
  const auto firstWorse =
    std::find_if(chosen, minima.end(), [&](const Minimum& minimum) { return minimum.cost > indistinguishable; });
  // Points of a plane seen along lines through one centre have a twin behind it: directions have a sense, so the one in front is
  // meant.
  const auto inFront = std::find_if(chosen, firstWorse, isInFront);
  chosen = inFront != firstWorse ? inFront : chosen;
  result.pointsToLines = transform(*chosen);
  result.status = Status::Ok;
  for (auto other = minima.begin(); other != firstWorse; ++other)
  {
    const bool isRival = other != chosen && (isInFront(*other) || (!options.linesAreRays && inFront == firstWorse));
    if (isRival)
    {
      result.status = Status::Ambiguous;
      result.message = "two different solutions fit equally well: add points that differ in depth and place";
    }
  }
}

/// The rotation and translation that bring points to points, after Umeyama and Kabsch.
Eigen::Isometry3d orthogonalProcrustes(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to)
{
  const Eigen::Vector3d fromMean = from.rowwise().mean(), toMean = to.rowwise().mean();
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = nearestRotation((to.colwise() - toMean) * (from.colwise() - fromMean).transpose());
  transform.translation() = toMean - transform.linear() * fromMean;
  return transform;
}

void solveProcrustes(const Pairs& pairs, const PointLineOptions& options, PointLineResult& result)
{
  const Eigen::Index count = Eigen::Index(pairs.size());
  Eigen::Matrix3Xd points(3, count), onLines(3, count);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    points.col(i) = pairs[i].point_Points;
    onLines.col(i) = pairs[i].origin_Lines + pairs[i].direction_Lines.normalized();
  }
  double last = std::numeric_limits<double>::infinity();
  result.status = Status::NotConverged;
  while (result.iterations < options.maximumIterations)
  {
    ++result.iterations;
    result.pointsToLines = orthogonalProcrustes(points, onLines);
    double squares = 0;
    for (Eigen::Index i = 0; i < count; ++i)
    {
      const Eigen::Vector3d off = fromLine(pairs[i], result.pointsToLines);
      onLines.col(i) = result.pointsToLines * pairs[i].point_Points - off;
      squares += off.squaredNorm();
    }
    const double rms = std::sqrt(squares / double(count));
    if (std::abs(last - rms) < options.tolerance)
    {
      result.status = Status::Ok;
      break;
    }
    last = rms;
  }
  if (result.status == Status::NotConverged)
  {
    result.message = "the iteration stopped at its cap of " + std::to_string(options.maximumIterations) + " without converging";
  }
  else if (options.linesAreRays && 2 * countInFront(pairs, result.pointsToLines) <= int(pairs.size()))
  {
    result.status = Status::Mirrored;
    result.message = "the iteration ended in the mirrored minimum, with the points behind the camera";
  }
}

/// Measures what the data determine; a direction that nothing fixes makes the result unusable.
void judgeObservability(const Pairs& pairs, PointLineResult& result)
{
  result.information = informationMatrix(pairs, result.pointsToLines);
  Eigen::Vector3d centroid_Points = Eigen::Vector3d::Zero();
  double squaredNorm = 0;
  for (const PointLinePair& pair : pairs)
  {
    centroid_Points += pair.point_Points / double(pairs.size());
    squaredNorm += pair.point_Points.squaredNorm() / double(pairs.size());
  }
  // Turn about the centroid, by the spread as the unit of length, so that the six numbers are comparable.
  Pairs centred = pairs;
  double spread = 0;
  for (PointLinePair& pair : centred)
  {
    pair.point_Points -= centroid_Points;
    spread += pair.point_Points.squaredNorm() / double(pairs.size());
  }
  const double length = std::max({ std::sqrt(spread), 1e-9 * std::sqrt(squaredNorm), 1e-150 });
  Eigen::Matrix<double, 6, 6> scale = Eigen::Matrix<double, 6, 6>::Identity();
  scale.topLeftCorner<3, 3>() /= length;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> spectrum(
    scale * informationMatrix(centred, result.pointsToLines) * scale);
  const double lowest = std::max(spectrum.eigenvalues()(0), 0.0), highest = spectrum.eigenvalues()(5);
  result.conditionNumber = lowest > 0 ? highest / lowest : std::numeric_limits<double>::infinity();
  // A freedom that nothing fixes shows as any number of equal minima, too: this is the better reason to give.
  const bool hasSolution = result.status == Status::Ok || result.status == Status::Ambiguous;
  if (!(result.conditionNumber < WorstCondition) && hasSolution)
  {
    const Eigen::Matrix<double, 6, 1> freedom = spectrum.eigenvectors().col(0);
    result.status = Status::NotObservable;
    result.message = freedom.head<3>().norm() > freedom.tail<3>().norm()
      ? "a rotation is not determined: the points lie on one line or in one place"
      : "a translation is not determined: the lines are parallel";
  }
}

void checkPairs(const Pairs& pairs)
{
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    const PointLinePair& pair = pairs[i];
    const bool finite = pair.point_Points.allFinite() && pair.origin_Lines.allFinite() && pair.direction_Lines.allFinite();
    if (!finite || !(pair.direction_Lines.norm() > 0) || !(pair.weight > 0) || !std::isfinite(pair.weight))
    {
      throw std::invalid_argument("point and line " + std::to_string(i + 1) +
        ": finite numbers, a direction that is not zero and a positive weight are expected");
    }
  }
}

}  // namespace

void PointLineOptions::check() const
{
  if (maximumIterations < 1 || !(tolerance > 0))
  {
    throw std::invalid_argument("point-to-line options: a positive tolerance and at least one iteration are expected");
  }
}

PointLineResult registerPointsToLines(const Pairs& pairs, const PointLineOptions& options)
{
  options.check();
  checkPairs(pairs);
  PointLineResult result;
  if (pairs.size() < MinimumPairs)
  {
    result.message =
      "only " + std::to_string(pairs.size()) + " points with a line, at least " + std::to_string(MinimumPairs) + " are needed";
    return result;
  }
  if (options.method == PointLineOptions::Method::Global)
  {
    solveGlobal(pairs, options, result);
  }
  else
  {
    solveProcrustes(pairs, options, result);
  }
  if (result.status == Status::NotObservable)
  {
    return result;
  }
  judgeObservability(pairs, result);
  double squares = 0;
  for (const PointLinePair& pair : pairs)
  {
    result.residualsMm.push_back(fromLine(pair, result.pointsToLines).norm());
    squares += result.residualsMm.back() * result.residualsMm.back();
  }
  result.rmsMm = std::sqrt(squares / double(pairs.size()));
  if (result.isUsable())
  {
    result.message = "registered " + std::to_string(pairs.size()) + " points";
  }
  return result;
}

Eigen::Matrix<double, 6, 6> informationMatrix(const Pairs& pairs, const Eigen::Isometry3d& pointsToLines)
{
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  for (const PointLinePair& pair : pairs)
  {
    const Eigen::Vector3d unit = pair.direction_Lines.normalized();
    Eigen::Matrix<double, 3, 6> motion;
    motion << -skew(pointsToLines.linear() * pair.point_Points), Eigen::Matrix3d::Identity();
    const Eigen::Matrix<double, 3, 6> off = motion - unit * (unit.transpose() * motion);
    information += pair.weight * off.transpose() * off;
  }
  return information;
}

std::string toString(Status status)
{
  switch (status)
  {
    case Status::Ok:
      return "ok";
    case Status::TooFewPairs:
      return "too_few_pairs";
    case Status::NotObservable:
      return "not_observable";
    case Status::NotConverged:
      return "not_converged";
    case Status::Mirrored:
      return "mirrored";
    case Status::Ambiguous:
      return "ambiguous";
  }
  return "unknown";
}

}  // namespace handeye
