// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SphereCone.h"

#include "GeometryMatchers.h"
#include "Simulation.h"
#include "TestCameras.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>

using namespace handeye;
using namespace handeye::test;

namespace
{

struct Ball
{
  Eigen::Vector3d center_Camera;
  double radiusMm;

  SphereCone cone() const { return { center_Camera.normalized(), std::asin(radiusMm / center_Camera.norm()) }; }
};

/// Rays that touch the ball, by plain trigonometry in the ball's own frame.
std::vector<Eigen::Vector3d> tangentRays(const Ball& ball, int count, double fromRad = 0, double toRad = 2 * EIGEN_PI)
{
  const double distance = ball.center_Camera.norm(), alpha = std::asin(ball.radiusMm / distance);
  const Eigen::Matrix3d zToBall =
    Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), ball.center_Camera).toRotationMatrix();
  std::vector<Eigen::Vector3d> rays;
  for (int i = 0; i < count; ++i)
  {
    const double turn = fromRad + (toRad - fromRad) * (i + 0.5) / count;
    rays.push_back(zToBall * Eigen::Vector3d(std::sin(alpha) * std::cos(turn), std::sin(alpha) * std::sin(turn), std::cos(alpha)));
  }
  return rays;
}

/// The rays as the lens shows them: projected, moved by noise (px), and taken back.
std::vector<Eigen::Vector3d> seenRays(
  const std::vector<Eigen::Vector3d>& rays, const CameraModel& camera, double sigmaPx, Random& random)
{
  std::vector<Eigen::Vector3d> seen;
  for (const Eigen::Vector3d& ray : rays)
  {
    Eigen::Vector2d pixel = camera.project(ray).point_Image;
    pixel.x() += random.normal(sigmaPx);
    pixel.y() += random.normal(sigmaPx);
    seen.push_back(camera.unproject(pixel).ray_Camera);
  }
  return seen;
}

/// Balls in the middle and near the corners of the image, near and far.
std::vector<Ball> ballsInView(const CameraModel& camera)
{
  std::vector<Ball> balls;
  for (const auto& [x, y, distance] : { std::tuple(0.5, 0.5, 200.0), std::tuple(0.15, 0.2, 250.0), std::tuple(0.85, 0.75, 600.0),
         std::tuple(0.2, 0.8, 150.0), std::tuple(0.45, 0.6, 90.0) })
  {
    const Eigen::Vector2d pixel(x * camera.width(), y * camera.height());
    balls.push_back({ distance * camera.unproject(pixel).ray_Camera, 15 });
  }
  return balls;
}

SphereCone nearby(const SphereCone& cone)
{
  return { (cone.axis_Camera + Eigen::Vector3d(0.002, -0.003, 0.001)).normalized(), 1.03 * cone.halfAngle };
}

}  // namespace

TEST(SphereCone, Distance_OfAKnownBall)
{
  EXPECT_NEAR((SphereCone{ Eigen::Vector3d::UnitZ(), EIGEN_PI / 6 }.distance(15)), 30, 1e-12);
}

TEST(SphereCone, ThreeRays_GiveTheCone)
{
  for (const Ball& ball : ballsInView(webcam()))
  {
    const std::vector<Eigen::Vector3d> rays = tangentRays(ball, 3);
    for (const SphereCone& cone : { coneThrough(rays[0], rays[1], rays[2]), coneThrough(rays[2], rays[1], rays[0]) })
    {
      EXPECT_TRUE(pointNear(cone.axis_Camera, ball.center_Camera.normalized(), 1e-9));
      EXPECT_NEAR(cone.distance(ball.radiusMm), ball.center_Camera.norm(), 1e-8);
    }
  }
}

TEST(SphereCone, ThreeRaysWithoutACone_GiveNoHalfAngle)
{
  const Eigen::Vector3d a = Eigen::Vector3d(0.1, 0, 1).normalized(), b = Eigen::Vector3d(0.2, 0, 1).normalized();
  EXPECT_EQ(coneThrough(a, b, Eigen::Vector3d(-0.3, 0, 1).normalized()).halfAngle, 0) << "one great circle";
  EXPECT_EQ(coneThrough(a, a, b).halfAngle, 0) << "two of them are the same";
}

TEST(SphereCone, NoiseFreeOutline_GivesAxisAndDistanceThroughEachLens)
{
  Random random(1);
  for (const NamedCamera& named : allCameras())
  {
    for (const Ball& ball : ballsInView(named.camera))
    {
      SCOPED_TRACE(named.name + ", " + std::to_string(ball.center_Camera.norm()) + " mm");
      const auto rays = seenRays(tangentRays(ball, 60), named.camera, 0, random);
      const SphereConeFit fit = fitSphereCone(rays, named.camera, nearby(ball.cone()), 20);
      ASSERT_TRUE(fit.isUsable);
      EXPECT_TRUE(pointNear(fit.cone.axis_Camera, ball.center_Camera.normalized(), 1e-9));
      EXPECT_NEAR(fit.cone.distance(ball.radiusMm) / ball.center_Camera.norm(), 1, 1e-9);
      for (double residual : fit.residualsPx)
      {
        EXPECT_NEAR(residual, 0, 1e-6);
      }
    }
  }
}

TEST(SphereCone, Noise_LeavesNoBiasAndTheCovarianceSaysHowMuch)
{
  constexpr int runs = 400;
  for (const NamedCamera& named : { NamedCamera{ "webcam", webcam() }, NamedCamera{ "laparoscope", laparoscope() } })
  {
    Random random(2);
    const Ball ball = ballsInView(named.camera)[1];
    const Eigen::Vector3d axis = ball.center_Camera.normalized(), across = axis.unitOrthogonal();
    Eigen::Matrix<double, 2, 3> toPlane;
    toPlane << across.transpose(), axis.cross(across).transpose();
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double chiSquares = 0;
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
    for (int run = 0; run < runs; ++run)
    {
      const auto rays = seenRays(tangentRays(ball, 80), named.camera, 0.1, random);
      const SphereConeFit fit = fitSphereCone(rays, named.camera, nearby(ball.cone()), 5);
      ASSERT_TRUE(fit.isUsable);
      const Eigen::Vector2d error = toPlane * (fit.cone.axis_Camera - axis);
      const Eigen::Matrix2d predicted = toPlane * fit.axisCovariance * toPlane.transpose();
      sum += error;
      covariance += predicted / runs;
      chiSquares += error.dot(predicted.inverse() * error);
      EXPECT_NEAR(fit.sigmaPx, 0.1, 0.06);
    }
    const Eigen::Vector2d bias = sum / runs;
    EXPECT_LT(bias.dot((covariance / runs).inverse() * bias), 13.8) << named.name << ": 99.9 % of a chi-square with 2 freedoms";
    EXPECT_GT(chiSquares / runs, 1.6) << named.name;
    EXPECT_LT(chiSquares / runs, 2.6) << named.name;
  }
}

TEST(SphereCone, ThirtyPercentOutliers_HaveNoSay)
{
  Random random(3);
  const CameraModel camera = webcam();
  for (const Ball& ball : ballsInView(camera))
  {
    auto rays = seenRays(tangentRays(ball, 100), camera, 0.1, random);
    for (int i = 0; i < 30; ++i)
    {
      Eigen::Vector2d pixel = camera.project(rays[std::size_t(3 * i)]).point_Image;
      const Eigen::Vector2d middle = camera.project(ball.center_Camera).point_Image;
      pixel += random.uniform(1.5, 6) * (pixel - middle).normalized();  // all outwards: they would draw a mean with them
      rays[std::size_t(3 * i)] = camera.unproject(pixel).ray_Camera;
    }
    const SphereConeFit fit = fitSphereCone(rays, camera, ball.cone(), 6);
    ASSERT_TRUE(fit.isUsable);
    const Eigen::Vector2d found = camera.project(fit.cone.axis_Camera).point_Image;
    EXPECT_TRUE(pointNear(found, camera.project(ball.center_Camera).point_Image, 0.08));
    EXPECT_EQ(fit.weights[0], 0);
    EXPECT_GT(fit.residualsPx[0], 1) << "outside is positive";
    EXPECT_GT(fit.weights[1], 0.3);
  }
}

TEST(SphereCone, SixtyPercentOfTheOutlineMissing_CostsPrecisionOnly)
{
  Random random(4);
  const CameraModel camera = webcam();
  for (const Ball& ball : ballsInView(camera))
  {
    const auto exact = seenRays(tangentRays(ball, 60, 0.4, 0.4 + 0.8 * EIGEN_PI), camera, 0, random);
    const SphereConeFit exactFit = fitSphereCone(exact, camera, nearby(ball.cone()), 20);
    ASSERT_TRUE(exactFit.isUsable);
    EXPECT_TRUE(pointNear(exactFit.cone.axis_Camera, ball.center_Camera.normalized(), 1e-8));
    double chiSquares = 0;
    for (int run = 0; run < 100; ++run)
    {
      const auto rays = seenRays(tangentRays(ball, 60, 0.4, 0.4 + 0.8 * EIGEN_PI), camera, 0.1, random);
      const SphereConeFit fit = fitSphereCone(rays, camera, ball.cone(), 5);
      ASSERT_TRUE(fit.isUsable);
      Eigen::Matrix<double, 2, 3> jacobian;
      const Eigen::Vector2d found = camera.project(fit.cone.axis_Camera, &jacobian).point_Image;
      const Eigen::Vector2d error = found - camera.project(ball.center_Camera).point_Image;
      chiSquares += error.dot((jacobian * fit.axisCovariance * jacobian.transpose()).inverse() * error);
      ASSERT_LT(error.norm(), 0.5);
    }
    EXPECT_GT(chiSquares / 100, 1.2);
    EXPECT_LT(chiSquares / 100, 3.2);
  }
}

TEST(SphereCone, Outline_LiesOnTheProjectedSphere)
{
  for (const NamedCamera& named : allCameras())
  {
    for (const Ball& ball : ballsInView(named.camera))
    {
      SCOPED_TRACE(named.name);
      const SphereCone::Outline outline = ball.cone().outline(named.camera, 72);
      ASSERT_EQ(outline.points_Image.size(), outline.normals_Image.size());
      ASSERT_GT(outline.points_Image.size(), 40U);
      for (std::size_t i = 0; i < outline.points_Image.size(); ++i)
      {
        // The ray of the point passes the centre at one radius.
        const Eigen::Vector3d ray = named.camera.unproject(outline.points_Image[i]).ray_Camera;
        EXPECT_NEAR(ray.cross(ball.center_Camera).norm(), ball.radiusMm, 1e-6);
        EXPECT_NEAR(outline.normals_Image[i].norm(), 1, 1e-12);
        // A pixel outwards passes it further off, and the direction of the outline itself is across the normal.
        const Eigen::Vector3d outside = named.camera.unproject(outline.points_Image[i] + outline.normals_Image[i]).ray_Camera;
        EXPECT_GT(outside.cross(ball.center_Camera).norm(), ball.radiusMm);
        const Eigen::Vector2d along(-outline.normals_Image[i].y(), outline.normals_Image[i].x());
        const Eigen::Vector3d beside = named.camera.unproject(outline.points_Image[i] + 1e-3 * along).ray_Camera;
        EXPECT_NEAR(beside.cross(ball.center_Camera).norm(), ball.radiusMm, 1e-5);
      }
    }
  }
}

TEST(SphereCone, OutlineBeyondTheLens_IsLeftOut)
{
  const CameraModel camera = barrel();
  const SphereCone cone{ Eigen::Vector3d(0.85, 0, 1).normalized(), 0.15 };
  const std::size_t count = cone.outline(camera, 72).points_Image.size();
  EXPECT_LT(count, 72U);
  EXPECT_GT(count, 10U);
}

TEST(SphereCone, TooFewRays_ThrowASentence)
{
  const auto rays = tangentRays({ { 0, 0, 200 }, 15 }, 5);
  expectInvalidArgument([&] { (void)fitSphereCone(rays, webcam(), {}, 5); }, { "at least 6" });
}

TEST(SphereCone, RaysFarFromTheStart_GiveNoFit)
{
  const Ball ball{ { 0, 0, 200 }, 15 };
  const SphereCone elsewhere{ Eigen::Vector3d(0.3, 0.2, 1).normalized(), 0.05 };
  EXPECT_FALSE(fitSphereCone(tangentRays(ball, 40), webcam(), elsewhere, 3).isUsable);
}
