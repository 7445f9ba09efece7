// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EpipolarSearch.h"

#include "EpipolarCell.h"
#include "EpipolarProgram.h"
#include "RigidTransform.h"

#include <chrono>
#include <queue>

namespace handeye
{

namespace
{

/// Below this the slack of EpipolarCellProgram, which is of second order, is worth its price.
constexpr double SmallReachRad = 0.1;

/// A cube of rotation vectors.
struct Cube
{
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double halfSide = EIGEN_PI;
  double lowerBoundRad = 0;
  Eigen::Vector3d center_Marker = Eigen::Vector3d::Zero();  ///< a good one for the cube that this is part of
  /// A box that holds the centres of all solutions that matter; not yet looked for where it has no size.
  Eigen::Vector3d boxMiddle_Marker = Eigen::Vector3d::Zero(), boxHalfMm = Eigen::Vector3d::Zero();

  /// No rotation in the cube differs from that of its middle by more than this: |log(A B^T)| <= |log A - log B|.
  double reachRad() const { return std::sqrt(3.0) * halfSide; }
};

/// The least bound first, then the largest: what holds the proof back.
struct IsLessUrgent
{
  bool operator()(const Cube& a, const Cube& b) const
  {
    return a.lowerBoundRad != b.lowerBoundRad ? a.lowerBoundRad > b.lowerBoundRad : a.halfSide < b.halfSide;
  }
};

class Search
{
public:
  Search(const std::vector<EpipolarPair>& pairs, const BoardHandEyeOptions& options, const BranchAndBoundProgress& progress)
    : pairs_(pairs)
    , options_(options)
    , progress_(progress)
    , program_(pairs, options.maximumOffsetMm)
    , cells_(pairs)
    , start_(std::chrono::steady_clock::now())
  {
  }

  EpipolarSearchResult run(const std::optional<Eigen::Isometry3d>& start)
  {
    if (start)
    {
      const Eigen::Vector3d center_Marker = -(start->linear().transpose() * start->translation());
      if (center_Marker.cwiseAbs().maxCoeff() <= options_.maximumOffsetMm)
      {
        offer({ start->linear(), center_Marker, epipolarErrorRad(pairs_, start->linear(), center_Marker) });
      }
      descend(start->linear());
    }
    queue_.push(Cube());
    while (!queue_.empty() && !isStopped())
    {
      const Cube cube = queue_.top();
      queue_.pop();
      if (cube.lowerBoundRad >= threshold())
      {
        provenRad_ = std::min(provenRad_, cube.lowerBoundRad);
        continue;
      }
      divide(cube);
    }
    return finish();
  }

private:
  /// What a better solution would have to fall below to matter.
  double threshold() const
  {
    const double error = best_ ? best_->errorRad : EIGEN_PI / 2;
    return std::max(0.0, error - std::max(options_.gapRad, options_.relativeGap * error));
  }

  void offer(const EpipolarSolution& solution)
  {
    if (std::isfinite(solution.errorRad) && (!best_ || solution.errorRad < best_->errorRad))
    {
      best_ = solution;
    }
  }

  void divide(const Cube& cube)
  {
    for (int k = 0; k < 8 && !isOutOfTime_; ++k)
    {
      Cube part = cube;
      part.halfSide = cube.halfSide / 2;
      part.middle += part.halfSide * Eigen::Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
      ++state_.cubes;
      if (part.middle.norm() - part.reachRad() <= EIGEN_PI)  // beyond pi every rotation comes again
      {
        examine(part);
      }
    }
    if (isOutOfTime_)  // parts that nobody looked at
    {
      openRad_ = std::min(openRad_, cube.lowerBoundRad);
    }
  }

  /// Bounds a cube from below, and tries its middle.
  void examine(Cube cube)
  {
    const Eigen::Matrix3d rotation = rotationFromVector(cube.middle);
    const double reach = cube.reachRad(), wanted = threshold();
    double error = epipolarErrorRad(pairs_, rotation, cube.center_Marker);
    if (error > wanted + reach)  // otherwise no program has to say that there is such a centre
    {
      const std::optional<Eigen::Vector3d> center = program_.solve(rotation, wanted + reach);
      if (!center)
      {
        provenRad_ = std::min(provenRad_, wanted);
        return;
      }
      cube.center_Marker = *center;
      error = epipolarErrorRad(pairs_, rotation, *center);
    }
    if (!best_ || error < best_->errorRad || (reach < 0.1 && error < best_->errorRad + 0.3 * reach && shouldDescend(cube.middle)))
    {
      offer({ rotation, cube.center_Marker, error });
      descend(rotation);
    }
    if (reach < SmallReachRad && !narrow(cube, rotation, wanted))
    {
      provenRad_ = std::min(provenRad_, wanted);
      return;
    }
    raiseBound(cube, rotation, wanted);
    queue_.push(cube);
  }

  /// Small cubes by what rotation and centre do together. @return false where the cube holds nothing below the bound
  bool narrow(Cube& cube, const Eigen::Matrix3d& rotation, double wanted)
  {
    const double reach = cube.reachRad();
    if (cube.boxHalfMm.isZero())
    {
      cube.boxHalfMm.setConstant(options_.maximumOffsetMm);
    }
    if (!program_.boxOfCenters(rotation, wanted + reach, cube.boxMiddle_Marker, cube.boxHalfMm))
    {
      return false;
    }
    EpipolarCell cell{ rotation, reach, cube.boxMiddle_Marker, cube.boxHalfMm };
    const bool isOpen = cells_.narrow(cell, wanted);
    cube.boxMiddle_Marker = cell.center_Marker;
    cube.boxHalfMm = cell.halfWidthsMm;
    return isOpen;
  }

  /// A further program where it may raise the bound that the cube hands on.
  void raiseBound(Cube& cube, const Eigen::Matrix3d& rotation, double wanted)
  {
    const double reach = cube.reachRad();
    for (const double share : { 0.9, 0.7, 0.4 })
    {
      const double bound = share * wanted;
      const bool mayBeExcluded = bound > cube.lowerBoundRad && (reach < SmallReachRad || reach < 2 * wanted);
      if (mayBeExcluded &&
        (reach < SmallReachRad ? cells_.excludes({ rotation, reach, cube.boxMiddle_Marker, cube.boxHalfMm }, bound)
                               : !program_.solve(rotation, bound + reach)))
      {
        cube.lowerBoundRad = bound;
        break;
      }
    }
  }

  /// Not again where a descent began nearby.
  bool shouldDescend(const Eigen::Vector3d& middle)
  {
    for (const Eigen::Vector3d& earlier : descents_)
    {
      if ((earlier - middle).norm() < 0.15)
      {
        return false;
      }
    }
    descents_.push_back(middle);
    return true;
  }

  /// Pattern search over the rotation, the best centre for each: the bound from above.
  void descend(const Eigen::Matrix3d& start)
  {
    EpipolarSolution here = program_.minimize(start, best_ ? best_->errorRad : 0.1);
    offer(here);
    for (double step = 0.02; step > 1e-8 && !checkTime();)
    {
      bool isBetter = false;
      for (int k = 0; k < 6 && !isBetter; ++k)
      {
        const Eigen::Vector3d turn = (k % 2 == 0 ? step : -step) * Eigen::Vector3d::Unit(k / 2);
        const Eigen::Matrix3d rotation = nearestRotation(rotationFromVector(turn) * here.markerToCamera);
        if (!program_.solve(rotation, 0.999 * here.errorRad))
        {
          continue;
        }
        const EpipolarSolution next = program_.minimize(rotation, 0.999 * here.errorRad);
        isBetter = next.errorRad < 0.9995 * here.errorRad;
        here = isBetter ? next : here;
      }
      step *= isBetter ? 1.3 : 0.4;
    }
    offer(here);
  }

  double elapsedSec() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

  bool checkTime()
  {
    isOutOfTime_ = isOutOfTime_ || elapsedSec() > options_.timeLimitSec;
    return isOutOfTime_;
  }

  /// Also tells how far it is.
  bool isStopped()
  {
    const double now = elapsedSec();
    if (progress_ && now - lastReportSec_ > 0.1)
    {
      lastReportSec_ = now;
      isCancelled_ = isCancelled_ || !progress_(currentState());
    }
    return checkTime() || isCancelled_;
  }

  BranchAndBoundState currentState() const
  {
    BranchAndBoundState state = state_;
    state.linearPrograms = program_.solvedCount() + cells_.solvedCount();
    state.elapsedSec = elapsedSec();
    state.bestErrorRad = best_ ? best_->errorRad : 0;
    const double waiting = queue_.empty() ? openRad_ : std::min(openRad_, queue_.top().lowerBoundRad);
    state.lowerBoundRad = std::min({ provenRad_, waiting, state.bestErrorRad });
    state.gapRad = state.bestErrorRad - state.lowerBoundRad;
    return state;
  }

  EpipolarSearchResult finish()
  {
    EpipolarSearchResult result;
    result.solution = best_;
    result.state = currentState();
    result.state.isProven = best_ && !isOutOfTime_ && !isCancelled_;
    result.isCancelled = isCancelled_;
    return result;
  }

  const std::vector<EpipolarPair>& pairs_;
  const BoardHandEyeOptions& options_;
  const BranchAndBoundProgress& progress_;
  EpipolarProgram program_;
  EpipolarCellProgram cells_;
  std::chrono::steady_clock::time_point start_;
  std::priority_queue<Cube, std::vector<Cube>, IsLessUrgent> queue_;
  std::optional<EpipolarSolution> best_;
  std::vector<Eigen::Vector3d> descents_;
  BranchAndBoundState state_;
  double provenRad_ = std::numeric_limits<double>::infinity();  ///< least bound of what was left out
  double openRad_ = std::numeric_limits<double>::infinity();    ///< least bound of what could not be looked at
  double lastReportSec_ = 0;
  bool isOutOfTime_ = false;
  bool isCancelled_ = false;
};

}  // namespace

EpipolarSearchResult searchEpipolar(const std::vector<EpipolarPair>& pairs, const std::optional<Eigen::Isometry3d>& start,
  const BoardHandEyeOptions& options, const BranchAndBoundProgress& progress)
{
  return Search(pairs, options, progress).run(start);
}

}  // namespace handeye
