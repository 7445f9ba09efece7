// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NumberWords.h"
#include "PointLineMethods.h"
#include "RigidTransform.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace handeye
{

namespace
{

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr int MaximumRounds = 50;
/// Rounds in which the noise follows the residuals.
constexpr int NoiseRounds = 6;
/// The last step turns the points by less than this (rad) about their centroid.
constexpr double Still = 1e-12;
/// A point may be said to be exact; its variance (mm^2) is then taken to be this.
constexpr double SmallestVariance = 1e-12;
/// The last turn (rad) of a solution that was reached.
constexpr double NearlyStill = 1e-7;
constexpr int RatioSteps = 20;

/// One pair at the present solution, in the plane across its line.
struct Term
{
  Eigen::Vector2d offset;             ///< of the point from the line, mm
  Eigen::Matrix<double, 2, 6> slope;  ///< of the offset by a motion about the centroid
  Eigen::Matrix2d byPoint;            ///< covariance of the offset for sigmaMm = 1
  Eigen::Matrix2d byDirection;        ///< and for sigmaRad = 1
};

struct Noise
{
  double squareMm = 1;
  double squareRad = 0;

  Eigen::Matrix2d covariance(const Term& term) const
  {
    const Eigen::Matrix2d sum = squareMm * term.byPoint + squareRad * term.byDirection;
    return sum + 1e-12 * sum.trace() * Eigen::Matrix2d::Identity();
  }
};

class Likelihood
{
public:
  Likelihood(const PointLinePairs& pairs, const std::vector<PointLineNoise>& noise, const PointLineOptions& options)
    : pairs_(pairs)
    , noise_(noise)
    , options_(options)
    , terms_(pairs.size())
  {
    for (const PointLinePair& pair : pairs)
    {
      centroid_Points_ += pair.point_Points / double(pairs.size());
    }
  }

  /// Offsets, slopes and covariances at a solution.
  void linearize(const Eigen::Isometry3d& pointsToLines)
  {
    centre_Lines_ = pointsToLines * centroid_Points_;
    const Eigen::Matrix3d& rotation = pointsToLines.linear();
    for (std::size_t i = 0; i < pairs_.size(); ++i)
    {
      const PointLinePair& pair = pairs_[i];
      const Eigen::Vector3d unit = pair.direction_Lines.normalized();
      Eigen::Matrix<double, 3, 2> across;
      across.col(0) = unit.unitOrthogonal();
      across.col(1) = unit.cross(across.col(0));
      const Eigen::Vector3d point_Lines = pointsToLines * pair.point_Points;
      const Eigen::Vector3d fromOrigin = point_Lines - pair.origin_Lines;
      const double along = unit.dot(fromOrigin);
      Term& term = terms_[i];
      term.offset = across.transpose() * fromOrigin;
      term.slope << -across.transpose() * skew(point_Lines - centre_Lines_), across.transpose();
      term.byPoint.setIdentity();
      term.byDirection.setIdentity();
      if (!noise_.empty())
      {
        const Eigen::Matrix<double, 3, 2> across_Points = rotation.transpose() * across;
        term.byPoint = across_Points.transpose() * noise_[i].point_Points * across_Points;
        term.byDirection = across.transpose() * noise_[i].direction_Lines * across;
      }
      term.byDirection *= along * along;
    }
  }

  /// The weight of a term with a robust loss: 1, or less for a residual that is too large.
  double weight(const Term& term, const Noise& noise) const
  {
    const double distance = std::sqrt(term.offset.dot(noise.covariance(term).inverse() * term.offset));
    return distance > options_.robustFactor ? options_.robustFactor / distance : 1;
  }

  /// Sum of squared residuals in units of their noise.
  double squares(const Noise& noise, const Noise& robustNoise) const
  {
    double sum = 0;
    for (const Term& term : terms_)
    {
      sum += weight(term, robustNoise) * term.offset.dot(noise.covariance(term).inverse() * term.offset);
    }
    return sum;
  }

  /// Scale and ratio of the two kinds of noise that make the residuals most likely, six freedoms being used up by the solution.
  Noise estimateNoise(const Noise& last) const
  {
    const double freedoms = std::max(1.0, 2.0 * double(terms_.size()) - 6);
    double meanSquare = 0;
    for (const Term& term : terms_)
    {
      meanSquare += term.byDirection.trace() / std::max(term.byPoint.trace(), SmallestVariance) / double(terms_.size());
    }
    Noise best = last;
    double lowest = std::numeric_limits<double>::infinity();
    // The origin of a line that is no ray is any of its points: the distance from there says nothing.
    const int steps = options_.linesAreRays ? RatioSteps : 0;
    for (int step = 0; step <= steps; ++step)
    {
      const double share = steps > 0 ? double(step) / steps : 0;
      Noise tried{ 1 - share, share / meanSquare };
      double logarithms = 0;
      for (const Term& term : terms_)
      {
        logarithms += std::log(tried.covariance(term).determinant());
      }
      const double variance = squares(tried, last) / freedoms;
      const double surprise = freedoms * std::log(std::max(variance, 1e-300)) + logarithms;
      if (surprise < lowest)
      {
        lowest = surprise;
        best = { variance * tried.squareMm, variance * tried.squareRad };
      }
    }
    return best;
  }

  Matrix6 normalEquations(const Noise& noise, Vector6& right) const
  {
    Matrix6 normal = Matrix6::Zero();
    right.setZero();
    for (const Term& term : terms_)
    {
      const Eigen::Matrix<double, 6, 2> weighted = weight(term, noise) * term.slope.transpose() * noise.covariance(term).inverse();
      normal += weighted * term.slope;
      right -= weighted * term.offset;
    }
    return normal;
  }

  const Eigen::Vector3d& centre_Lines() const { return centre_Lines_; }

private:
  const PointLinePairs& pairs_;
  const std::vector<PointLineNoise>& noise_;
  const PointLineOptions& options_;
  std::vector<Term> terms_;
  Eigen::Vector3d centroid_Points_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d centre_Lines_ = Eigen::Vector3d::Zero();
};

}  // namespace

void solveMaximumLikelihood(
  const PointLinePairs& pairs, const std::vector<PointLineNoise>& noise, const PointLineOptions& options, PointLineResult& result)
{
  Likelihood likelihood(pairs, noise, options);
  const bool isGiven = options.sigmaMm + options.sigmaRad > 0;
  const double unlimited = 1e300;  // before the noise is known, no residual is too large
  Noise sigma{ isGiven ? options.sigmaMm * options.sigmaMm : unlimited, options.sigmaRad * options.sigmaRad };
  Eigen::LDLT<Matrix6> factors;
  bool isConverged = false;
  for (int round = 0; round < MaximumRounds; ++round)
  {
    likelihood.linearize(result.pointsToLines);
    if (!isGiven && round < NoiseRounds)
    {
      sigma = likelihood.estimateNoise(sigma);
    }
    // Data without any noise: equal weights do.
    const bool isExact = !(sigma.squareMm + sigma.squareRad > 1e-24);
    Vector6 right;
    const Matrix6 normal = likelihood.normalEquations(isExact ? Noise{} : sigma, right);
    factors.compute(normal);
    const Vector6 step = factors.solve(right);
    if (!step.allFinite())
    {
      break;
    }
    const Eigen::Vector3d turn = step.head<3>(), centre = likelihood.centre_Lines();
    const Eigen::Matrix3d turned = rotationFromVector(turn);
    result.pointsToLines.linear() = nearestRotation(turned * result.pointsToLines.linear());
    result.pointsToLines.translation() = centre + turned * (result.pointsToLines.translation() - centre) + step.tail<3>();
    ++result.iterations;
    isConverged = turn.norm() < NearlyStill;
    if (turn.norm() < Still && (isGiven || round >= NoiseRounds))
    {
      break;
    }
  }
  likelihood.linearize(result.pointsToLines);
  Vector6 right;
  const bool isExact = !(sigma.squareMm + sigma.squareRad > 1e-24);
  const Matrix6 aboutCentre = likelihood.normalEquations(isExact ? Noise{} : sigma, right).inverse();
  Matrix6 aboutOrigin = Matrix6::Identity();
  aboutOrigin.bottomLeftCorner<3, 3>() = skew(likelihood.centre_Lines());
  result.covariance = (isExact ? 0 : 1) * aboutOrigin * aboutCentre * aboutOrigin.transpose();
  result.sigmaMm = isExact ? 0 : std::sqrt(sigma.squareMm);
  result.sigmaRad = isExact ? 0 : std::sqrt(sigma.squareRad);
  if (!isConverged || !result.covariance.allFinite() || !result.pointsToLines.matrix().allFinite())
  {
    result.status = PointLineResult::Status::NotConverged;
    result.message = "the most likely solution was not reached: with this noise the data leave it open";
    return;
  }
  const double freedoms = std::max(1.0, 2.0 * double(pairs.size()) - 6);
  const double misfit = isExact ? 0 : std::sqrt(likelihood.squares(sigma, sigma) / freedoms);
  if (isGiven && options.maximumMisfit > 0 && misfit > options.maximumMisfit)
  {
    result.status = PointLineResult::Status::PoorFit;
    result.message = "the residuals are " + significantDigits(misfit, 2) +
      " times what the given noise explains: some points do not belong to their lines, or the noise is larger";
  }
  if (options.linesAreRays && !areMostInFront(pairs, result.pointsToLines))
  {
    result.status = PointLineResult::Status::Mirrored;
    result.message = "the most likely solution has the points behind the camera: points and rays do not belong together";
  }
}

}  // namespace handeye
