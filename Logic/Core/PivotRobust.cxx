// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The robust method: consensus on triples, rejection against the noise of what stays, maximum likelihood.
#include "PivotMethods.h"
#include "Statistics.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace handeye
{

namespace
{

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// With 40 % of wrong poses a triple is good in 0.22 of the draws: 120 draws miss it once in 10^12.
constexpr int ConsensusDraws = 120;
/// Poses that judge a triple: enough for a median, few enough to be quick.
constexpr std::size_t ScoredPoses = 96;
constexpr int RejectionRounds = 20;
constexpr int LikelihoodSteps = 20;
/// Below this residual (mm) nothing is thrown out: no optical tracker resolves it.
constexpr double ResolutionMm = 0.01;

/// Some of the poses, spread over the orientations: one of each cell first, then a second one, ..., so that a stylus that
/// rested for most of the recording counts no more than one that moved.
std::vector<int> spreadOverOrientations(const PivotPoses& poses, const std::vector<int>& subset, std::mt19937& random)
{
  std::vector<int> shuffled = subset;
  std::shuffle(shuffled.begin(), shuffled.end(), random);
  std::array<std::uint16_t, OrientationCells> held{};
  std::vector<std::uint16_t> rank(shuffled.size());
  for (std::size_t k = 0; k < shuffled.size(); ++k)
  {
    std::uint16_t& count = held[orientationCell(poses[std::size_t(shuffled[k])].linear())];
    rank[k] = count;
    count = std::uint16_t(std::min(65534, count + 1));
  }
  std::vector<int> chosen;
  chosen.reserve(ScoredPoses);
  for (std::uint16_t round = 0; chosen.size() < std::min(ScoredPoses, subset.size()); ++round)
  {
    for (std::size_t k = 0; k < shuffled.size() && chosen.size() < ScoredPoses; ++k)
    {
      if (rank[k] == round)
      {
        chosen.push_back(shuffled[k]);
      }
    }
  }
  return chosen;
}

/// The triple of poses whose tip leaves the smallest median residual.
std::optional<PivotSolution> consensus(const PivotPoses& poses, const std::vector<int>& subset)
{
  std::mt19937 random(20170420);
  const std::vector<int> scored = spreadOverOrientations(poses, subset, random);
  std::uniform_int_distribution<int> any(0, int(scored.size()) - 1);
  std::optional<PivotSolution> best;
  double bestMedian = std::numeric_limits<double>::infinity();
  std::array<double, ScoredPoses> squares{};
  const auto middle = squares.begin() + std::ptrdiff_t((scored.size() - 1) / 2);
  for (int draw = 0; draw < ConsensusDraws; ++draw)
  {
    const int a = scored[std::size_t(any(random))], b = scored[std::size_t(any(random))], c = scored[std::size_t(any(random))];
    const std::optional<PivotSolution> candidate = solveTriple(poses[std::size_t(a)], poses[std::size_t(b)], poses[std::size_t(c)]);
    if (!candidate)
    {
      continue;
    }
    // A median above the best one is known as soon as half of the residuals are.
    std::size_t above = 0;
    for (std::size_t k = 0; k < scored.size() && 2 * above <= scored.size(); ++k)
    {
      squares[k] = (poses[std::size_t(scored[k])] * candidate->tip_Stylus - candidate->pivot_Tracker).squaredNorm();
      above += squares[k] > bestMedian ? 1 : 0;
    }
    if (2 * above > scored.size())
    {
      continue;
    }
    std::nth_element(squares.begin(), middle, squares.begin() + std::ptrdiff_t(scored.size()));
    if (*middle < bestMedian)
    {
      bestMedian = *middle;
      best = candidate;
    }
  }
  return best;
}

/// Residuals of all poses in units of the noise model: across and along the shaft, as one length.
struct Residuals
{
  std::vector<double> squares;    ///< |e|^2, mm^2
  std::vector<double> whitened;   ///< e^T C^-1 e
  std::vector<double> workspace;  ///< for medians
};

void measure(const PivotPoses& poses, const std::vector<int>& subset, const PivotSolution& solution, const TrackerNoise& noise,
  Residuals& residuals)
{
  const double length = solution.tip_Stylus.norm();
  const ResidualVariance expected = residualVariance(noise, length);
  const double across = 1 / expected.across;
  const double extra = length > 0 ? (1 / expected.along - across) / (length * length) : 0;
  for (std::size_t k = 0; k < subset.size(); ++k)
  {
    const Eigen::Isometry3d& pose = poses[std::size_t(subset[k])];
    const Eigen::Vector3d lever = pose.linear() * solution.tip_Stylus;
    const Eigen::Vector3d residual = lever + pose.translation() - solution.pivot_Tracker;
    const double alongLever = lever.dot(residual);
    residuals.squares[k] = residual.squaredNorm();
    residuals.whitened[k] = across * residuals.squares[k] + extra * alongLever * alongLever;
  }
}

/// Which poses stay: those within the factor of the noise per axis that the median shows. @return whether anything changed
bool reject(const std::vector<int>& subset, Residuals& residuals, double factor, std::vector<char>& kept)
{
  residuals.workspace = residuals.whitened;
  const auto middle = residuals.workspace.begin() + std::ptrdiff_t((residuals.workspace.size() - 1) / 2);
  std::nth_element(residuals.workspace.begin(), middle, residuals.workspace.end());
  const double sigma = std::sqrt(*middle) / MedianOfChi3;
  const double limit = factor * factor * sigma * sigma;
  bool changed = false;
  for (std::size_t k = 0; k < subset.size(); ++k)
  {
    const char stays = residuals.whitened[k] <= limit || residuals.squares[k] <= ResolutionMm * ResolutionMm ? 1 : 0;
    changed = changed || stays != kept[k];
    kept[k] = stays;
  }
  return changed;
}

/// One Gauss-Newton step of the likelihood (6 unknowns: tip_Stylus, pivot_Tracker), with W = C^-1 in the stylus' frame. @return its
/// length
double stepLikelihood(const PivotPoses& poses, const std::vector<int>& subset, const std::vector<char>& kept,
  const TrackerNoise& noise, PivotSolution& solution)
{
  const double length = solution.tip_Stylus.norm();
  const Eigen::Vector3d shaft = length > 0 ? Eigen::Vector3d(solution.tip_Stylus / length) : Eigen::Vector3d::UnitZ();
  const ResidualVariance expected = residualVariance(noise, length);
  const double across = 1 / expected.across, extra = 1 / expected.along - across;
  double count = 0;
  Eigen::Vector3d residuals_Stylus = Eigen::Vector3d::Zero(), weighted_Tracker = Eigen::Vector3d::Zero();
  Eigen::Matrix3d rotations = Eigen::Matrix3d::Zero(), shafts = Eigen::Matrix3d::Zero(), products = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < subset.size(); ++k)
  {
    if (kept[k] == 0)
    {
      continue;
    }
    const Eigen::Isometry3d& pose = poses[std::size_t(subset[k])];
    const Eigen::Vector3d shaft_Tracker = pose.linear() * shaft;
    const Eigen::Vector3d residual = length * shaft_Tracker + pose.translation() - solution.pivot_Tracker;
    const Eigen::Vector3d residual_Stylus = pose.linear().transpose() * residual;
    count += 1;
    residuals_Stylus += residual_Stylus;
    products.noalias() += residual_Stylus * residual_Stylus.transpose();
    rotations += pose.linear();
    shafts.noalias() += shaft_Tracker * shaft_Tracker.transpose();
    weighted_Tracker += across * residual + extra * shaft_Tracker.dot(residual) * shaft_Tracker;
  }
  const Eigen::Matrix3d shaftOnly = shaft * shaft.transpose();
  const Eigen::Matrix3d weight_Stylus = across * Eigen::Matrix3d::Identity() + extra * shaftOnly;
  Matrix6d normal;
  normal.topLeftCorner<3, 3>() = count * weight_Stylus;
  normal.topRightCorner<3, 3>() = -weight_Stylus * rotations.transpose();
  normal.bottomLeftCorner<3, 3>() = normal.topRightCorner<3, 3>().transpose();
  normal.bottomRightCorner<3, 3>() = across * count * Eigen::Matrix3d::Identity() + extra * shafts;
  // The weights turn and lengthen with the tip: their share of the gradient.
  Eigen::Vector3d ofWeights = Eigen::Vector3d::Zero();
  if (length > 0)
  {
    const Eigen::Vector3d alongProducts = products * shaft;
    const double squaresAlong = shaft.dot(alongProducts);
    ofWeights = extra / length * (alongProducts - squaresAlong * shaft);
    ofWeights -= noise.rotation * noise.rotation * length * across * across * (products.trace() - squaresAlong) * shaft;
  }
  Vector6d gradient;
  gradient << weight_Stylus * residuals_Stylus + ofWeights, -weighted_Tracker;
  const Vector6d step = normal.completeOrthogonalDecomposition().solve(gradient);
  solution.tip_Stylus -= step.head<3>();
  solution.pivot_Tracker -= step.tail<3>();
  solution.tipCovariance = normal.completeOrthogonalDecomposition().pseudoInverse().topLeftCorner<3, 3>();
  return step.norm();
}

}  // namespace

std::size_t orientationCell(const Eigen::Matrix3d& rotation)
{
  constexpr double cellsPerUnit = 10;
  std::uint32_t hash = 2166136261U;
  for (int column = 0; column < 2; ++column)
  {
    for (int row = 0; row < 3; ++row)
    {
      hash = (hash ^ std::uint32_t(std::int32_t(std::floor(cellsPerUnit * rotation(row, column))) + 64)) * 16777619U;
    }
  }
  return (hash ^ (hash >> 15)) % OrientationCells;
}

ResidualVariance residualVariance(const TrackerNoise& noise, double tipDistanceMm)
{
  const double along = noise.positionMm * noise.positionMm;
  const double sideways = noise.rotation * tipDistanceMm;
  return { along, along + sideways * sideways };
}

RobustPivot solveRobust(const PivotPoses& poses, const std::vector<int>& subset, const PivotCalibrationOptions& options)
{
  RobustPivot robust;
  const std::optional<PivotSolution> start = consensus(poses, subset);
  if (!start)
  {
    // No three poses fix a tip: the least squares say in which direction it is free.
    robust.solution = solveOneStep(poses, subset);
    robust.used = subset;
    return robust;
  }
  robust.solution = *start;
  Residuals residuals{ std::vector<double>(subset.size()), std::vector<double>(subset.size()), {} };
  std::vector<char> kept(subset.size(), 1);
  measure(poses, subset, robust.solution, options.noise, residuals);
  reject(subset, residuals, options.rejectionFactor, kept);
  for (int round = 0; round < RejectionRounds; ++round)
  {
    stepLikelihood(poses, subset, kept, options.noise, robust.solution);
    measure(poses, subset, robust.solution, options.noise, residuals);
    if (!reject(subset, residuals, options.rejectionFactor, kept))
    {
      break;
    }
  }
  for (int step = 0; step < LikelihoodSteps; ++step)
  {
    const double length = stepLikelihood(poses, subset, kept, options.noise, robust.solution);
    if (!(length > 1e-9 * (1 + robust.solution.tip_Stylus.norm())))
    {
      break;
    }
  }
  measure(poses, subset, robust.solution, options.noise, residuals);
  double squares = 0;
  for (std::size_t k = 0; k < subset.size(); ++k)
  {
    if (kept[k] != 0)
    {
      robust.used.push_back(subset[k]);
      squares += residuals.whitened[k];
    }
  }
  robust.solution.tipCovariance *= squares / std::max(1.0, 3 * double(robust.used.size()) - 6);
  return robust;
}

}  // namespace handeye
