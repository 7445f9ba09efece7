// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LandmarkRegistration.h"

#include "GeometryMatchers.h"
#include "Simulation.h"

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

TEST(LandmarkRegistration, OtherOrderOrUnit_IsAPoorFit)
{
  Random random(9);
  Points shuffled = Vertebra, metres = Vertebra;
  std::rotate(shuffled.begin(), shuffled.begin() + 2, shuffled.end());
  for (Eigen::Vector3d& point : metres)
  {
    point /= 1000;
  }
  for (const Points& wrong : { shuffled, metres })
  {
    const LandmarkRegistrationResult result = registerLandmarks(Vertebra, moved(wrong, random.rigid(100), 0, random));
    EXPECT_EQ(result.status, Status::PoorFit) << toString(result.status);
    EXPECT_TRUE(says(result.message, { "order", "mm" }));
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
}

TEST(LandmarkRegistration, ToString_NamesEachStatusDifferently)
{
  std::set<std::string> names;
  for (const Status status : { Status::Ok, Status::TooFewPoints, Status::Collinear, Status::Mirrored, Status::PoorFit })
  {
    names.insert(toString(status));
  }
  EXPECT_EQ(names.size(), 5U);
  EXPECT_EQ(names.count("unknown"), 0U);
}
