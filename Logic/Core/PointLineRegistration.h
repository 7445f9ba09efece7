// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace handeye
{

/// A point of one frame (`Points`) that must lie on a line of another (`Lines`); mm.
struct PointLinePair
{
  Eigen::Vector3d point_Points = Eigen::Vector3d::Zero();
  Eigen::Vector3d origin_Lines = Eigen::Vector3d::Zero();      ///< any point of the line
  Eigen::Vector3d direction_Lines = Eigen::Vector3d::UnitZ();  ///< any length but zero
  double weight = 1;                                           ///< of the squared distance, positive
};

struct PointLineOptions
{
  enum class Method
  {
    Global,     ///< the quadratic form, minimised on SO(3) from starts all over it
    Procrustes  ///< the paper's iteration: closest points on the lines, then orthogonal Procrustes; knows no weights
  };

  Method method = Method::Global;
  /// The lines are rays: their points lie at origin + s * direction with s > 0. A minimum that has more points behind than in front
  /// of the origins is a mirrored one and is not taken, however small its cost.
  bool linesAreRays = false;
  /// Cap of the `Procrustes` iteration.
  int maximumIterations = 20000;
  /// The `Procrustes` iteration has converged when its root mean square distance changes by less than this (mm).
  double tolerance = 1e-12;

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

struct PointLineResult
{
  enum class Status
  {
    Ok,
    TooFewPairs,    ///< fewer than 4
    NotObservable,  ///< parallel lines, points on one line or the like: see message
    NotConverged,   ///< the iteration reached its cap
    Mirrored,       ///< rays: every minimum found has most points behind the rays' origins
    Ambiguous       ///< rays: two different minima with practically the same cost and all points in front
  };

  Status status = Status::TooFewPairs;
  std::string message;  ///< for a person
  Eigen::Isometry3d pointsToLines =
    Eigen::Isometry3d::Identity();  ///< p_Lines = pointsToLines * p_Points; meaningless unless usable
  std::vector<double> residualsMm;  ///< distance of each moved point to its line
  double rmsMm = 0;
  int iterations = 0;   ///< of `Procrustes`; of `Global` the Newton steps of all starts together
  int minimaCount = 0;  ///< different local minima that `Global` found
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();  ///< see informationMatrix()
  double conditionNumber = 0;  ///< of the information matrix, rotations measured at the spread of the points

  bool isUsable() const { return status == Status::Ok; }
};

/// Finds the rotation R and translation t that bring points onto lines: the minimum of  sum_i w_i |V_i (R x_i + t - o_i)|^2  with
/// V_i = I - d_i d_i^T. The lines need not meet in one point.
///
/// `Global` eliminates t, which leaves a quadratic form in the nine entries of R whose size does not depend on the number of
/// points, and descends on it by Newton's method from starts all over SO(3); the lowest minimum wins, for rays the lowest one whose
/// points lie in front. `Procrustes` is the iteration of the paper, which starts without a guess and may end in the mirrored
/// minimum.
///
/// @param pairs at least 4
/// @throws std::invalid_argument if a number is not finite, a direction is zero, a weight is not positive or the options do not
///        check Thread-safe. References: Morgan et al., Int J CARS 12:1141 (2017), appendix; Terzakis and Lourakis, "A consistently
///        fast and globally optimal solution to the perspective-n-point problem", ECCV 2020, eq. 8-12 for the quadratic form of
///        rays through one centre.
[[nodiscard]] PointLineResult registerPointsToLines(const std::vector<PointLinePair>& pairs, const PointLineOptions& options = {});

/// Second derivative (halved) of the cost at a solution by (rotation vector, translation), both acting from the left in the frame
/// `Lines`: R -> exp(w) R, t -> t + v.
Eigen::Matrix<double, 6, 6> informationMatrix(const std::vector<PointLinePair>& pairs, const Eigen::Isometry3d& pointsToLines);

/// "ok", "too_few_pairs", ...: the word that result files use.
std::string toString(PointLineResult::Status status);

}  // namespace handeye
