// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GeometryMatchers.h"
#include "PointLineQuadraticForm.h"
#include "PointLineSupport.h"
#include "RegistrationProblems.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>
#include <set>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Method = PointLineOptions::Method;
using Status = PointLineResult::Status;

std::atomic<int> allocations{ 0 };

bool isIterative(Method method)
{
  return method == Method::Procrustes || method == Method::OrthogonalIteration || method == Method::ProcrustesPnP;
}

}  // namespace

// Not inlined, for then the compiler takes malloc and delete for a mismatched pair.
[[gnu::noinline]] void* operator new(std::size_t size)
{
  ++allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1))
  {
    return memory;
  }
  throw std::bad_alloc();
}

[[gnu::noinline]] void operator delete(void* memory) noexcept
{
  std::free(memory);
}

[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept
{
  std::free(memory);
}

TEST(PointLineMethods, EachMethod_RecoversTheTruthOfNoiseFreeRays)
{
  for (const Method method : allMethods())
  {
    Random random(1);
    int exact = 0;
    for (int run = 0; run < 20; ++run)
    {
      const Eigen::Isometry3d truth = random.rigid(100);
      const PointLineResult result = registerPointsToLines(viewPairs(truth, 15, {}, 0, 0, random), pointLineOptions(method, true));
      // EPnP is linear, the iterations stop a little short.
      exact += result.isUsable() && rigid3dNear(result.pointsToLines, truth, 1e-5, 1e-3) ? 1 : 0;
    }
    EXPECT_GE(exact, method == Method::ProcrustesPnP ? 10 : 19) << toString(method) << ": ppnp starts without a guess";
  }
}

TEST(PointLineMethods, LinesOfTwoCentres_AreForTheMethodsThatTakeThem)
{
  Random random(2);
  const Eigen::Isometry3d truth = random.rigid(100);
  const Pairs pairs = skewPairs(truth, 12, 0, random);
  for (const Method method : { Method::MaximumLikelihood, Method::Global, Method::Procrustes, Method::OrthogonalIteration })
  {
    const PointLineResult result = registerPointsToLines(pairs, pointLineOptions(method, false));
    EXPECT_TRUE(result.isUsable() && rigid3dNear(result.pointsToLines, truth, 1e-6, 1e-4)) << toString(method) << result.message;
  }
  for (const Method method : { Method::ProcrustesPnP, Method::Epnp, Method::Sqpnp, Method::Iterative })
  {
    const PointLineResult result = registerPointsToLines(pairs, pointLineOptions(method, false));
    EXPECT_EQ(result.status, Status::NotApplicable) << toString(method);
    EXPECT_TRUE(says(result.message, { toString(method), "one centre" }));
  }
}

TEST(PointLineMethods, Rays_OfACameraThatLooksBackwards_AreTakenByOpenCVToo)
{
  Random random(3);
  const Eigen::Isometry3d turned = makeRigid({ 0, EIGEN_PI, 0 }, { 10, 20, 30 });
  const Eigen::Isometry3d truth = random.rigid(100);
  Pairs pairs = viewPairs(truth, 12, {}, 0, 0, random);
  for (PointLinePair& pair : pairs)
  {
    pair.origin_Lines = turned * pair.origin_Lines;
    pair.direction_Lines = turned.linear() * pair.direction_Lines;
  }
  for (const Method method : { Method::Epnp, Method::Sqpnp, Method::Iterative })
  {
    const PointLineResult result = registerPointsToLines(pairs, pointLineOptions(method, true));
    EXPECT_TRUE(result.isUsable() && rigid3dNear(result.pointsToLines, turned * truth, 1e-5, 1e-3)) << toString(method);
  }
}

TEST(PointLineMethods, OrthogonalIteration_EndsInTheGlobalMinimum)
{
  Random random(4);
  for (int run = 0; run < 20; ++run)
  {
    const Pairs pairs = viewPairs(random.rigid(100), 15, {}, 0.4, 0.0005, random);
    const PointLineResult global = registerPointsToLines(pairs, pointLineOptions(Method::Global, true));
    const PointLineResult result = registerPointsToLines(pairs, pointLineOptions(Method::OrthogonalIteration, true));
    ASSERT_TRUE(result.isUsable()) << result.message;
    EXPECT_GT(result.iterations, 1);
    EXPECT_TRUE(rigid3dNear(result.pointsToLines, global.pointsToLines, 1e-6, 1e-4));
  }
}

TEST(PointLineMethods, Cap_GivesNotConvergedForEachIteration)
{
  Random random(5);
  for (const Method method : allMethods())
  {
    if (!isIterative(method))
    {
      continue;
    }
    PointLineOptions options = pointLineOptions(method, true);
    options.maximumIterations = 5;
    const PointLineResult result = registerPointsToLines(viewPairs(random.rigid(100), 15, {}, 0.3, 0, random), options);
    EXPECT_EQ(result.status, Status::NotConverged) << toString(method);
    EXPECT_EQ(result.iterations, 5);
  }
}

TEST(PointLineGlobal, Cost_IsNeverAboveThatOfTheOthers)
{
  for (const EvaluationCamera& view : evaluationCameras())
  {
    Random random(6);
    for (int run = 0; run < 150; ++run)
    {
      const RegistrationProblem problem = randomProblem(view, random.integer(4, 30), random);
      const PointLineResult global = registerPointsToLines(problem.pairs, pointLineOptions(Method::Global, true));
      ASSERT_TRUE(global.isUsable()) << view.name << " run " << run << ": " << global.message;
      const double cost = pointLineCost(problem.pairs, global.pointsToLines);
      for (const Method method : { Method::Sqpnp, Method::Epnp, Method::Iterative })
      {
        const PointLineResult other = registerPointsToLines(problem.pairs, pointLineOptions(method, true));
        if (other.isUsable())
        {
          const double descended = pointLineCost(problem.pairs, descendPlainly(problem.pairs, other.pointsToLines));
          ASSERT_LE(cost, descended * (1 + 1e-9)) << view.name << " run " << run << " " << toString(method);
        }
      }
    }
  }
}

TEST(PointLineGlobal, ProvenMinimum_IsFoundWithoutAnyAllocation)
{
  Random random(7);
  for (const int count : { 8, 15, 1000 })
  {
    const Pairs pairs = viewPairs(random.rigid(100), count, {}, 0.1, 0.0002, random);
    const int before = allocations;
    const PointLineQuadraticForm form(pairs, sumPairs(pairs));
    int steps = 0;
    const Eigen::Matrix3d rotation = form.descend(form.linearStart(), steps);
    const bool proven = form.isCertainlyGlobal(rotation);
    EXPECT_EQ(allocations - before, 0);
    EXPECT_TRUE(proven) << count;
    EXPECT_LT(steps, 15);
  }
}

TEST(PointLineGlobal, Proof_IsNotGivenForAnotherMinimum)
{
  // Whatever the start, what is proven must be the lowest minimum.
  Random random(8);
  int others = 0;
  for (int run = 0; run < 400; ++run)
  {
    const Pairs pairs = viewPairs(random.rigid(100), 6, narrowView(), 1, 0.002, random);
    const PointLineQuadraticForm form(pairs, sumPairs(pairs));
    int steps = 0;
    const double lowest = pointLineCost(pairs, bruteForceMinimum(pairs, false, run < 40 ? 10 : 0, random));
    const Eigen::Matrix3d rotation = form.descend(random.rotation(), steps);
    const double first = form.cost(form.descend(form.linearStart(), steps));
    if (form.cost(rotation) > 1.001 * first)
    {
      ++others;
      EXPECT_FALSE(form.isCertainlyGlobal(rotation)) << run;
    }
    if (run < 40 && form.isCertainlyGlobal(rotation))
    {
      EXPECT_LE(form.cost(rotation), lowest * (1 + 1e-6)) << run;
    }
  }
  EXPECT_GT(others, 5) << "random starts end elsewhere now and then";
}

TEST(PointLineGlobal, SixPairs_AreNearlyAlwaysProvenAndThenTheLowest)
{
  int proven = 0, runs = 0;
  for (const EvaluationCamera& view : evaluationCameras())
  {
    Random random(10);
    for (int run = 0; run < 100; ++run, ++runs)
    {
      const RegistrationProblem problem = randomProblem(view, 6, random);
      const PointLineResult result = registerPointsToLines(problem.pairs, pointLineOptions(Method::Global, true));
      if (result.minimaCount == 1)
      {
        ++proven;
        const Eigen::Isometry3d searched = bruteForceMinimum(problem.pairs, false, 10, random);
        EXPECT_LE(pointLineCost(problem.pairs, result.pointsToLines), pointLineCost(problem.pairs, searched) * (1 + 1e-9))
          << view.name << " run " << run;
      }
    }
  }
  EXPECT_GT(proven, 0.97 * runs);
}

TEST(PointLineGlobal, ThreePairs_GiveAllSolutionsThatFit)
{
  Random random(9);
  for (int run = 0; run < 20; ++run)
  {
    const Eigen::Isometry3d truth = random.rigid(100);
    const Pairs pairs = viewPairs(truth, 3, {}, 0, 0, random);
    const PointLineResult result = registerPointsToLines(pairs, pointLineOptions(Method::Global, true));
    EXPECT_EQ(result.status, Status::TooFewPairs);
    bool holdsTheTruth = false;
    for (const Eigen::Isometry3d& solution : result.solutions)
    {
      EXPECT_LT(pointLineCost(pairs, solution), 1e-6);
      holdsTheTruth = holdsTheTruth || rigid3dNear(solution, truth, 1e-4, 1e-2);
    }
    EXPECT_TRUE(holdsTheTruth) << "run " << run << ", solutions " << result.solutions.size();
  }
}

TEST(PointLineGlobal, TwoMinimaThatCannotBeToldApart_AreBothInTheResult)
{
  // Half a turn about the axis that all lines cross at right angles puts every point on its line again.
  Random random(10);
  Pairs pairs;
  for (int i = 0; i < 10; ++i)
  {
    const double heading = random.uniform(0, 2 * EIGEN_PI), height = random.uniform(-100, 100);
    const Eigen::Vector3d origin(0, 0, height), direction(std::cos(heading), std::sin(heading), 0);
    pairs.push_back({ origin + (i % 2 ? 50 : -70) * direction, origin, direction, 1 });
  }
  const PointLineResult result = registerPointsToLines(pairs, pointLineOptions(Method::Global, false));
  ASSERT_EQ(result.status, Status::Ambiguous);
  ASSERT_EQ(result.solutions.size(), 2U);
  EXPECT_NEAR(rotationErrorRad(result.solutions[0], result.solutions[1]), EIGEN_PI, 1e-6);
}

TEST(PointLineGlobal, RaysTurnedRound_AreReported)
{
  Random random(11);
  Pairs pairs = viewPairs(random.rigid(100), 12, {}, 0.3, 0.0004, random);
  for (PointLinePair& pair : pairs)
  {
    pair.direction_Lines *= -1;
  }
  const PointLineResult result = registerPointsToLines(pairs, pointLineOptions(Method::Global, true));
  EXPECT_FALSE(result.isUsable());
  EXPECT_TRUE(says(result.message, { "camera" }));
}

TEST(PointLineGlobal, PointsThatDoNotBelongToTheirLines_AreAPoorFit)
{
  Random random(12);
  Pairs pairs = skewPairs(random.rigid(100), 15, 0, random);
  for (PointLinePair& pair : pairs)
  {
    pair.point_Points = random.uniform3(200);
  }
  const PointLineResult result = registerPointsToLines(pairs, pointLineOptions(Method::MaximumLikelihood, false));
  EXPECT_EQ(result.status, Status::PoorFit) << toString(result.status) << result.message;
  EXPECT_TRUE(says(result.message, { "do not belong together", "RMS" }));
}

TEST(PointLineConsensus, ThirtyPercentWrongLines_AreNamed)
{
  Random random(18);
  int named = 0;
  for (int run = 0; run < 12; ++run)
  {
    const Eigen::Isometry3d truth = random.rigid(100);
    Pairs pairs = run % 2 ? skewPairs(truth, 15, 0.4, random) : viewPairs(truth, 15, {}, 0.4, 0.0005, random);
    for (const std::size_t wrong : { 1, 4, 6, 11 })
    {
      pairs[wrong].point_Points += random.uniform(40, 90) * random.direction();
    }
    pairs[1].point_Points += Eigen::Vector3d(100, 100, 0);
    PointLineOptions options = pointLineOptions(Method::MaximumLikelihood, run % 2 == 0);
    options.rejectOutliers = true;
    const PointLineResult result = registerPointsToLines(pairs, options);
    ASSERT_TRUE(result.isUsable()) << result.message;
    // An error along the line is none.
    EXPECT_TRUE(rigid3dNear(result.pointsToLines, truth, 0.01, 3)) << "run " << run;
    named += result.rejected == std::vector<int>({ 1, 4, 6, 11 }) ? 1 : 0;
    EXPECT_EQ(result.residualsMm.size(), 15U);
  }
  EXPECT_GE(named, 10);
}

TEST(PointLineConsensus, CleanPairs_AreAllKept)
{
  Random random(19);
  for (int run = 0; run < 40; ++run)
  {
    PointLineOptions options = pointLineOptions(Method::MaximumLikelihood, true);
    options.rejectOutliers = true;
    const Pairs pairs = viewPairs(random.rigid(100), random.integer(5, 16), {}, run % 4 ? 0.4 : 0, run % 4 ? 0.0005 : 0, random);
    const PointLineResult result = registerPointsToLines(pairs, options);
    ASSERT_TRUE(result.isUsable()) << result.message;
    EXPECT_TRUE(result.rejected.empty()) << "run " << run;
  }
}

TEST(PointLineLikelihood, GivenNoise_IsJudged)
{
  Random random(13);
  const Pairs pairs = viewPairs(random.rigid(100), 15, {}, 2, 0, random);
  PointLineOptions options = pointLineOptions(Method::MaximumLikelihood, true);
  options.maximumMisfit = 4;
  options.sigmaMm = 0.1;
  const PointLineResult result = registerPointsToLines(pairs, options);
  EXPECT_EQ(result.status, Status::PoorFit) << result.message;
  EXPECT_TRUE(says(result.message, { "times what the given noise explains" }));
  options.sigmaMm = 2;
  EXPECT_TRUE(registerPointsToLines(pairs, options).isUsable());
}

TEST(PointLineLikelihood, EstimatedNoise_IsThatOfTheData)
{
  Random random(14);
  double squares = 0;
  for (int run = 0; run < 60; ++run)
  {
    PointLineOptions options = pointLineOptions(Method::MaximumLikelihood, false);
    const PointLineResult result = registerPointsToLines(skewPairs(random.rigid(100), 20, 0.7, random), options);
    ASSERT_TRUE(result.isUsable()) << result.message;
    squares += result.sigmaMm * result.sigmaMm / 60;
    EXPECT_EQ(result.sigmaRad, 0);
  }
  EXPECT_NEAR(std::sqrt(squares), 0.7, 0.035) << "34 freedoms in each of 60 runs: 1.1 % of scatter";
}

TEST(PointLineLikelihood, CovarianceOfThePoints_WeightsEachAcrossItsLine)
{
  // A point that is uncertain along one direction only still counts across it.
  Random random(15);
  const Eigen::Isometry3d truth = random.rigid(100);
  Pairs pairs = viewPairs(truth, 8, {}, 0, 0, random);
  std::vector<PointLineNoise> noise(pairs.size());
  const Eigen::Vector3d across_Lines = pairs[3].direction_Lines.unitOrthogonal();
  const Eigen::Vector3d across_Points = truth.linear().transpose() * across_Lines;
  pairs[3].point_Points += 20 * across_Points;
  noise[3].point_Points += 1e10 * across_Points * across_Points.transpose();
  PointLineOptions options = pointLineOptions(Method::MaximumLikelihood, true);
  options.sigmaMm = 1;
  const PointLineResult result = registerPointsToLines(pairs, noise, options);
  ASSERT_TRUE(result.isUsable()) << result.message;
  EXPECT_TRUE(rigid3dNear(result.pointsToLines, truth, 1e-4, 1e-2));
  EXPECT_NEAR(result.residualsMm[3], 20, 0.1);
}

TEST(PointLineLikelihood, Covariance_IsHonest)
{
  Random random(16);
  double chiSquares = 0;
  for (int run = 0; run < 200; ++run)
  {
    const Eigen::Isometry3d truth = random.rigid(100);
    PointLineOptions options = pointLineOptions(Method::MaximumLikelihood, true);
    options.sigmaMm = 0.4;
    options.sigmaRad = 0.0008;
    const PointLineResult result = registerPointsToLines(viewPairs(truth, 15, {}, 0.4, 0.0008, random), options);
    ASSERT_TRUE(result.isUsable());
    const Eigen::Isometry3d trueToFound = result.pointsToLines * truth.inverse();
    const Eigen::AngleAxisd turn(trueToFound.linear());
    Eigen::Matrix<double, 6, 1> error;
    error << turn.angle() * turn.axis(), trueToFound.translation();
    chiSquares += error.dot(result.covariance.inverse() * error) / 200;
  }
  // Six freedoms; the mean of 200 scatters by 0.25.
  EXPECT_NEAR(chiSquares, 6, 1);
}

TEST(HandEyeMethods, MethodsOfOneCamera_RefuseAStereoRig)
{
  Random random(13);
  const std::vector<Eye> eyes = { { webcam() }, { webcam(), makeRigid({ 0, 0.02, 0 }, { -60, 0, 0 }) } };
  std::vector<HandEyeSample> samples =
    simulateSamples(webcam(), typicalMarkerToCamera(), 10, { 150, 700, 0.08, 0.35, 0.25 }, random);
  for (std::size_t i = 5; i < samples.size(); ++i)
  {
    const Eigen::Vector3d ball_Camera = typicalMarkerToCamera() * samples[i].tip_Marker;
    samples[i] = makeSample(int(i), ball_Camera, eyes[1], 1, samples[i].tip_Marker, 0.25, random);
  }
  HandEyeCalibrationOptions options;
  options.method = PointLineOptions::Method::Sqpnp;
  const HandEyeCalibrationResult result = calibrateHandEye(samples, eyes, options);
  EXPECT_EQ(result.status, HandEyeCalibrationResult::Status::NotApplicable) << toString(result.status) << result.message;
  EXPECT_TRUE(says(result.message, { "sqpnp", "one centre" }));
}

TEST(PointLineInput, CovariancesThatAreNone_ThrowASentenceWithTheRow)
{
  Random random(17);
  const Pairs pairs = viewPairs(random.rigid(100), 6, {}, 0, 0, random);
  const PointLineOptions options = pointLineOptions(Method::MaximumLikelihood, true);
  std::vector<PointLineNoise> noise(5);
  expectInvalidArgument([&] { (void)registerPointsToLines(pairs, noise, options); }, { "point and line 6", "6 pairs but 5" });
  noise.resize(6);
  noise[1].point_Points(0, 1) = 0.5;
  expectInvalidArgument([&] { (void)registerPointsToLines(pairs, noise, options); }, { "point and line 2", "symmetric" });
  noise[1] = {};
  noise[4].direction_Lines = -Eigen::Matrix3d::Identity();
  expectInvalidArgument([&] { (void)registerPointsToLines(pairs, noise, options); }, { "point and line 5", "negative" });
  noise[4].direction_Lines(2, 2) = std::nan("");
  expectInvalidArgument([&] { (void)registerPointsToLines(pairs, noise, options); }, { "point and line 5" });
}

TEST(PointLineMethods, ToString_NamesEachMethodDifferently)
{
  std::set<std::string> names;
  for (const Method method : allMethods())
  {
    names.insert(toString(method));
  }
  EXPECT_EQ(names, (std::set<std::string>{ "ml", "global", "procrustes", "oi", "ppnp", "epnp", "sqpnp", "iterative" }));
}
