// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The branch and bound: what it proves, against brute force, and how it ends early.
#include "EpipolarSearch.h"

#include "BoardHandEyeViews.h"
#include "BoardSimulation.h"
#include "EpipolarProgram.h"
#include "GeometryMatchers.h"
#include "TestCameras.h"

#include <gtest/gtest.h>

#include <iostream>

namespace
{

using namespace handeye;
using namespace handeye::test;
using Method = BoardHandEyeOptions::Method;

struct Problem
{
  BoardScene scene;
  std::vector<BoardHandEyeView> views;
  std::vector<EpipolarPair> pairs;
};

Problem makeProblem(int views, const BoardNoise& noise, unsigned seed, int motions = 20, int points = 4)
{
  Random random(seed);
  Problem problem{ { parseBoard("chessboard:9x6:15"), webcam() }, {}, {} };
  BoardViews wide;
  wide.turnRad = 1.2;
  problem.views = problem.scene.views(views, wide, noise, random);
  std::vector<HandEyePoses> poses;
  std::vector<const BoardHandEyeView*> pointers;
  for (const BoardHandEyeResult::View& found : posesOf(problem.views, problem.scene.camera))
  {
    poses.push_back({ problem.views[poses.size()].markerToTracker, found.boardToCamera });
    pointers.push_back(&problem.views[pointers.size()]);
  }
  problem.pairs = epipolarPairs(selectMotions(motionsOf(poses, 0.05), motions), pointers, problem.scene.camera, points);
  return problem;
}

Eigen::Vector3d centerOf(const Eigen::Isometry3d& markerToCamera)
{
  return markerToCamera.inverse().translation();
}

const BoardNoise Noisy{ 0.002, 0.3, 0.1 };

}  // namespace

TEST(EpipolarSearch, TruthWithoutNoise_HasNoError)
{
  const Problem problem = makeProblem(6, {}, 1);
  const Eigen::Isometry3d& truth = problem.scene.markerToCamera;
  EXPECT_LT(epipolarErrorRad(problem.pairs, truth.linear(), centerOf(truth)), 1e-9);
  const Eigen::Matrix3d turned = rotationFromVector({ 0.02, 0, 0 }) * truth.linear();
  EXPECT_GT(epipolarErrorRad(problem.pairs, turned, centerOf(truth)), 1e-3);
}

/// The error is the angle by which rays have to be bent: with one ray bent by a known angle out of the plane, half of it.
TEST(EpipolarSearch, Error_IsTheAngleThatRaysAreBent)
{
  EpipolarPair pair;
  pair.marker.translation() = Eigen::Vector3d(100, 0, 0);
  const Eigen::Vector3d point(30, 0, 200);
  pair.rays_Cameras = { { (point - Eigen::Vector3d(100, 0, 0)).normalized(), point.normalized() } };
  EXPECT_NEAR(epipolarErrorRad({ pair }, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()), 0, 1e-12);
  pair.rays_Cameras[0].second = (point + Eigen::Vector3d(0, 2, 0)).normalized();
  // Brute force: the least angle e with a plane through the baseline that is e away from both rays.
  const auto [u, v] = pair.rays_Cameras[0];
  double least = 1;
  for (int i = -100000; i <= 100000; ++i)
  {
    const double turn = 1e-7 * i;
    const Eigen::Vector3d normal(0, std::cos(turn), std::sin(turn));
    least = std::min(least, std::max(std::abs(std::asin(normal.dot(u))), std::abs(std::asin(normal.dot(v)))));
  }
  EXPECT_NEAR(epipolarErrorRad({ pair }, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()), least, 2e-7);
}

/// What the linear program refuses, no centre can reach; what it accepts, its centre reaches.
TEST(EpipolarSearch, Program_AgreesWithBruteForce)
{
  const Problem problem = makeProblem(5, Noisy, 2);
  const Eigen::Isometry3d& truth = problem.scene.markerToCamera;
  Random random(3);
  EpipolarProgram program(problem.pairs, 300);
  for (int trial = 0; trial < 12; ++trial)
  {
    const Eigen::Matrix3d rotation = rotationFromVector(random.direction() * 0.01 * trial) * truth.linear();
    const EpipolarSolution least = program.minimize(rotation, 0.1);
    EXPECT_LE(least.errorRad, epipolarErrorRad(problem.pairs, rotation, centerOf(truth)) + 1e-12);
    ASSERT_NEAR(least.errorRad, epipolarErrorRad(problem.pairs, rotation, least.center_Marker), 1e-12);
    EXPECT_FALSE(program.solve(rotation, 0.97 * least.errorRad).has_value());
    for (int i = 0; i < 3000; ++i)
    {
      const Eigen::Vector3d other = least.center_Marker + random.normal3(i % 2 == 0 ? 0.3 : 20);
      ASSERT_GE(epipolarErrorRad(problem.pairs, rotation, other), 0.98 * least.errorRad);
    }
  }
}

/// The bound of a cube: no rotation within an angle d has an error that is lower by more than d.
TEST(EpipolarSearch, LeastError_ChangesNoFasterThanTheRotation)
{
  const Problem problem = makeProblem(5, Noisy, 4);
  Random random(5);
  EpipolarProgram program(problem.pairs, 300);
  for (int trial = 0; trial < 40; ++trial)
  {
    const Eigen::Matrix3d here = rotationFromVector(random.normal3(0.3)) * problem.scene.markerToCamera.linear();
    const double turn = std::pow(10, random.uniform(-3, -0.5));
    const Eigen::Matrix3d there = rotationFromVector(random.direction() * turn) * here;
    const double a = program.minimize(here, 0.1).errorRad, b = program.minimize(there, 0.1).errorRad;
    EXPECT_LE(std::abs(a - b), turn + 0.01 * std::max(a, b) + 1e-9) << "each is the least to a hundredth";
  }
}

/// The search finds by itself, without the closed form, what the truth is close to, and proves it: points all around a camera that
/// moves by large turns, seen to 0.01 rad.
TEST(EpipolarSearch, WithoutAStart_FindsAndProvesTheOptimum)
{
  Random random(6);
  const Eigen::Isometry3d truth = typicalMarkerToCamera();
  const Eigen::Isometry3d cameraToMarker = truth.inverse();
  std::vector<EpipolarPair> pairs;
  for (int i = 0; i < 12; ++i)
  {
    EpipolarPair pair;
    pair.marker = makeRigid(random.direction() * random.uniform(0.8, 2), random.uniform3(150));
    const Eigen::Isometry3d markerToCameraTo = truth * pair.marker;
    const Eigen::Isometry3d motion = markerToCameraTo * cameraToMarker;
    for (int k = 0; k < 4; ++k)
    {
      const Eigen::Vector3d point_From = random.direction() * random.uniform(150, 300), point_To = motion * point_From;
      pair.rays_Cameras.emplace_back(
        (point_From.normalized() + random.normal3(0.01)).normalized(), (point_To.normalized() + random.normal3(0.01)).normalized());
    }
    pairs.push_back(pair);
  }
  BoardHandEyeOptions options;
  options.maximumOffsetMm = 200;
  options.timeLimitSec = 300;  // it takes a few seconds
  options.gapRad = 0.004;
  const EpipolarSearchResult alone = searchEpipolar(pairs, std::nullopt, options, {});
  ASSERT_TRUE(alone.solution.has_value());
  std::cout << "cubes " << alone.state.cubes << ", programs " << alone.state.linearPrograms << ", " << alone.state.elapsedSec
            << " s, error " << alone.state.bestErrorRad << ", bound " << alone.state.lowerBoundRad << "\n";
  EXPECT_TRUE(alone.state.isProven);
  EXPECT_LE(alone.state.gapRad, 0.004 + 1e-12);
  EXPECT_GT(alone.state.lowerBoundRad, 0.005);
  EXPECT_LE(alone.solution->errorRad, epipolarErrorRad(pairs, truth.linear(), centerOf(truth)));
  EXPECT_LT(rotationAngle(alone.solution->markerToCamera.transpose() * truth.linear()), 0.02);
  EXPECT_LT((alone.solution->center_Marker - centerOf(truth)).norm(), 10);
  const EpipolarSearchResult helped = searchEpipolar(pairs, truth, options, {});
  EXPECT_LE(helped.state.lowerBoundRad, alone.state.bestErrorRad) << "bounds of one search hold for the other's solutions";
  EXPECT_LE(alone.state.lowerBoundRad, helped.state.bestErrorRad);
}

TEST(EpipolarSearch, BoardWithNoise_IsProvenToTheGap)
{
  for (const unsigned seed : { 7U, 8U, 9U })
  {
    const Problem problem = makeProblem(12, Noisy, seed);
    BoardHandEyeOptions options;
    options.method = Method::BranchAndBound;
    options.timeLimitSec = 500;  // 2 s of work; machines are shared
    const BoardHandEyeResult result = calibrateBoardHandEye(problem.views, problem.scene.camera, options);
    ASSERT_TRUE(result.isUsable()) << result.message;
    const BranchAndBoundState& state = result.branchAndBound;
    std::cout << "seed " << seed << ": error " << 1e3 * state.bestErrorRad << " mrad, bound " << 1e3 * state.lowerBoundRad << ", "
              << state.cubes << " cubes, " << state.linearPrograms << " programs, " << state.elapsedSec << " s\n";
    EXPECT_TRUE(state.isProven) << result.message;
    EXPECT_LE(state.gapRad, std::max(options.gapRad, options.relativeGap * state.bestErrorRad) + 1e-12);
    EXPECT_GT(state.lowerBoundRad, 0.8 * state.bestErrorRad);
    // Nothing near the truth is below the bound.
    Random random(seed);
    const std::vector<EpipolarPair>& pairs = problem.pairs;
    const Eigen::Isometry3d& truth = problem.scene.markerToCamera;
    for (int i = 0; i < 2000; ++i)
    {
      const Eigen::Matrix3d rotation = result.markerToCamera.linear() * rotationFromVector(random.normal3(0.003));
      const Eigen::Vector3d center = centerOf(i % 2 == 0 ? truth : result.markerToCamera) + random.normal3(2);
      EXPECT_GE(epipolarErrorRad(pairs, rotation, center), state.lowerBoundRad);
    }
  }
}

TEST(EpipolarSearch, TimeLimitAndCancel_KeepTheBestAndItsGap)
{
  const Problem problem = makeProblem(8, Noisy, 7);
  BoardHandEyeOptions options;
  options.method = Method::BranchAndBound;
  options.gapRad = 1e-9;
  options.relativeGap = 0;
  options.timeLimitSec = 1;
  const BoardHandEyeResult late = calibrateBoardHandEye(problem.views, problem.scene.camera, options);
  ASSERT_TRUE(late.isUsable()) << late.message;
  EXPECT_FALSE(late.branchAndBound.isProven);
  EXPECT_NEAR(late.branchAndBound.gapRad, late.branchAndBound.bestErrorRad - late.branchAndBound.lowerBoundRad, 1e-15);
  EXPECT_GT(late.branchAndBound.gapRad, 1e-9);
  EXPECT_TRUE(says(late.message, { "epipolar error", "not proven", "a gap of" }));
  EXPECT_FALSE(late.covariance.has_value());

  options.timeLimitSec = 60;
  int reports = 0;
  double lastError = 1;
  const BoardHandEyeResult cancelled = calibrateBoardHandEye(problem.views, problem.scene.camera, options,
    [&](const BranchAndBoundState& state)
    {
      EXPECT_LE(state.bestErrorRad, lastError);
      EXPECT_GE(state.bestErrorRad, state.lowerBoundRad);
      lastError = state.bestErrorRad;
      return ++reports < 3;
    });
  EXPECT_EQ(reports, 3);
  ASSERT_TRUE(cancelled.isUsable());
  EXPECT_FALSE(cancelled.branchAndBound.isProven);
}
