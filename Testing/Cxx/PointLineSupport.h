// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "PointLineRegistration.h"
#include "Simulation.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace handeye::test
{

using Pairs = std::vector<PointLinePair>;

inline PointLineOptions pointLineOptions(PointLineOptions::Method method, bool linesAreRays)
{
  PointLineOptions options;
  options.method = method;
  options.linesAreRays = linesAreRays;
  return options;
}

/// Lines anywhere, in any direction and of any length, through points that `truth` moves onto them; noise (mm) on the points.
inline Pairs skewPairs(const Eigen::Isometry3d& pointsToLines, int count, double sigmaMm, Random& random)
{
  Pairs pairs;
  for (int i = 0; i < count; ++i)
  {
    const Eigen::Vector3d direction = random.direction() * random.uniform(0.1, 10);
    const Eigen::Vector3d point_Lines = random.uniform3(200);
    const Eigen::Vector3d origin = point_Lines + random.uniform(-30, 30) * direction;
    pairs.push_back({ pointsToLines.inverse() * point_Lines + random.normal3(sigmaMm), origin, direction, 1 });
  }
  return pairs;
}

/// A bundle of rays through one centre, as a camera sees them.
struct View
{
  double halfWidth = 0.5;  ///< tangent of half the angle of view
  double halfHeight = 0.38;
  double nearestMm = 150;
  double furthestMm = 700;
};

/// The paper's stereo laparoscope: a narrow view of near things.
inline View narrowView()
{
  return { 0.22, 0.17, 60, 250 };
}

inline Pairs viewPairs(
  const Eigen::Isometry3d& pointsToLines, int count, const View& view, double sigmaMm, double sigmaRad, Random& random)
{
  Pairs pairs;
  for (int i = 0; i < count; ++i)
  {
    const double x = random.uniform(-view.halfWidth, view.halfWidth), y = random.uniform(-view.halfHeight, view.halfHeight);
    const Eigen::Vector3d point_Lines = random.uniform(view.nearestMm, view.furthestMm) * Eigen::Vector3d(x, y, 1);
    const Eigen::Vector3d seen = point_Lines.normalized() + random.normal3(sigmaRad);
    pairs.push_back({ pointsToLines.inverse() * point_Lines + random.normal3(sigmaMm), Eigen::Vector3d::Zero(), seen, 1 });
  }
  return pairs;
}

/// The weighted sum of squared distances, in plain arithmetic.
inline double pointLineCost(const Pairs& pairs, const Eigen::Isometry3d& pointsToLines)
{
  double cost = 0;
  for (const PointLinePair& pair : pairs)
  {
    const Eigen::Vector3d offset = pointsToLines * pair.point_Points - pair.origin_Lines;
    cost += pair.weight * offset.cross(pair.direction_Lines).squaredNorm() / pair.direction_Lines.squaredNorm();
  }
  return cost;
}

inline int pointsInFront(const Pairs& pairs, const Eigen::Isometry3d& pointsToLines)
{
  int count = 0;
  for (const PointLinePair& pair : pairs)
  {
    count += (pointsToLines * pair.point_Points - pair.origin_Lines).dot(pair.direction_Lines) > 0 ? 1 : 0;
  }
  return count;
}

/// An independent minimiser: Levenberg and Marquardt over rotation vector and translation, from one start.
inline Eigen::Isometry3d descendPlainly(const Pairs& pairs, Eigen::Isometry3d pose)
{
  double cost = pointLineCost(pairs, pose), damping = 1e-3;
  for (int step = 0; step < 500; ++step)
  {
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
    const Eigen::Vector3d pivot = pose * pairs.front().point_Points;  // rotations are about a point of the set: better conditioned
    for (const PointLinePair& pair : pairs)
    {
      const Eigen::Vector3d unit = pair.direction_Lines.normalized(), moved = pose * pair.point_Points;
      const Eigen::Matrix3d off = Eigen::Matrix3d::Identity() - unit * unit.transpose();
      Eigen::Matrix<double, 3, 6> jacobian;
      jacobian << -off * skew(moved - pivot) / 100, off;
      normal += pair.weight * jacobian.transpose() * jacobian;
      right -= pair.weight * jacobian.transpose() * (off * (moved - pair.origin_Lines));
    }
    Eigen::Matrix<double, 6, 6> damped = normal;
    damped.diagonal() *= 1 + damping;
    const Eigen::Matrix<double, 6, 1> change = damped.ldlt().solve(right);
    Eigen::Isometry3d tried = pose;
    const Eigen::Matrix3d turn = rotationFromVector(change.head<3>() / 100);
    tried.linear() = turn * pose.linear();
    tried.translation() = turn * (pose.translation() - pivot) + pivot + change.tail<3>();
    const double triedCost = pointLineCost(pairs, tried);
    if (triedCost <= cost)
    {
      const bool still = change.norm() < 1e-11;
      pose = tried;
      cost = triedCost;
      damping = std::max(damping / 10, 1e-15);
      if (still)
      {
        break;
      }
    }
    else if ((damping *= 10) > 1e12)
    {
      break;
    }
  }
  return pose;
}

/// The lowest minimum that many random starts lead to; for rays the lowest with most points in front.
inline Eigen::Isometry3d bruteForceMinimum(const Pairs& pairs, bool linesAreRays, int starts, Random& random)
{
  Eigen::Isometry3d best = Eigen::Isometry3d::Identity();
  double lowest = std::numeric_limits<double>::infinity();
  for (int start = 0; start < starts; ++start)
  {
    const Eigen::Isometry3d found = descendPlainly(pairs, random.rigid(300));
    const double cost = pointLineCost(pairs, found);
    if (cost < lowest && (!linesAreRays || 2 * pointsInFront(pairs, found) > int(pairs.size())))
    {
      lowest = cost;
      best = found;
    }
  }
  return best;
}

}  // namespace handeye::test
