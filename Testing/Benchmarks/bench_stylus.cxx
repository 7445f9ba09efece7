// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a pivot calibration of 1,000 poses costs, against one plain least-squares solve of the same 3,000 equations in six unknowns
// by Eigen (column-pivoting QR, the solver that its documentation recommends for least squares; and the normal equations, the
// fastest). Both run alternately in one process; ratio_to_eigen and ratio_to_eigen_normal are our time over theirs.
#include "PivotCalibration.h"
#include "PivotSimulation.h"

#include <Eigen/Dense>
#include <benchmark/benchmark.h>

#include <chrono>

namespace
{

using namespace handeye;
using Clock = std::chrono::steady_clock;
using Poses = std::vector<Eigen::Isometry3d>;

/// 1,000 poses over 35 deg with tracker noise, 5 % of them wrong.
Poses makePoses()
{
  test::Random random(1);
  Poses poses = test::PivotSimulation().recordPivoting(1000, 35 * test::Degree, random);
  for (std::size_t i = 0; i < poses.size(); i += 20)
  {
    poses[i].translation() += random.uniform(4, 60) * random.direction();
  }
  return poses;
}

/// [R_i  -1] (tip, pivot) = -t_i.
void buildEquations(const Poses& poses, Eigen::Matrix<double, Eigen::Dynamic, 6>& matrix, Eigen::VectorXd& right)
{
  matrix.resize(Eigen::Index(3 * poses.size()), 6);
  right.resize(Eigen::Index(3 * poses.size()));
  for (std::size_t i = 0; i < poses.size(); ++i)
  {
    matrix.block<3, 3>(Eigen::Index(3 * i), 0) = poses[i].linear();
    matrix.block<3, 3>(Eigen::Index(3 * i), 3) = -Eigen::Matrix3d::Identity();
    right.segment<3>(Eigen::Index(3 * i)) = -poses[i].translation();
  }
}

Eigen::Matrix<double, 6, 1> solveByEigen(const Poses& poses)
{
  Eigen::Matrix<double, Eigen::Dynamic, 6> matrix;
  Eigen::VectorXd right;
  buildEquations(poses, matrix, right);
  return matrix.colPivHouseholderQr().solve(right);
}

Eigen::Matrix<double, 6, 1> solveByNormalEquations(const Poses& poses)
{
  Eigen::Matrix<double, Eigen::Dynamic, 6> matrix;
  Eigen::VectorXd right;
  buildEquations(poses, matrix, right);
  const Eigen::Matrix<double, 6, 6> normal = matrix.transpose() * matrix;
  return normal.ldlt().solve(matrix.transpose() * right);
}

template<typename Call> double secondsOf(Call call)
{
  const Clock::time_point start = Clock::now();
  benchmark::DoNotOptimize(call());
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void pivot(benchmark::State& state, PivotMethod method)
{
  const Poses poses = makePoses();
  PivotCalibrationOptions options;
  options.method = method;
  double ours = 0, eigen = 0, normal = 0;
  for (auto _ : state)
  {
    const double seconds = secondsOf([&] { return calibratePivot(poses, options); });
    eigen += secondsOf([&] { return solveByEigen(poses); });
    normal += secondsOf([&] { return solveByNormalEquations(poses); });
    ours += seconds;
    state.SetIterationTime(seconds);
  }
  state.counters["eigen_us"] = 1e6 * eigen / double(state.iterations());
  state.counters["ratio_to_eigen"] = ours / eigen;
  state.counters["ratio_to_eigen_normal"] = ours / normal;
}

BENCHMARK_CAPTURE(pivot, robust, PivotMethod::Robust)->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(pivot, algebraic_one_step, PivotMethod::AlgebraicOneStep)->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(pivot, algebraic_two_step, PivotMethod::AlgebraicTwoStep)->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(pivot, sphere_fit, PivotMethod::SphereFit)->UseManualTime()->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
