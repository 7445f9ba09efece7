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
  Eigen::Vector3d origin_Lines = Eigen::Vector3d::Zero();      ///< any point of the line; of a ray, where it begins
  Eigen::Vector3d direction_Lines = Eigen::Vector3d::UnitZ();  ///< any length but zero
  double weight = 1;  ///< of the squared distance, positive; `ml` takes the noise instead, the others but `global` know no weights
};

/// How well a point and a line are known, in units of the options' sigmas: covariances of the point and of the line's unit
/// direction, symmetric and without negative eigenvalues. What a direction's covariance says along the line is not used.
struct PointLineNoise
{
  Eigen::Matrix3d point_Points = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d direction_Lines = Eigen::Matrix3d::Identity();
};

struct PointLineOptions
{
  enum class Method
  {
    Global,               ///< the quadratic form, minimised on SO(3) for its global minimum
    Procrustes,           ///< the paper's iteration: closest points on the lines, then orthogonal Procrustes
    MaximumLikelihood,    ///< `Global`, then maximum likelihood with the noise of points and directions
    OrthogonalIteration,  ///< Lu, Hager and Mjolsness: the best translation in closed form, then orthogonal Procrustes
    ProcrustesPnP,        ///< Garro, Crosilla and Fusiello; one common centre, depths not negative
    Epnp,                 ///< OpenCV's; one common centre
    Sqpnp,                ///< OpenCV's; one common centre
    Iterative             ///< OpenCV's Levenberg-Marquardt on the reprojection error; one common centre
  };

  Method method = Method::Global;
  /// The lines are rays: their points lie at origin + s * direction with s > 0. A minimum that has more points behind than in front
  /// of the origins is a mirrored one and is not taken, however small its cost.
  bool linesAreRays = false;
  /// Of `Global` and `MaximumLikelihood`: look for every minimum, and call two ambiguous when noise alone may have made one of them the
  /// lower: when their costs differ by less than 9 times the variance that the residuals show. Half a millisecond more. Without it a
  /// minimum that is proven to be the lowest is taken, and rivals are those of the same cost.
  bool findRivals = false;
  /// Cap of the iterations of `Procrustes`, `OrthogonalIteration` and `ProcrustesPnP`.
  int maximumIterations = 20000;
  /// They have converged when their root mean square distance changes by less than this (mm).
  double tolerance = 1e-12;
  /// Of `MaximumLikelihood`: noise of the points (mm per axis) and of the directions (rad per axis; of rays only, since it
  /// acts from their origins). Both 0: their scale and their
  /// ratio are estimated from the residuals.
  double sigmaMm = 0;
  double sigmaRad = 0;
  /// Of `MaximumLikelihood`: a residual above this multiple of its standard deviation counts linearly instead of squared (Huber).
  double robustFactor = 4;
  /// Of `MaximumLikelihood` with given noise: a scatter above this multiple of it is a poor fit; 0: not judged.
  double maximumMisfit = 0;
  /// A root mean square distance above this share of the points' spread is a poor fit, whatever the noise.
  double maximumRelativeRms = 0.25;

  /// Look for pairs that disagree with the rest, from 8 pairs on, and leave them out (sets of four, least median of distances, then
  /// 4.5 times the scatter of those that agree; only where that lowers the scatter 2.5 times, or where each of them is that far
  /// off, and further with few pairs).
  bool rejectOutliers = false;

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

struct PointLineResult
{
  enum class Status
  {
    Ok,
    TooFewPairs,    ///< fewer than 4; for 3 `solutions` holds all that fit
    NotObservable,  ///< parallel lines, points on one line or the like: see message
    NotConverged,   ///< the iteration reached its cap
    Mirrored,       ///< rays: every minimum found has most points behind the rays' origins
    Ambiguous,      ///< two different minima with practically the same cost and all points in front: see `solutions`
    PoorFit,        ///< the best solution does not bring the points onto the lines
    NotApplicable   ///< the method needs rays of one centre within a half space
  };

  Status status = Status::TooFewPairs;
  std::string message;  ///< for a person
  Eigen::Isometry3d pointsToLines =
    Eigen::Isometry3d::Identity();  ///< p_Lines = pointsToLines * p_Points; meaningless unless usable
  /// Where more than one minimum fits practically as well as the best one: all of those, the best first. Otherwise empty.
  std::vector<Eigen::Isometry3d> solutions;
  std::vector<double> residualsMm;  ///< distance of each moved point to its line
  std::vector<int> rejected;        ///< indices of the pairs that were left out, with `rejectOutliers`
  double rmsMm = 0;                 ///< of the pairs that were not left out
  int iterations = 0;               ///< of the iterative methods; of `Global` the Newton steps of all starts together
  int minimaCount = 0;  ///< different local minima that `Global` looked at; 1 where the first one is proven to be the global one
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();  ///< see informationMatrix()
  double conditionNumber = 0;  ///< of the information matrix about the points' centroid, rotations measured at their spread
  int rank = 0;                ///< freedoms that are determined, 6 if all; the first that is not is in the message
  /// Of `MaximumLikelihood`: covariance of (rotation vector rad, translation mm), acting from the left in the frame `Lines`, and
  /// the noise it rests on, given or estimated.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  double sigmaMm = 0;
  double sigmaRad = 0;

  bool isUsable() const { return status == Status::Ok; }
};

/// Finds the rotation R and translation t that bring points onto lines: the minimum of  sum_i w_i |V_i (R x_i + t - o_i)|^2  with
/// V_i = I - d_i d_i^T. The lines need not meet in one point.
///
/// `Global` eliminates t, which leaves a quadratic form in the nine entries of R whose size does not depend on the number of
/// points. Newton's method on SO(3) descends from the form's minimum over all nine numbers; a convex Lagrangian proves that the
/// minimum found is the global one, which for six points and more it nearly always does. Where it does not, 60 starts all over
/// SO(3) follow; the lowest minimum wins, for rays the lowest one whose points lie in front. Nothing is allocated on the way to a
/// proven minimum but the result's own lists. `MaximumLikelihood` goes on from there and minimises sum_i e_i^T C_i^-1 e_i, e_i
/// being the two coordinates of the distance across the line and C_i the covariance that the point's noise and the direction's,
/// times the distance, give it; C_i follows the solution. The others are there for comparison.
///
/// @param pairs at least 4
/// @param noise of `MaximumLikelihood`: one per pair, or empty where all are alike
/// @throws std::invalid_argument, naming the pair (counted from 1), if a number is not finite, a direction is zero, a weight is not
///         positive or a covariance is none; if the sizes differ; if the options do not check
/// Thread-safe.
/// References: Morgan et al., Int J CARS 12:1141 (2017), appendix. Terzakis and Lourakis, "A consistently fast and globally optimal
/// solution to the perspective-n-point problem", ECCV 2020, eq. 8-12 for the quadratic form of rays through one centre. Lu, Hager
/// and Mjolsness, "Fast and globally convergent pose estimation from video images", PAMI 22:610 (2000), eq. 20-24. Garro, Crosilla
/// and Fusiello, "Solving the PnP problem with anisotropic orthogonal Procrustes analysis", 3DIMPVT 2012, algorithm 1.
[[nodiscard]] PointLineResult registerPointsToLines(const std::vector<PointLinePair>& pairs, const PointLineOptions& options = {});
[[nodiscard]] PointLineResult registerPointsToLines(
  const std::vector<PointLinePair>& pairs, const std::vector<PointLineNoise>& noise, const PointLineOptions& options);

/// Second derivative (halved) of the cost at a solution by (rotation vector, translation), both acting from the left in the frame
/// `Lines`: R -> exp(w) R, t -> t + v.
Eigen::Matrix<double, 6, 6> informationMatrix(const std::vector<PointLinePair>& pairs, const Eigen::Isometry3d& pointsToLines);

/// "ok", "too_few_pairs", ...: the word that result files use.
std::string toString(PointLineResult::Status status);

/// "global", "procrustes", "ml", "oi", "ppnp", "epnp", "sqpnp", "iterative": the word of `--method`.
std::string toString(PointLineOptions::Method method);

}  // namespace handeye
