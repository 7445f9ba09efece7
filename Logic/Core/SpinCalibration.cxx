// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SpinCalibration.h"

#include "NumberWords.h"
#include "PivotMethods.h"
#include "Statistics.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace handeye
{

namespace
{

using Status = SpinCalibrationResult::Status;

constexpr double Degrees = 180 / EIGEN_PI;
constexpr int ConsensusDraws = 100;
constexpr std::size_t ScoredPoses = 96;
constexpr int RejectionRounds = 20;
/// Relative rotations by less (rad) have no axis to speak of.
constexpr double LeastTurn = 0.2;
/// Shafts that are this near to the mean (rad) are never thrown out.
constexpr double ResolutionRad = 0.005;
/// The tip's direction must have this much (cosine) along the axis to tell which end of it is the tip's.
constexpr double LeastCosine = 0.3;
/// With residuals (mm, root mean square) below this, the line about which the stylus turned stood still.
constexpr double StillAxisMm = 2;

struct Shaft
{
  Eigen::Vector3d axis_Stylus = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d eigenvalues = Eigen::Vector3d::Zero();
};

Shaft leastTurned(const PivotPoses& poses, const std::vector<int>& subset)
{
  PivotSums sums;
  for (int i : subset)
  {
    sums.add(poses[std::size_t(i)]);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(sums.spread());
  return { spread.eigenvectors().col(0), spread.eigenvalues().cwiseMax(0) };
}

/// How far (rad, small) the shaft of each pose is from a direction.
std::vector<double> deviations(
  const PivotPoses& poses, const std::vector<int>& subset, const Eigen::Vector3d& axis_Stylus, const Eigen::Vector3d& axis_Tracker)
{
  std::vector<double> angles;
  angles.reserve(subset.size());
  for (int i : subset)
  {
    const Eigen::Vector3d turned = poses[std::size_t(i)].linear() * axis_Stylus;
    angles.push_back(2 * std::asin(std::min(1.0, (turned - axis_Tracker).norm() / 2)));
  }
  return angles;
}

/// The axis of a relative rotation that most poses share; nothing if no two poses are turned enough.
std::optional<Eigen::Vector3d> consensus(const PivotPoses& poses, const std::vector<int>& different)
{
  std::mt19937 random(20170420);
  std::vector<int> scored = different;
  std::shuffle(scored.begin(), scored.end(), random);
  scored.resize(std::min(scored.size(), ScoredPoses));
  std::uniform_int_distribution<std::size_t> any(0, scored.size() - 1);
  std::optional<Eigen::Vector3d> best;
  double bestMedian = std::numeric_limits<double>::infinity();
  for (int draw = 0; draw < ConsensusDraws; ++draw)
  {
    const Eigen::Isometry3d& a = poses[std::size_t(scored[any(random)])];
    const Eigen::Isometry3d& b = poses[std::size_t(scored[any(random)])];
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(a.linear().transpose() * b.linear()));
    if (turn.angle() < LeastTurn)
    {
      continue;
    }
    const double typical = median(deviations(poses, scored, turn.axis(), a.linear() * turn.axis()));
    if (typical < bestMedian)
    {
      bestMedian = typical;
      best = turn.axis();
    }
  }
  return best;
}

/// Throws out poses whose shaft points elsewhere, until nothing changes.
Shaft refine(
  const PivotPoses& poses, const std::vector<int>& different, const Eigen::Vector3d& start, double factor, std::vector<int>& used)
{
  Shaft shaft{ start, Eigen::Vector3d::Zero() };
  used = different;
  for (int round = 0; round < RejectionRounds; ++round)
  {
    std::vector<double> coordinates[3];
    for (int i : used)
    {
      const Eigen::Vector3d turned = poses[std::size_t(i)].linear() * shaft.axis_Stylus;
      for (int k = 0; k < 3; ++k)
      {
        coordinates[k].push_back(turned(k));
      }
    }
    const Eigen::Vector3d middle =
      Eigen::Vector3d(median(coordinates[0]), median(coordinates[1]), median(coordinates[2])).normalized();
    const std::vector<double> angles = deviations(poses, different, shaft.axis_Stylus, middle);
    const double limit = std::max(ResolutionRad, factor * median(angles) / MedianOfChi2);
    std::vector<int> kept;
    for (std::size_t k = 0; k < different.size(); ++k)
    {
      if (angles[k] <= limit)
      {
        kept.push_back(different[k]);
      }
    }
    shaft = leastTurned(poses, kept);
    if (kept == used)
    {
      break;
    }
    used = kept;
  }
  return shaft;
}

void refuse(SpinCalibrationResult& result, Status status, const std::string& message)
{
  result.status = status;
  result.message = message;
}

void judge(const SpinCalibrationOptions& options, double cosine, SpinCalibrationResult& result)
{
  const std::string wobble = fixedDigits(result.wobble * Degrees, 1) + " deg",
                    spin = fixedDigits(result.spin * Degrees, 1) + " deg";
  if (result.spin < options.minimumSpin)
  {
    refuse(result, Status::TooLittleSpin,
      "the stylus was hardly turned (" + spin + " RMS): spin it about its shaft by 90 deg or more, to and fro");
  }
  else if (result.wobble > options.maximumWobble || result.wobble > options.maximumWobbleShare * result.spin)
  {
    refuse(result, Status::NotOneAxis,
      "the shaft itself leant by " + wobble + " (RMS) while the stylus was spun by " + spin +
        ": keep the shaft where it is and turn the stylus about it");
  }
  else if (!(std::abs(cosine) >= LeastCosine))
  {
    refuse(result, Status::UnclearDirection,
      "the axis about which the stylus was turned runs " + fixedDigits(std::acos(std::min(1.0, std::abs(cosine))) * Degrees, 0) +
        " deg from the direction of its tip: it was not spun about its shaft, or the tip is another stylus'");
  }
  else
  {
    result.status = Status::Ok;
    result.message = "shaft found to " + fixedDigits(result.shaftSigma * Degrees, 3) + " deg from " +
      std::to_string(result.used.size()) + " poses, spun by " + spin + " RMS with " + wobble + " of wobble";
  }
}

void checkInput(const PivotPoses& poses, const Eigen::Vector3d& tip_Stylus)
{
  for (std::size_t i = 0; i < poses.size(); ++i)
  {
    if (!poses[i].matrix().allFinite())
    {
      throw std::invalid_argument("spin calibration: pose " + std::to_string(i) + " holds a number that is not finite");
    }
  }
  if (!tip_Stylus.allFinite())
  {
    throw std::invalid_argument("spin calibration: the tip is not finite");
  }
}

}  // namespace

void SpinCalibrationOptions::check() const
{
  if (minimumPoses < 3 || !(minimumSpin > 0) || !(maximumWobble > 0) || !(maximumWobbleShare > 0) || !(rejectionFactor > 1))
  {
    throw std::invalid_argument(
      "spin calibration options: at least 3 poses, a rejection factor above 1 and positive limits are expected");
  }
}

SpinCalibrationResult calibrateSpin(
  const PivotPoses& stylusToTracker, const Eigen::Vector3d& tip_Stylus, const SpinCalibrationOptions& options)
{
  options.check();
  checkInput(stylusToTracker, tip_Stylus);
  SpinCalibrationResult result;
  std::vector<int> different;
  findRepeated(stylusToTracker, different, result.rejected);
  if (int(different.size()) < options.minimumPoses)
  {
    result.message = "only " + std::to_string(different.size()) + " different valid poses, at least " +
      std::to_string(options.minimumPoses) + " are needed";
    return result;
  }
  const std::optional<Eigen::Vector3d> start = consensus(stylusToTracker, different);
  result.used = different;
  const Shaft shaft = start ? refine(stylusToTracker, different, *start, options.rejectionFactor, result.used)
                            : leastTurned(stylusToTracker, different);
  std::set_difference(
    different.begin(), different.end(), result.used.begin(), result.used.end(), std::back_inserter(result.rejected));
  std::sort(result.rejected.begin(), result.rejected.end());

  result.wobble = std::sqrt(shaft.eigenvalues(0));
  result.spin = std::sqrt(shaft.eigenvalues(1));
  result.shaftSigma = result.spin > 0 ? result.wobble / (result.spin * std::sqrt(double(result.used.size()))) : 0;
  const double along = tip_Stylus.dot(shaft.axis_Stylus);
  result.shaft_Stylus = along > 0 ? Eigen::Vector3d(-shaft.axis_Stylus) : shaft.axis_Stylus;
  const PivotSolution line = solveOneStep(stylusToTracker, result.used);
  double squares = 0;
  for (int i : result.used)
  {
    squares += (stylusToTracker[std::size_t(i)] * line.tip_Stylus - line.pivot_Tracker).squaredNorm();
  }
  if (std::sqrt(squares / double(result.used.size())) < StillAxisMm)
  {
    const Eigen::Vector3d fromLine = tip_Stylus - line.tip_Stylus;
    result.tipToAxisMm = (fromLine - fromLine.dot(shaft.axis_Stylus) * shaft.axis_Stylus).norm();
  }
  judge(options, tip_Stylus.norm() > 0 ? along / tip_Stylus.norm() : 0, result);
  if (result.isUsable())
  {
    result.stylusTipToStylus = tipFrame(tip_Stylus, result.shaft_Stylus);
  }
  return result;
}

Eigen::Isometry3d tipFrame(const Eigen::Vector3d& tip_Stylus, const Eigen::Vector3d& shaft_Stylus)
{
  if (!(shaft_Stylus.norm() > 0) || !shaft_Stylus.allFinite() || !tip_Stylus.allFinite())
  {
    throw std::invalid_argument("a tip's frame: a finite tip and a shaft of some length are expected");
  }
  const Eigen::Vector3d z_Stylus = -shaft_Stylus.normalized();
  Eigen::Index most = 0;
  z_Stylus.cwiseAbs().minCoeff(&most);
  const Eigen::Vector3d across = Eigen::Vector3d::Unit(most);
  const Eigen::Vector3d x_Stylus = (across - across.dot(z_Stylus) * z_Stylus).normalized();
  Eigen::Isometry3d stylusTipToStylus = Eigen::Isometry3d::Identity();
  stylusTipToStylus.linear() << x_Stylus, z_Stylus.cross(x_Stylus), z_Stylus;
  stylusTipToStylus.translation() = tip_Stylus;
  return stylusTipToStylus;
}

std::string toString(Status status)
{
  switch (status)
  {
    case Status::Ok:
      return "ok";
    case Status::TooFewPoses:
      return "too_few_poses";
    case Status::TooLittleSpin:
      return "too_little_spin";
    case Status::NotOneAxis:
      return "not_one_axis";
    case Status::UnclearDirection:
      return "unclear_direction";
  }
  return "unknown";
}

}  // namespace handeye
