// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "PivotCalibration.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace handeye
{

/// The mathematics of calibratePivot(), which says what the frames and the equations are. Internal; all functions are thread-safe.

using PivotPoses = std::vector<Eigen::Isometry3d>;

struct PivotSolution
{
  Eigen::Vector3d tip_Stylus = Eigen::Vector3d::Zero();
  Eigen::Vector3d pivot_Tracker = Eigen::Vector3d::Zero();
  Eigen::Matrix3d tipCovariance = Eigen::Matrix3d::Zero();  ///< mm^2
};

/// Sums over poses from which the algebraic one-step method and the spread of the rotations follow; of fixed size.
class PivotSums
{
public:
  void add(const Eigen::Isometry3d& stylusToTracker);

  double count() const { return count_; }

  /// sum (R_i - mean R)^T (R_i - mean R) / n: its eigenvalues say how much each direction of the tip was moved.
  Eigen::Matrix3d spread() const;

  /// The least squares; of the tips that do equally well the one nearest to the marker.
  PivotSolution solve() const;

private:
  double count_ = 0;
  Eigen::Matrix3d rotations_ = Eigen::Matrix3d::Zero();        ///< sum R
  Eigen::Matrix3d products_ = Eigen::Matrix3d::Zero();         ///< sum R^T R: not quite n times 1 where poses come as float
  Eigen::Vector3d positions_ = Eigen::Vector3d::Zero();        ///< sum t
  Eigen::Vector3d turnedPositions_ = Eigen::Vector3d::Zero();  ///< sum R^T t
  double squares_ = 0;                                         ///< sum |t|^2
  Eigen::Vector3d origin_Tracker_ = Eigen::Vector3d::Zero();   ///< positions count from the first one, to keep digits
};

/// The tip that three poses alone would give; nothing if they do not fix it.
std::optional<PivotSolution> solveTriple(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const Eigen::Isometry3d& c);

PivotSolution solveOneStep(const PivotPoses& poses, const std::vector<int>& subset);
PivotSolution solveTwoStep(const PivotPoses& poses, const std::vector<int>& subset);
PivotSolution solveSphereFit(const PivotPoses& poses, const std::vector<int>& subset);

/// A cell of about 6 deg in which a rotation lies, as a slot of a small table; cells that share one are taken together.
constexpr std::size_t OrientationCells = 4096;
std::size_t orientationCell(const Eigen::Matrix3d& rotation);

/// Bit for bit, which no two measurements of a tracker are.
bool isSamePose(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b);

/// Splits the poses into those that say something new and those that repeat an earlier one: a tracker that is asked faster than it
/// measures, or that froze.
void findRepeated(const PivotPoses& poses, std::vector<int>& different, std::vector<int>& repeated);

/// What the robust method found.
struct RobustPivot
{
  PivotSolution solution;
  std::vector<int> used;  ///< ascending
};

/// Sample consensus, rejection and maximum likelihood. @param subset the poses that may be used
RobustPivot solveRobust(const PivotPoses& poses, const std::vector<int>& subset, const PivotCalibrationOptions& options);

/// The variances (mm^2) that the noise model gives a residual along and across the shaft.
struct ResidualVariance
{
  double along = 0;
  double across = 0;
};

ResidualVariance residualVariance(const TrackerNoise& noise, double tipDistanceMm);

}  // namespace handeye
