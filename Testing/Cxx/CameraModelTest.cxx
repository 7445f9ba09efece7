// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraModel.h"

#include "GeometryMatchers.h"
#include "Simulation.h"
#include "TestCameras.h"

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include <cmath>
#include <limits>

using namespace handeye;
using namespace handeye::test;

namespace
{

using Status = CameraModel::Status;
constexpr double Infinity = std::numeric_limits<double>::infinity();
const double NotANumber = std::nan("");

/// A lens with coefficients of ordinary size.
CameraModel randomCamera(int coefficientCount, Random& random)
{
  const double extents[14] = { 0.4, 0.2, 0.002, 0.002, 0.05, 0.2, 0.1, 0.02, 0.002, 0.002, 0.002, 0.002, 0.06, 0.06 };
  std::vector<double> coefficients;
  for (int i = 0; i < coefficientCount; ++i)
  {
    coefficients.push_back(random.uniform(-extents[i], extents[i]));
  }
  const double fx = random.uniform(300, 1400);
  return makeCamera(0, 0, fx, fx * random.uniform(0.95, 1.05), random.uniform(200, 500), random.uniform(200, 400), coefficients);
}

Eigen::Vector2d projectWithOpenCV(const CameraModel& camera, const Eigen::Vector3d& point_Camera)
{
  const cv::Matx33d cameraMatrix(camera.fx(), 0, camera.cx(), 0, camera.fy(), camera.cy(), 0, 0, 1);
  std::vector<cv::Point2d> projected;
  cv::projectPoints(std::vector<cv::Point3d>{ { point_Camera.x(), point_Camera.y(), point_Camera.z() } }, cv::Vec3d(0, 0, 0),
    cv::Vec3d(0, 0, 0), cameraMatrix, camera.distortionCoefficients(), projected);
  return { projected[0].x, projected[0].y };
}

class CoefficientCount : public testing::TestWithParam<int>
{
};

INSTANTIATE_TEST_SUITE_P(CameraModel, CoefficientCount, testing::Values(0, 4, 5, 8, 12, 14));

}  // namespace

TEST_P(CoefficientCount, Project_AgreesWithOpenCV)
{
  Random random(100U + unsigned(GetParam()));
  for (int lens = 0; lens < 50; ++lens)
  {
    const CameraModel camera = randomCamera(GetParam(), random);
    for (int i = 0; i < 100; ++i)
    {
      const double depth = random.uniform(20, 2000);
      const Eigen::Vector3d point_Camera(random.uniform(-0.9, 0.9) * depth, random.uniform(-0.9, 0.9) * depth, depth);
      const CameraModel::Projection projection = camera.project(point_Camera);
      ASSERT_EQ(projection.isUsable(), point_Camera.hnormalized().norm() < camera.maximumRadius());
      if (projection.isUsable())
      {
        ASSERT_TRUE(pointNear(projection.point_Image, projectWithOpenCV(camera, point_Camera), 1e-9));
      }
    }
  }
}

TEST_P(CoefficientCount, Jacobian_AgreesWithDifferences)
{
  Random random(200U + unsigned(GetParam()));
  int compared = 0;
  for (int lens = 0; lens < 40; ++lens)
  {
    const CameraModel camera = randomCamera(GetParam(), random);
    const Eigen::Vector3d point_Camera(random.uniform(-60, 60), random.uniform(-60, 60), random.uniform(100, 200));
    Eigen::Matrix<double, 2, 3> jacobian;
    if (!camera.project(point_Camera, &jacobian).isUsable())
    {
      continue;
    }
    ++compared;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double step = 1e-3;
      const Eigen::Vector3d offset = step * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector2d difference =
        (camera.project(point_Camera + offset).point_Image - camera.project(point_Camera - offset).point_Image) / (2 * step);
      EXPECT_TRUE(pointNear(jacobian.col(axis), difference, 1e-7 * (1 + difference.norm())));
    }
  }
  EXPECT_GE(compared, 30);
}

TEST(CameraModel, Project_OfAKnownPoint)
{
  const CameraModel camera = makeCamera(640, 480, 500, 400, 320, 240, { 0.1, 0, 0, 0 });
  // x = 0.5, y = 0, r2 = 0.25, radial = 1.025
  EXPECT_TRUE(pointNear(camera.project({ 50, 0, 100 }).point_Image, Eigen::Vector2d(320 + 500 * 0.5125, 240), 1e-12));
  EXPECT_TRUE(pointNear(camera.project({ 0, -50, 100 }).point_Image, Eigen::Vector2d(320, 240 - 400 * 0.5125), 1e-12));
}

TEST(CameraModel, Unproject_IsUndoneByProjectOverTheWholeImage)
{
  for (const NamedCamera& named : allCameras())
  {
    SCOPED_TRACE(named.name);
    const CameraModel& camera = named.camera;
    for (int row = 0; row <= 24; ++row)
    {
      for (int column = 0; column <= 32; ++column)
      {
        const Eigen::Vector2d pixel(column * (camera.width() - 1) / 32.0, row * (camera.height() - 1) / 24.0);
        const CameraModel::Unprojection ray = camera.unproject(pixel);
        ASSERT_EQ(ray.status, Status::Ok) << pixel.transpose();
        ASSERT_NEAR(ray.ray_Camera.norm(), 1, 1e-14);
        ASSERT_GT(ray.ray_Camera.z(), 0);
        const CameraModel::Projection back = camera.project(123.4 * ray.ray_Camera);
        ASSERT_EQ(back.status, Status::Ok) << pixel.transpose();
        ASSERT_TRUE(pointNear(back.point_Image, pixel, 1e-8));
      }
    }
  }
}

TEST(CameraModel, Unproject_FindsTheRayOfAProjectedPoint)
{
  Random random(3);
  for (const NamedCamera& named : allCameras())
  {
    SCOPED_TRACE(named.name);
    for (int i = 0; i < 200; ++i)
    {
      const Eigen::Vector3d point_Camera = randomPointInView(named.camera, { 50, 900, 0 }, random);
      const CameraModel::Unprojection ray = named.camera.unproject(named.camera.project(point_Camera).point_Image);
      ASSERT_EQ(ray.status, Status::Ok);
      ASSERT_TRUE(pointNear(ray.ray_Camera, point_Camera.normalized(), 1e-9));
    }
  }
}

TEST(CameraModel, PointBeyondTheFold_IsOutsideLensModel)
{
  const CameraModel camera = barrel();
  EXPECT_NEAR(camera.maximumRadius(), 1 / std::sqrt(1.2), 1e-9);  // 1 + 3 k1 r^2 = 0
  EXPECT_EQ(camera.project({ 300, 0, 100 }).status, Status::OutsideLensModel);
  EXPECT_EQ(camera.project({ 0, -95, 100 }).status, Status::OutsideLensModel);
  EXPECT_EQ(camera.project({ 90, 0, 100 }).status, Status::Ok);
}

TEST(CameraModel, PixelBeyondTheFold_IsOutsideLensModel)
{
  // The largest distorted radius is 0.9129 (1 - 0.4 * 0.8333) = 0.6086, which is 486.9 px from the principal point.
  const CameraModel camera = barrel();
  EXPECT_EQ(camera.unproject({ 319.5 + 480, 239.5 }).status, Status::Ok);
  EXPECT_NE(camera.unproject({ 319.5 + 495, 239.5 }).status, Status::Ok);
  EXPECT_NE(camera.unproject({ 319.5, 239.5 - 2000 }).status, Status::Ok);
}

TEST(CameraModel, LensThatDoesNotFold_HasNoLimit)
{
  EXPECT_EQ(pinhole().maximumRadius(), Infinity);
  EXPECT_EQ(makeCamera(640, 480, 500, 500, 320, 240, { 0.2, 0, 0, 0 }).maximumRadius(), Infinity);
  EXPECT_EQ(passThrough().maximumRadius(), Infinity);
}

TEST(CameraModel, PointThatIsNotInFront_IsBehindCamera)
{
  EXPECT_EQ(webcam().project({ 10, 20, -300 }).status, Status::BehindCamera);
  EXPECT_EQ(webcam().project({ 10, 20, 0 }).status, Status::BehindCamera);
  EXPECT_FALSE(webcam().project({ NotANumber, 20, 300 }).isUsable());
  EXPECT_FALSE(webcam().unproject({ NotANumber, 20 }).isUsable());
  EXPECT_FALSE(webcam().unproject({ Infinity, 20 }).isUsable());
}

TEST(CameraModel, WithImageSize_FillsInOrConfirms)
{
  const CameraModel sizeless(0, 0, webcam().cameraMatrix(), webcam().distortionCoefficients());
  EXPECT_FALSE(sizeless.hasImageSize());
  const CameraModel sized = sizeless.withImageSize(640, 480);
  EXPECT_TRUE(sized.hasImageSize());
  EXPECT_EQ(sized.width(), 640);
  EXPECT_EQ(sized.height(), 480);
  EXPECT_EQ(sized.cameraMatrix(), webcam().cameraMatrix());
  EXPECT_EQ(sized.distortionCoefficients(), webcam().distortionCoefficients());
  EXPECT_EQ(sized.withImageSize(640, 480).width(), 640);
  expectInvalidArgument([&] { (void)sized.withImageSize(1280, 720); }, { "640 x 480", "1280 x 720" });
}

TEST(CameraModel, BadInput_ThrowsASentence)
{
  const Eigen::Matrix3d good = webcam().cameraMatrix();
  const auto expectRefused = [](int width, int height, const Eigen::Matrix3d& matrix, const std::vector<double>& coefficients,
                               const std::vector<std::string>& words)
  { expectInvalidArgument([&] { CameraModel(width, height, matrix, coefficients); }, words); };
  expectRefused(-1, 480, good, {}, { "image size", "-1 x 480" });
  expectRefused(640, 0, good, {}, { "image size", "640 x 0" });
  expectRefused(640, 480, good, { 0.1 }, { "1 distortion coefficients", "0, 4, 5, 8, 12 or 14" });
  expectRefused(640, 480, good, std::vector<double>(15), { "15 distortion coefficients" });
  expectRefused(640, 480, good, { 0, 0, NotANumber, 0 }, { "coefficient 3", "finite" });
  expectRefused(640, 480, good, { 0, 0, 0, Infinity }, { "coefficient 4", "finite" });
  for (const double focal : { 0.0, -600.0, NotANumber, Infinity })
  {
    Eigen::Matrix3d matrix = good;
    matrix(1, 1) = focal;
    expectRefused(640, 480, matrix, {}, { "camera matrix", "focal lengths" });
  }
  for (const auto& [row, column] : { std::pair(0, 1), std::pair(1, 0), std::pair(2, 0), std::pair(2, 1), std::pair(2, 2) })
  {
    Eigen::Matrix3d matrix = good;
    matrix(row, column) += 0.01;
    expectRefused(640, 480, matrix, {}, { "camera matrix", "without skew" });
  }
}

TEST(CameraModel, ToString_NamesEachStatusDifferently)
{
  EXPECT_EQ(toString(Status::Ok), "ok");
  EXPECT_EQ(toString(Status::BehindCamera), "behind_camera");
  EXPECT_EQ(toString(Status::OutsideLensModel), "outside_lens_model");
  EXPECT_EQ(toString(Status::NotConverged), "not_converged");
}
