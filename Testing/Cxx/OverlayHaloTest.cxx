// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The halo is as wide as the predicted error: measured in the picture, against plain arithmetic.
#include "ImageBaseline.h"
#include "OverlayLook.h"
#include "OverlayTestScene.h"

#include <gtest/gtest.h>
#include <vtkAppendPolyData.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkSphereSource.h>

#include <cmath>
#include <string>
#include <utility>

namespace
{

using handeye::OverlayLook;
using namespace handeye::test;

/// A near ball on the left and a far one on the right, in one mesh of the `Camera` frame.
struct TwoBalls
{
  Eigen::Vector3d near_Camera{ -25, 2, 110 }, far_Camera{ 42, -4, 270 };
  double nearRadiusMm = 12, farRadiusMm = 25;

  vtkSmartPointer<vtkPolyData> mesh() const
  {
    vtkNew<vtkAppendPolyData> both;
    for (const auto& [middle, radiusMm] : { std::pair(near_Camera, nearRadiusMm), std::pair(far_Camera, farRadiusMm) })
    {
      vtkNew<vtkSphereSource> ball;
      ball->SetCenter(middle.x(), middle.y(), middle.z());
      ball->SetRadius(radiusMm);
      ball->SetThetaResolution(120);
      ball->SetPhiResolution(120);
      ball->Update();
      both->AddInputData(ball->GetOutput());
    }
    both->Update();
    return both->GetOutput();
  }
};

/// How far to the right and down 95 % of a point's errors reach (px), by plain arithmetic: the pixel's derivative by differences.
Eigen::Vector2d reachPx(
  const handeye::CameraModel& camera, const Eigen::Matrix<double, 6, 6>& covariance, const Eigen::Vector3d& point_Camera)
{
  constexpr double step = 1e-5;
  Eigen::Matrix<double, 2, 6> derivative;
  for (int i = 0; i < 6; ++i)
  {
    Eigen::Matrix<double, 6, 1> motion = Eigen::Matrix<double, 6, 1>::Zero();
    motion[i] = step;
    const Eigen::Vector3d turn = motion.head<3>(), moved = point_Camera + turn.cross(point_Camera) + motion.tail<3>();
    const Eigen::Vector3d movedBack = point_Camera - turn.cross(point_Camera) - motion.tail<3>();
    derivative.col(i) = (camera.project(moved).point_Image - camera.project(movedBack).point_Image) / (2 * step);
  }
  return 2.4477 * (derivative * covariance * derivative.transpose()).diagonal().cwiseSqrt();
}

}  // namespace

TEST(OverlayHalo, ErrorHalo_IsAsWideAsThePredictedError)
{
  const double distanceMm = 150, sigmaXMm = 2.5, sigmaYMm = 1;
  const Pipeline pipeline = ballPipeline(20, distanceMm);
  const cv::Mat mask = renderedMask(pipeline);
  OverlayLook look;
  look.surface = false;
  look.errorHalo = true;
  pipeline->SetLook(look);
  EXPECT_FALSE(pipeline->GetPredictedErrorPx());
  const cv::Mat withoutCovariance = rendered(pipeline);
  cv::Mat below = difference(withoutCovariance, fieldVideo());
  below.rowRange(0, FieldHeight / 6).setTo(0);  // the legend says that the error is not known
  EXPECT_EQ(cv::countNonZero(below), 0);

  pipeline->SetCalibrationCovariance(shiftCovariance(sigmaXMm, sigmaYMm));
  const double expectedX = 2.4477 * sigmaXMm * 300 / distanceMm, expectedY = 2.4477 * sigmaYMm * 301 / distanceMm;
  ASSERT_TRUE(pipeline->GetPredictedErrorPx());
  EXPECT_NEAR(*pipeline->GetPredictedErrorPx(), std::hypot(sigmaXMm * 2.0, sigmaYMm * 301 / 150), 0.02);
  const cv::Mat halo = difference(rendered(pipeline), fieldVideo()) > 10;
  const cv::Rect model = cv::boundingRect(mask);
  cv::Mat lower = halo.clone();
  lower.rowRange(0, FieldHeight / 6).setTo(0);
  const cv::Rect around = cv::boundingRect(lower);
  EXPECT_NEAR(model.x - around.x, expectedX, 1.5);
  EXPECT_NEAR(around.br().x - model.br().x, expectedX, 1.5);
  EXPECT_NEAR(model.y - around.y, expectedY, 1.5);
  EXPECT_NEAR(around.br().y - model.br().y, expectedY, 1.5);
  cv::Mat core;
  cv::erode(mask, core, cv::Mat::ones(3, 3, CV_8U));
  EXPECT_EQ(cv::countNonZero(lower & core), 0);  // around the model, not on it
}

TEST(OverlayHalo, ErrorHalo_FollowsPlaceAndDepth)
{
  // Shifts count for the near ball, turns for both, and they go together.
  Eigen::Matrix<double, 6, 6> root = Eigen::Matrix<double, 6, 6>::Zero();
  root.diagonal() << 0.002, 0.003, 0.004, 1.1, 0.6, 0.8;
  root(3, 1) = -0.5;
  root(4, 0) = 0.4;
  const Eigen::Matrix<double, 6, 6> covariance = root * root.transpose();
  const TwoBalls balls;
  for (const bool undistorted : { false, true })
  {
    const handeye::CameraModel lens = barrelCamera(), shownCamera = undistorted ? fieldCamera({}) : lens;
    const Pipeline pipeline = fieldPipeline(lens);
    pipeline->SetModel(balls.mesh());
    pipeline->SetModelToCamera(handeye::toVtk(Eigen::Isometry3d(Eigen::Isometry3d::Identity())));
    OverlayLook look;
    look.undistorted = undistorted;
    pipeline->SetLook(look);
    // In a window that is four times as large: quarters of a pixel.
    constexpr int scale = 4;
    vtkNew<vtkRenderWindow> window;
    window->SetMultiSamples(0);
    pipeline->AttachTo(window);
    const auto shown = [&] { return renderedWindow(window, scale * FieldWidth, scale * FieldHeight); };
    pipeline->SetMaskMode(true);
    cv::Mat mask;
    cv::cvtColor(shown(), mask, cv::COLOR_BGR2GRAY);
    pipeline->SetMaskMode(false);
    const cv::Mat plain = shown();
    look.errorHalo = true;
    pipeline->SetLook(look);
    pipeline->SetCalibrationCovariance(covariance);
    cv::Mat changed = difference(shown(), plain) > 10;
    changed.rowRange(0, scale * FieldHeight / 6).setTo(0);  // the legend
    const int border = scale * (FieldWidth / 2 - 6);
    const auto half = [border](const cv::Mat& whole, bool left)
    { return whole.colRange(left ? 0 : border, left ? border : whole.cols); };
    // 0.6 px: quarters of a pixel, and a ball's depth changes fastest at its edge, by 2 % within the pixel that is looked at.
    for (const bool near : { true, false })
    {
      const cv::Rect ball = cv::boundingRect(half(mask, near)), around = cv::boundingRect(half(changed | mask, near));
      const Eigen::Vector3d middle = near ? balls.near_Camera : balls.far_Camera;
      const double radiusMm = near ? balls.nearRadiusMm : balls.farRadiusMm,
                   depthMm = middle.z() - radiusMm * radiusMm / middle.z();
      const auto reachAt = [&](double x, double y) {
        return reachPx(shownCamera, covariance, { middle.x() + radiusMm * x, middle.y() + radiusMm * y, depthMm });
      };
      const std::string where = std::string(near ? "near" : "far") + (undistorted ? ", straightened" : ", raw");
      EXPECT_NEAR(double(ball.x - around.x) / scale, reachAt(-1, 0).x(), 0.6) << where;
      EXPECT_NEAR(double(around.br().x - ball.br().x) / scale, reachAt(1, 0).x(), 0.6) << where;
      EXPECT_NEAR(double(ball.y - around.y) / scale, reachAt(0, -1).y(), 0.6) << where;
      EXPECT_NEAR(double(around.br().y - ball.br().y) / scale, reachAt(0, 1).y(), 0.6) << where;
    }
    // One size for both would be off by more than the tolerance.
    EXPECT_GT(reachPx(shownCamera, covariance, balls.near_Camera).x(), reachPx(shownCamera, covariance, balls.far_Camera).x() + 3);
    expectLikeBaseline(rendered(pipeline), undistorted ? "Straightened" : "", Threshold);
  }
}
