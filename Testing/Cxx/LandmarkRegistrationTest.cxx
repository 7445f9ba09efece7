// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LandmarkRegistration.h"

#include "GeometryMatchers.h"
#include "Simulation.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Points = std::vector<Eigen::Vector3d>;
using Status = LandmarkRegistrationResult::Status;

/// Landmarks as one picks them on a vertebra: tips of processes, corners of the body (mm).
const Points Vertebra = { { 0, -42, 8 }, { 38, -8, 5 }, { -38, -8, 4 }, { 20, 22, 14 }, { -20, 22, -14 }, { 0, 30, 0 } };

Points moved(const Points& points, const Eigen::Isometry3d& transform, double sigmaMm, Random& random)
{
  Points result;
  for (const Eigen::Vector3d& point : points)
  {
    result.push_back(transform * point + random.normal3(sigmaMm));
  }
  return result;
}

Points mirrored(Points points)
{
  for (Eigen::Vector3d& point : points)
  {
    point.x() *= -1;
  }
  return points;
}

}  // namespace

TEST(LandmarkRegistration, NoiseFree_IsExact)
{
  constexpr double pi = EIGEN_PI;
  Random random(1);
  const Eigen::Vector3d axis = random.direction();
  for (const double angle : { 0.0, 1e-6, 1.3, pi - 1e-8, pi })
  {
    const Eigen::Isometry3d truth = makeRigid(angle * axis, { 30, -20, 55 });
    for (const std::size_t count : { std::size_t(3), std::size_t(4), Vertebra.size() })
    {
      const Points model(Vertebra.begin(), Vertebra.begin() + long(count));
      const LandmarkRegistrationResult result = registerLandmarks(model, moved(model, truth, 0, random));
      ASSERT_EQ(result.status, Status::Ok) << result.message;
      EXPECT_TRUE(rigid3dNear(result.modelToPhantom, truth, 1e-9, 1e-9));
      EXPECT_LT(result.rmsMm, 1e-9);
    }
  }
}

TEST(LandmarkRegistration, KnownPoint_GoesToItsPlace)
{
  Random random(2);
  const Eigen::Isometry3d truth = makeRigid({ 0, 0, EIGEN_PI / 2 }, { 10, 20, 30 });
  const LandmarkRegistrationResult result = registerLandmarks(Vertebra, moved(Vertebra, truth, 0, random));
  EXPECT_TRUE(pointNear(result.modelToPhantom * Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(8, 21, 33), 1e-9));
}

TEST(LandmarkRegistration, Noise_LeavesTheLeastSquares)
{
  Random random(3);
  const Eigen::Isometry3d truth = random.rigid(100);
  const Points touched = moved(Vertebra, truth, 0.5, random);
  const LandmarkRegistrationResult result = registerLandmarks(Vertebra, touched);
  ASSERT_TRUE(result.isUsable());
  EXPECT_TRUE(rigid3dNear(result.modelToPhantom, truth, 0.03, 1));
  const auto rmsOf = [&](const Eigen::Isometry3d& modelToPhantom)
  {
    double squares = 0;
    for (std::size_t i = 0; i < Vertebra.size(); ++i)
    {
      squares += (modelToPhantom * Vertebra[i] - touched[i]).squaredNorm();
    }
    return std::sqrt(squares / double(Vertebra.size()));
  };
  EXPECT_NEAR(result.rmsMm, rmsOf(result.modelToPhantom), 1e-12);
  for (int i = 0; i < 100; ++i)
  {
    const Eigen::Isometry3d nearby = makeRigid(random.normal3(1e-3), random.normal3(0.05)) * result.modelToPhantom;
    EXPECT_GE(rmsOf(nearby), result.rmsMm);
  }
}

TEST(LandmarkRegistration, Residuals_AreOnePerLandmark)
{
  Random random(4);
  Points touched = moved(Vertebra, random.rigid(100), 0, random);
  touched[2] += Eigen::Vector3d(0, 0, 2);
  const LandmarkRegistrationResult result = registerLandmarks(Vertebra, touched);
  ASSERT_TRUE(result.isUsable());
  ASSERT_EQ(result.residualsMm.size(), Vertebra.size());
  for (std::size_t i = 0; i < Vertebra.size(); ++i)
  {
    EXPECT_NEAR(result.residualsMm[i], (result.modelToPhantom * Vertebra[i] - touched[i]).norm(), 1e-12);
    EXPECT_LE(result.residualsMm[i], result.residualsMm[2]);
  }
}

TEST(LandmarkRegistration, TooFewPoints_AreReported)
{
  for (const int count : { 0, 1, 2 })
  {
    const Points points(Vertebra.begin(), Vertebra.begin() + count);
    const LandmarkRegistrationResult result = registerLandmarks(points, points);
    EXPECT_EQ(result.status, Status::TooFewPoints);
    EXPECT_TRUE(says(result.message, { "only " + std::to_string(count), "at least 3" }));
  }
}

TEST(LandmarkRegistration, PointsOnALineOrInOnePlace_AreCollinear)
{
  const Points line = { { 0, 0, 0 }, { 10, 5, 2 }, { 20, 10, 4 }, { -30, -15, -6 } };
  const Points place(4, { 7, 8, 9 });
  for (const Points& degenerate : { line, place })
  {
    const Points good(Vertebra.begin(), Vertebra.begin() + 4);
    for (const auto& [model, phantom] :
      { std::pair(degenerate, degenerate), std::pair(good, degenerate), std::pair(degenerate, good) })
    {
      const LandmarkRegistrationResult result = registerLandmarks(model, phantom);
      EXPECT_EQ(result.status, Status::Collinear);
      EXPECT_TRUE(says(result.message, { "one line" }));
    }
  }
}

TEST(LandmarkRegistration, PointsOnAPlane_AreEnough)
{
  Random random(5);
  const Points plane = { { 0, 0, 0 }, { 40, 0, 0 }, { 0, 30, 0 }, { 35, 30, 0 } };
  const Eigen::Isometry3d truth = random.rigid(100);
  const LandmarkRegistrationResult result = registerLandmarks(plane, moved(plane, truth, 0, random));
  ASSERT_EQ(result.status, Status::Ok);
  EXPECT_TRUE(rigid3dNear(result.modelToPhantom, truth, 1e-9, 1e-9));
}

TEST(LandmarkRegistration, MirrorImage_IsReported)
{
  Random random(6);
  const LandmarkRegistrationResult result = registerLandmarks(Vertebra, moved(mirrored(Vertebra), random.rigid(100), 0.3, random));
  EXPECT_EQ(result.status, Status::Mirrored) << result.rmsMm;
  EXPECT_TRUE(says(result.message, { "mirror image", "order" }));
  EXPECT_FALSE(result.isUsable());
}

TEST(LandmarkRegistration, OneLandmarkThatSlipped_IsNamed)
{
  Random random(8);
  Points touched = moved(Vertebra, random.rigid(100), 0.3, random);
  touched[4] += Eigen::Vector3d(0, 25, -10);
  const LandmarkRegistrationResult result = registerLandmarks(Vertebra, touched);
  EXPECT_EQ(result.status, Status::PoorFit) << result.rmsMm;
  EXPECT_TRUE(says(result.message, { "touch landmark 5 again", "mm (RMS)" }));
  EXPECT_EQ(result.residualsMm.size(), Vertebra.size()) << "there to look at";
}

TEST(LandmarkRegistration, OtherUnit_IsAPoorFit)
{
  Random random(9);
  Points metres = Vertebra;
  for (Eigen::Vector3d& point : metres)
  {
    point /= 1000;
  }
  const LandmarkRegistrationResult result = registerLandmarks(Vertebra, moved(metres, random.rigid(100), 0, random));
  EXPECT_EQ(result.status, Status::PoorFit) << toString(result.status);
  EXPECT_TRUE(says(result.message, { "order", "mm" }));
}

TEST(LandmarkRegistration, OtherOrder_IsFoundAndOffered)
{
  for (unsigned seed = 0; seed < 50; ++seed)
  {
    Random random(100 + seed);
    const Eigen::Isometry3d truth = random.rigid(100);
    std::vector<int> touchedAs = { 0, 1, 2, 3, 4, 5 };
    while (std::is_sorted(touchedAs.begin(), touchedAs.end()))
    {
      for (int i = 5; i > 0; --i)
      {
        std::swap(touchedAs[std::size_t(i)], touchedAs[std::size_t(random.integer(0, i))]);
      }
    }
    const Points touched = reordered(moved(Vertebra, truth, 0.3, random), touchedAs);
    const LandmarkRegistrationResult wrong = registerLandmarks(Vertebra, touched);
    ASSERT_EQ(wrong.status, Status::WrongOrder) << seed << ": " << wrong.message;
    EXPECT_TRUE(says(wrong.message, { "mm (RMS)", "another order", "taken in the order" }));
    ASSERT_EQ(wrong.suggestedOrder.size(), 6U);
    for (std::size_t i = 0; i < 6; ++i)
    {
      EXPECT_EQ(touchedAs[std::size_t(wrong.suggestedOrder[i])], int(i)) << seed;
    }
    const LandmarkRegistrationResult right = registerLandmarks(Vertebra, reordered(touched, wrong.suggestedOrder));
    ASSERT_TRUE(right.isUsable());
    EXPECT_NEAR(right.rmsMm, wrong.suggestedRmsMm, 1e-9);
    EXPECT_TRUE(right.suggestedOrder.empty());
    EXPECT_TRUE(rigid3dNear(right.modelToPhantom, truth, 0.02, 0.7));
  }
}

TEST(LandmarkRegistration, OrderOfTwelveLandmarks_IsFoundAsWell)
{
  Random random(31);
  Points model;
  for (int i = 0; i < 12; ++i)
  {
    model.push_back(random.uniform3(60));
  }
  Points touched = moved(model, random.rigid(100), 0.3, random);
  std::reverse(touched.begin(), touched.end());
  const LandmarkRegistrationResult result = registerLandmarks(model, touched);
  ASSERT_EQ(result.status, Status::WrongOrder) << result.message;
  EXPECT_EQ(result.suggestedOrder, (std::vector<int>{ 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0 }));
}

TEST(LandmarkRegistration, SymmetricLandmarks_AreSaidNotToShowTheirOrder)
{
  Random random(32);
  const Points square = { { 0, 0, 0 }, { 40, 0, 0 }, { 40, 40, 0 }, { 0, 40, 0 } };
  const LandmarkRegistrationResult good = registerLandmarks(square, moved(square, random.rigid(100), 0.1, random));
  ASSERT_EQ(good.status, Status::Ok);
  EXPECT_TRUE(says(good.message, { "too symmetric" }));
  EXPECT_EQ(good.suggestedOrder.size(), 4U);
  const Points crossed = { square[1], square[0], square[2], square[3] };
  const LandmarkRegistrationResult wrong = registerLandmarks(square, moved(crossed, random.rigid(100), 0.1, random));
  EXPECT_EQ(wrong.status, Status::WrongOrder);
  EXPECT_TRUE(says(wrong.message, { "and in the order", "too symmetric to tell" }));
}

TEST(LandmarkRegistration, LeavingOneOut_IsSaidOfEach)
{
  Random random(33);
  Points touched = moved(Vertebra, random.rigid(100), 0.1, random);
  touched[3] += Eigen::Vector3d(0, 0, 4);
  const LandmarkRegistrationResult result = registerLandmarks(Vertebra, touched);
  ASSERT_TRUE(result.isUsable()) << result.message;
  EXPECT_EQ(result.worst, 3);
  ASSERT_EQ(result.leftOut.size(), 6U);
  EXPECT_LT(result.leftOut[3].rmsMm, 0.3);
  EXPECT_NEAR(result.leftOut[3].missMm, 4, 0.6) << "more than its residual in the fit that it has bent";
  EXPECT_LT(result.residualsMm[3], 0.9 * result.leftOut[3].missMm);
  EXPECT_TRUE(says(result.message, { "without landmark 4, the worst" }));
  const Points three(Vertebra.begin(), Vertebra.begin() + 3);
  const LandmarkRegistrationResult ofThree = registerLandmarks(three, moved(three, random.rigid(100), 0.1, random));
  EXPECT_TRUE(ofThree.leftOut.empty());
  EXPECT_EQ(ofThree.worst, -1);
}

TEST(LandmarkRegistration, Weights_PullTowardsWhatIsSure)
{
  constexpr unsigned runs = 200;
  double equal = 0, weighted = 0;
  for (unsigned seed = 0; seed < runs; ++seed)
  {
    Random random(5000 + seed);
    const Eigen::Isometry3d truth = random.rigid(100);
    LandmarkRegistrationOptions options;
    Points touched;
    for (std::size_t i = 0; i < Vertebra.size(); ++i)
    {
      const double sigma = i < 2 ? 1.0 : 0.1;
      touched.push_back(truth * Vertebra[i] + random.normal3(sigma));
      options.weights.push_back(1 / (sigma * sigma));
    }
    const Eigen::Vector3d target(10, 0, 30);
    const auto squaredError = [&](const LandmarkRegistrationResult& result)
    { return (result.modelToPhantom * target - truth * target).squaredNorm() / runs; };
    equal += squaredError(registerLandmarks(Vertebra, touched));
    weighted += squaredError(registerLandmarks(Vertebra, touched, options));
  }
  EXPECT_LT(std::sqrt(weighted), 0.5 * std::sqrt(equal));
  LandmarkRegistrationOptions alike;
  alike.weights.assign(Vertebra.size(), 7.5);
  Random random(34);
  const Points touched = moved(Vertebra, random.rigid(100), 0.3, random);
  EXPECT_TRUE(rigid3dNear(
    registerLandmarks(Vertebra, touched, alike).modelToPhantom, registerLandmarks(Vertebra, touched).modelToPhantom, 1e-12, 1e-10));
}

TEST(LandmarkRegistration, PredictedError_IsThatOfFitzpatrickAndWest)
{
  LandmarkRegistrationOptions options;
  options.localizationErrorMm = 0.6;
  options.targets_Model = { { 5, -3, 40 }, { 0, 0, 0 }, { -60, 20, 10 } };
  Random random(35);
  const LandmarkRegistrationResult result = registerLandmarks(Vertebra, moved(Vertebra, random.rigid(100), 0.1, random), options);
  ASSERT_TRUE(result.isUsable());
  EXPECT_EQ(result.localizationErrorMm, 0.6);
  Eigen::Matrix3Xd model(3, 6);
  for (int i = 0; i < 6; ++i)
  {
    model.col(i) = Vertebra[std::size_t(i)];
  }
  const Eigen::Vector3d middle = model.rowwise().mean();
  const Eigen::Matrix3Xd centred = model.colwise() - middle;
  const Eigen::Matrix3d axes = Eigen::JacobiSVD<Eigen::Matrix3Xd>(centred, Eigen::ComputeFullU).matrixU();
  ASSERT_EQ(result.targetTreMm.size(), 3U);
  for (std::size_t t = 0; t < 3; ++t)
  {
    double sum = 0;
    for (int k = 0; k < 3; ++k)
    {
      const auto squaredDistance = [&](const Eigen::Vector3d& point)
      { return point.squaredNorm() - std::pow(point.dot(axes.col(k)), 2); };
      double f = 0;
      for (int i = 0; i < 6; ++i)
      {
        f += squaredDistance(centred.col(i)) / 6;
      }
      sum += squaredDistance(options.targets_Model[t] - middle) / f / 3;
    }
    EXPECT_NEAR(result.targetTreMm[t], std::sqrt(0.36 / 6 * (1 + sum)), 1e-9);
  }
}

TEST(LandmarkRegistration, PredictedError_IsWhatHappens)
{
  // Equal and unequal weights, with the error of touching estimated from the residuals (mean square over the runs).
  for (const bool weighted : { false, true })
  {
    LandmarkRegistrationOptions options;
    options.targets_Model = { { 5, -3, 60 } };
    std::vector<double> sigmas(6, 0.4);
    if (weighted)
    {
      sigmas = { 0.4, 0.2, 0.8, 0.4, 0.3, 0.6 };
      for (double sigma : sigmas)
      {
        options.weights.push_back(0.16 / (sigma * sigma));
      }
    }
    constexpr unsigned runs = 2000;
    double happened = 0, predicted = 0, touching = 0;
    for (unsigned seed = 0; seed < runs; ++seed)
    {
      Random random(7000 + seed);
      const Eigen::Isometry3d truth = random.rigid(100);
      Points touched;
      for (std::size_t i = 0; i < 6; ++i)
      {
        touched.push_back(truth * Vertebra[i] + random.normal3(sigmas[i]));
      }
      const LandmarkRegistrationResult result = registerLandmarks(Vertebra, touched, options);
      ASSERT_TRUE(result.isUsable());
      const Eigen::Vector3d& target = options.targets_Model[0];
      happened += (result.modelToPhantom * target - truth * target).squaredNorm() / runs;
      predicted += std::pow(result.targetTreMm[0], 2) / runs;
      touching += std::pow(result.localizationErrorMm, 2) / runs;
    }
    EXPECT_NEAR(std::sqrt(touching), 0.4 * std::sqrt(3.0), 0.02);
    EXPECT_NEAR(std::sqrt(predicted) / std::sqrt(happened), 1, 0.05) << (weighted ? "weighted" : "equal");
  }
}

TEST(LandmarkRegistration, ThreePointsMirrored_CannotBeTold)
{
  // Three points lie on a plane: mirrored, they are a motion of themselves.
  Random random(7);
  const Points three(Vertebra.begin(), Vertebra.begin() + 3);
  EXPECT_EQ(registerLandmarks(three, moved(mirrored(three), random.rigid(100), 0, random)).status, Status::Ok);
}

TEST(LandmarkRegistration, BadInput_ThrowsASentence)
{
  Points shorter = Vertebra, damaged = Vertebra;
  shorter.pop_back();
  damaged[1].y() = std::nan("");
  expectInvalidArgument([&] { (void)registerLandmarks(Vertebra, shorter); }, { "6 landmarks", "5 were touched" });
  expectInvalidArgument([&] { (void)registerLandmarks(Vertebra, damaged); }, { "landmark 2", "finite" });
  expectInvalidArgument([&] { (void)registerLandmarks(damaged, Vertebra); }, { "landmark 2", "finite" });
  LandmarkRegistrationOptions options;
  options.weights = { 1, 1 };
  expectInvalidArgument([&] { (void)registerLandmarks(Vertebra, Vertebra, options); }, { "2 weights for 6 landmarks" });
  options.weights = { 1, 1, 0, 1, 1, 1 };
  expectInvalidArgument([&] { (void)registerLandmarks(Vertebra, Vertebra, options); }, { "weight of landmark 3", "positive" });
  options = {};
  options.targets_Model = { { 0, std::nan(""), 0 } };
  expectInvalidArgument([&] { (void)registerLandmarks(Vertebra, Vertebra, options); }, { "target 1", "finite" });
  expectInvalidArgument([&] { (void)reordered(Vertebra, { 0, 1, 2, 3, 4, 4 }); }, { "each of them once" });
}

TEST(LandmarkRegistration, ToString_NamesEachStatusDifferently)
{
  std::set<std::string> names;
  for (const Status status :
    { Status::Ok, Status::TooFewPoints, Status::Collinear, Status::Mirrored, Status::PoorFit, Status::WrongOrder })
  {
    names.insert(toString(status));
  }
  EXPECT_EQ(names.size(), 6U);
  EXPECT_EQ(names.count("unknown"), 0U);
}
