// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is excluded must hold no solution: tried with solutions whose errors are known.
#include "EpipolarCell.h"

#include "BoardSimulation.h"
#include "EpipolarProgram.h"
#include "GeometryMatchers.h"
#include "SmallSimplex.h"

#include <gtest/gtest.h>

#include <iostream>

namespace
{

using namespace handeye;
using namespace handeye::test;

/// Rays that two poses of a camera have of points in front of both, with noise, as a board in front of a camera gives them.
std::vector<EpipolarPair> randomPairs(const Eigen::Isometry3d& markerToCamera, double noiseRad, Random& random)
{
  std::vector<EpipolarPair> pairs;
  for (int i = 0; i < 8; ++i)
  {
    EpipolarPair pair;
    pair.marker = makeRigid(random.direction() * random.uniform(0.2, 0.9), random.uniform3(120));
    const Eigen::Isometry3d secondToFirst = markerToCamera * pair.marker.inverse() * markerToCamera.inverse();
    for (int k = 0; k < 4; ++k)
    {
      const Eigen::Vector3d point_First(random.uniform(-60, 60), random.uniform(-60, 60), random.uniform(250, 400));
      const Eigen::Vector3d point_Second = secondToFirst.inverse() * point_First;
      const Eigen::Vector3d u = rotationFromVector(random.normal3(noiseRad)) * point_First.normalized();
      const Eigen::Vector3d v = rotationFromVector(random.normal3(noiseRad)) * point_Second.normalized();
      pair.rays_Cameras.emplace_back(u, v);
    }
    pairs.push_back(pair);
  }
  return pairs;
}

/// The least of c . x by trying all bases; nothing if there is none.
std::optional<double> leastByTrying(
  const Eigen::Matrix<double, 3, Eigen::Dynamic>& a, const Eigen::VectorXd& c, const Eigen::Vector3d& b)
{
  std::optional<double> least;
  for (int i = 0; i < a.cols(); ++i)
  {
    for (int j = i + 1; j < a.cols(); ++j)
    {
      for (int k = j + 1; k < a.cols(); ++k)
      {
        Eigen::Matrix3d basis;
        basis << a.col(i), a.col(j), a.col(k);
        if (std::abs(basis.determinant()) < 1e-6)
        {
          continue;
        }
        const Eigen::Vector3d x = basis.inverse() * b;
        const double cost = x.dot(Eigen::Vector3d(c(i), c(j), c(k)));
        least = x.minCoeff() < -1e-9 || (least && *least <= cost) ? least : cost;
      }
    }
  }
  return least;
}

}  // namespace

TEST(SmallSimplex, RandomPrograms_FindTheLeastVertex)
{
  Random random(3);
  int optimal = 0;
  for (int trial = 0; trial < 400; ++trial)
  {
    SmallSimplex<3> simplex;
    Eigen::Matrix<double, 3, Eigen::Dynamic> a(3, 12);
    Eigen::VectorXd c(12);
    for (int i = 0; i < 12; ++i)
    {
      // The first three are a basis that is feasible, and dear.
      a.col(i) = i < 3 ? Eigen::Vector3d(Eigen::Vector3d::Unit(i)) : random.uniform3(1);
      c(i) = i < 3 ? 10 : random.uniform(0, 3);
      simplex.add(a.col(i), c(i));
    }
    const Eigen::Vector3d b(random.uniform(0, 2), random.uniform(0, 2), random.uniform(0, 2));
    const auto end = simplex.minimize(b, { 0, 1, 2 }, -1e30);
    ASSERT_EQ(end, SmallSimplex<3>::End::Optimal) << trial;
    ++optimal;
    EXPECT_NEAR(simplex.objective(), *leastByTrying(a, c, b), 1e-8) << trial;
    EXPECT_NEAR(simplex.multipliers().dot(b), simplex.objective(), 1e-8) << "duality";
    EXPECT_GT((c - a.transpose() * simplex.multipliers()).minCoeff(), -1e-8) << "the multipliers are feasible";
  }
  EXPECT_EQ(optimal, 400);
}

TEST(SmallSimplex, Below_StopsEarlyWithABound)
{
  SmallSimplex<3> simplex;
  for (int i = 0; i < 3; ++i)
  {
    simplex.add(Eigen::Vector3d::Unit(i), 10);
  }
  simplex.add({ 1, 1, 1 }, 1);
  EXPECT_EQ(simplex.minimize(Eigen::Vector3d::Ones(), { 0, 1, 2 }, 5), SmallSimplex<3>::End::Below);
  EXPECT_LE(simplex.objective(), 5);
}

TEST(EpipolarCell, SolutionInside_IsNeverExcludedNorCutOff)
{
  Random random(11);
  int cells = 0;
  for (int trial = 0; trial < 60; ++trial)
  {
    const Eigen::Isometry3d truth = makeRigid(random.direction() * random.uniform(0, 3), random.uniform3(80));
    const std::vector<EpipolarPair> pairs = randomPairs(truth, 0.002, random);
    EpipolarCellProgram program(pairs);
    EpipolarProgram cones(pairs, 1000);
    for (const double reach : { 1e-4, 1e-3, 1e-2, 0.05, 0.1, 0.3 })
    {
      // Any rotation and centre, near the truth or not: its own error is what it may not be excluded at.
      const Eigen::Matrix3d solution = truth.linear() * rotationFromVector(random.normal3(trial % 2 == 0 ? 0.003 : 0.1));
      const Eigen::Vector3d center = truth.inverse().translation() + random.uniform3(trial % 3 == 0 ? 3 : 40);
      const double bound = epipolarErrorRad(pairs, solution, center) * (1 + 1e-9) + 1e-12;
      EpipolarCell cell;
      const Eigen::Vector3d turn = random.direction() * random.uniform(0, reach);
      cell.rotation = (rotationFromVector(turn).transpose() * solution.transpose()).transpose();
      cell.reachRad = reach;
      cell.halfWidthsMm = Eigen::Vector3d(random.uniform(1, 200), random.uniform(1, 200), random.uniform(1, 200));
      cell.center_Marker = center + cell.halfWidthsMm.cwiseProduct(random.uniform3(1));
      ASSERT_FALSE(program.excludes(cell, bound)) << "reach " << reach << ", bound " << bound;
      EpipolarCell narrowed = cell;
      ASSERT_TRUE(program.narrow(narrowed, bound));
      EXPECT_LE(((center - narrowed.center_Marker).cwiseAbs() - narrowed.halfWidthsMm).maxCoeff(), 1e-6) << "reach " << reach;
      Eigen::Vector3d middle = cell.center_Marker, half = cell.halfWidthsMm;
      ASSERT_TRUE(cones.boxOfCenters(cell.rotation, bound + reach, middle, half));
      EXPECT_LE(((center - middle).cwiseAbs() - half).maxCoeff(), 1e-6);
      ++cells;
    }
  }
  EXPECT_EQ(cells, 360);
}

TEST(EpipolarCell, CellBesideTheTruth_IsExcludedLongBeforeItsSizeIsItsError)
{
  Random random(5);
  const Eigen::Isometry3d truth = makeRigid(random.direction() * 1.2, random.uniform3(80));
  const std::vector<EpipolarPair> pairs = randomPairs(truth, 0.0005, random);
  EpipolarCellProgram program(pairs);
  EpipolarProgram cones(pairs, 1000);
  const Eigen::Vector3d center = truth.inverse().translation();
  const double error = epipolarErrorRad(pairs, truth.linear(), center);
  int allByCells = 0, allByCones = 0;
  for (const double reach : { 0.01, 0.004, 0.002, 0.001 })
  {
    int byCells = 0, byCones = 0;
    for (int i = 0; i < 40; ++i)
    {
      // 1 degree beside it.
      const Eigen::Matrix3d rotation = truth.linear() * rotationFromVector(random.direction() * 0.0175);
      byCells += program.excludes({ rotation, reach, center, Eigen::Vector3d::Constant(20) }, error) ? 1 : 0;
      byCones += cones.solve(rotation, error + reach) ? 0 : 1;
    }
    std::cout << "reach " << reach << " rad, excluded: " << byCells << " of 40 by cells, " << byCones << " by cones\n";
    allByCells += byCells;
    allByCones += byCones;
  }
  EXPECT_GT(allByCells, allByCones + 20);
}
