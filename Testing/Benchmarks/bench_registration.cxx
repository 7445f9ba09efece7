// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Point-to-line registration against its peers: rays of the evaluation's webcam, one thread. Ours and the peer take turns on the
// same problems; the time shown is our mean, best_us our best round, <peer>_us the peer's, ratio_to_<peer> the best over the best.
#include "PointLineRegistration.h"
#include "RegistrationProblems.h"

#include <benchmark/benchmark.h>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>

namespace
{

using namespace handeye;
using namespace handeye::test;
using Method = PointLineOptions::Method;

std::vector<RegistrationProblem> problemsOf(int count)
{
  Random random(1590);
  std::vector<RegistrationProblem> problems;
  for (int i = 0; i < (count > 1000 ? 2 : 32); ++i)
  {
    problems.push_back(randomProblem(evaluationCameras().front(), count, random));
  }
  return problems;
}

void ours(const RegistrationProblem& problem, Method method)
{
  PointLineOptions options;
  options.method = method;
  options.linesAreRays = true;
  benchmark::DoNotOptimize(registerPointsToLines(problem.pairs, options));
}

void byOpenCV(const RegistrationProblem& problem, int flag)
{
  cv::Vec3d rotation, translation;
  cv::solvePnP(problem.points, problem.pixels, problem.cameraMatrix, cv::noArray(), rotation, translation, false, flag);
  benchmark::DoNotOptimize(rotation);
}

double secondsOf(const std::function<void(const RegistrationProblem&)>& solve, const std::vector<RegistrationProblem>& problems)
{
  const auto start = std::chrono::steady_clock::now();
  for (const RegistrationProblem& problem : problems)
  {
    solve(problem);
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / double(problems.size());
}

void compare(
  benchmark::State& state, Method method, const std::string& peer, const std::function<void(const RegistrationProblem&)>& solvePeer)
{
  const std::vector<RegistrationProblem> problems = problemsOf(int(state.range(0)));
  const auto solve = [method](const RegistrationProblem& problem) { ours(problem, method); };
  // The best of the rounds: what else the machine does in between is not counted.
  double mine = std::numeric_limits<double>::infinity(), theirs = mine;
  for (auto _ : state)
  {
    const double seconds = secondsOf(solve, problems);
    mine = std::min(mine, seconds);
    theirs = std::min(theirs, secondsOf(solvePeer, problems));
    state.SetIterationTime(seconds);
  }
  state.counters["ratio_to_" + peer] = mine / theirs;
  state.counters["best_us"] = 1e6 * mine;
  state.counters[peer + "_us"] = 1e6 * theirs;
}

void globalAgainstSqpnp(benchmark::State& state)
{
  compare(state, Method::Global, "sqpnp", [](const RegistrationProblem& problem) { byOpenCV(problem, cv::SOLVEPNP_SQPNP); });
}

void globalAgainstEpnp(benchmark::State& state)
{
  compare(state, Method::Global, "epnp", [](const RegistrationProblem& problem) { byOpenCV(problem, cv::SOLVEPNP_EPNP); });
}

void globalAgainstIterative(benchmark::State& state)
{
  compare(
    state, Method::Global, "iterative", [](const RegistrationProblem& problem) { byOpenCV(problem, cv::SOLVEPNP_ITERATIVE); });
}

void globalAgainstProcrustes(benchmark::State& state)
{
  compare(state, Method::Global, "procrustes", [](const RegistrationProblem& problem) { ours(problem, Method::Procrustes); });
}

void likelihoodAgainstIterative(benchmark::State& state)
{
  compare(state, Method::MaximumLikelihood, "iterative",
    [](const RegistrationProblem& problem) { byOpenCV(problem, cv::SOLVEPNP_ITERATIVE); });
}

}  // namespace

BENCHMARK(globalAgainstSqpnp)
  ->Arg(6)
  ->Arg(15)
  ->Arg(100)
  ->Arg(1000)
  ->Arg(10000)
  ->UseManualTime()
  ->Iterations(100)
  ->Unit(benchmark::kMicrosecond);
BENCHMARK(globalAgainstProcrustes)->Arg(15)->UseManualTime()->Iterations(20)->Unit(benchmark::kMicrosecond);
BENCHMARK(globalAgainstEpnp)->Arg(15)->UseManualTime()->Iterations(20)->Unit(benchmark::kMicrosecond);
BENCHMARK(globalAgainstIterative)->Arg(15)->UseManualTime()->Iterations(20)->Unit(benchmark::kMicrosecond);
BENCHMARK(likelihoodAgainstIterative)->Arg(15)->UseManualTime()->Iterations(20)->Unit(benchmark::kMicrosecond);

BENCHMARK_MAIN();
