// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointLineMethods.h"
#include "RigidTransform.h"

#include <Eigen/Dense>

#include <cmath>
#include <limits>

namespace handeye
{

namespace
{

using Status = PointLineResult::Status;

/// The rotation and translation that bring points to points, after Umeyama and Kabsch.
Eigen::Isometry3d orthogonalProcrustes(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to)
{
  const Eigen::Vector3d fromMean = from.rowwise().mean(), toMean = to.rowwise().mean();
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = nearestRotation((to.colwise() - toMean) * (from.colwise() - fromMean).transpose());
  transform.translation() = toMean - transform.linear() * fromMean;
  return transform;
}

struct Lines
{
  Eigen::Matrix3Xd points, origins, directions;  ///< directions of unit length
};

Lines toMatrices(const PointLinePairs& pairs)
{
  const Eigen::Index count = Eigen::Index(pairs.size());
  Lines lines{ Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count) };
  for (Eigen::Index i = 0; i < count; ++i)
  {
    const PointLinePair& pair = pairs[std::size_t(i)];
    lines.points.col(i) = pair.point_Points;
    lines.origins.col(i) = pair.origin_Lines;
    lines.directions.col(i) = pair.direction_Lines.normalized();
  }
  return lines;
}

Eigen::Matrix3Xd moved(const Eigen::Isometry3d& transform, const Eigen::Matrix3Xd& points)
{
  return (transform.linear() * points).colwise() + transform.translation();
}

/// The points of the lines that are nearest to given points.
Eigen::Matrix3Xd nearestOnLines(const Lines& lines, const Eigen::Matrix3Xd& points)
{
  Eigen::Matrix3Xd nearest = points - lines.origins;
  const Eigen::RowVectorXd along = nearest.cwiseProduct(lines.directions).colwise().sum();
  nearest = lines.origins + lines.directions * along.asDiagonal();
  return nearest;
}

/// Whether the root mean square distance has come to rest; remembers it.
bool isAtRest(const Eigen::Matrix3Xd& offsets, double tolerance, double& lastRms)
{
  const double rms = std::sqrt(offsets.squaredNorm() / double(offsets.cols()));
  const bool atRest = std::abs(lastRms - rms) < tolerance;
  lastRms = rms;
  return atRest;
}

/// What is said at the end of an iteration that stopped by itself or at its cap.
void conclude(const PointLinePairs& pairs, const PointLineOptions& options, PointLineResult& result)
{
  if (result.status == Status::NotConverged)
  {
    result.message = "the iteration stopped at its cap of " + std::to_string(options.maximumIterations) + " without converging";
  }
  else if (options.linesAreRays && !areMostInFront(pairs, result.pointsToLines))
  {
    result.status = Status::Mirrored;
    result.message = "the iteration ended in the mirrored minimum, with the points behind the camera";
  }
}

}  // namespace

void solveProcrustes(const PointLinePairs& pairs, const PointLineOptions& options, PointLineResult& result)
{
  const Lines lines = toMatrices(pairs);
  Eigen::Matrix3Xd onLines = lines.origins + lines.directions;
  double lastRms = std::numeric_limits<double>::infinity();
  result.status = Status::NotConverged;
  while (result.iterations < options.maximumIterations && result.status == Status::NotConverged)
  {
    ++result.iterations;
    result.pointsToLines = orthogonalProcrustes(lines.points, onLines);
    const Eigen::Matrix3Xd points = moved(result.pointsToLines, lines.points);
    onLines = nearestOnLines(lines, points);
    if (isAtRest(points - onLines, options.tolerance, lastRms))
    {
      result.status = Status::Ok;
    }
  }
  conclude(pairs, options, result);
}

void solveOrthogonalIteration(const PointLinePairs& pairs, const PointLineOptions& options, PointLineResult& result)
{
  const Lines lines = toMatrices(pairs);
  const Eigen::Index count = lines.points.cols();
  const Eigen::Matrix3d sum = double(count) * Eigen::Matrix3d::Identity() - lines.directions * lines.directions.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spectrum(sum);
  if (!(spectrum.eigenvalues()(0) > 1e-12 * double(count)))
  {
    result.status = Status::NotObservable;
    result.rank = 5;
    result.message = "a translation is not determined: all lines are parallel, nothing fixes the place along them";
    return;
  }
  const Eigen::Matrix3d inverse = sum.inverse();
  // Weak perspective to begin with: all points at the same distance along their lines.
  Eigen::Matrix3Xd onLines = lines.origins + lines.directions;
  double lastRms = std::numeric_limits<double>::infinity();
  result.status = Status::NotConverged;
  while (result.iterations < options.maximumIterations && result.status == Status::NotConverged)
  {
    ++result.iterations;
    result.pointsToLines.linear() = orthogonalProcrustes(lines.points, onLines).linear();
    // t(R) = (sum V)^-1 sum V (o - R x), eq. 20
    Eigen::Matrix3Xd points = result.pointsToLines.linear() * lines.points;
    result.pointsToLines.translation() = inverse * (nearestOnLines(lines, points) - points).rowwise().sum();
    points.colwise() += result.pointsToLines.translation();
    onLines = nearestOnLines(lines, points);
    if (isAtRest(points - onLines, options.tolerance, lastRms))
    {
      result.status = Status::Ok;
    }
  }
  conclude(pairs, options, result);
}

void solveProcrustesPnP(const PointLinePairs& pairs, const PointLineOptions& options, PointLineResult& result)
{
  if (!haveOneCentre(pairs, options, result))
  {
    return;
  }
  // The paper's P (rays), Z (depths), S (points) and c (centre in the points' frame), a column instead of a row each.
  const Lines lines = toMatrices(pairs);
  const Eigen::Matrix3Xd &P = lines.directions, &S = lines.points;
  // All points at the same depth to begin with.
  Eigen::RowVectorXd Z = Eigen::RowVectorXd::Ones(P.cols());
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  double lastRms = std::numeric_limits<double>::infinity();
  result.status = Status::NotConverged;
  while (result.iterations < options.maximumIterations && result.status == Status::NotConverged)
  {
    ++result.iterations;
    const Eigen::Matrix3Xd seen = P * Z.asDiagonal();
    const Eigen::Vector3d meanPoint = S.rowwise().mean();
    R = nearestRotation(seen * (S.colwise() - meanPoint).transpose());
    const Eigen::Matrix3Xd rays_Points = R.transpose() * P;
    const Eigen::Vector3d c = (S - rays_Points * Z.asDiagonal()).rowwise().mean();
    const Eigen::Matrix3Xd Y = S.colwise() - c;
    Z = rays_Points.cwiseProduct(Y).colwise().sum().cwiseMax(0.0);
    result.pointsToLines.linear() = R;
    result.pointsToLines.translation() = pairs.front().origin_Lines - R * c;
    if (isAtRest(Y - rays_Points * Z.asDiagonal(), options.tolerance, lastRms))
    {
      result.status = Status::Ok;
    }
  }
  conclude(pairs, options, result);
}

}  // namespace handeye
