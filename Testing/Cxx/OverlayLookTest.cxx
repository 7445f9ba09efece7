// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Every look: a picture against its baseline, and what it promises, measured in the picture.
#include "OverlayLook.h"

#include "ImageBaseline.h"
#include "OverlayTestScene.h"

#include <gtest/gtest.h>
#include <vtkAppendPolyData.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkSphereSource.h>

#include <limits>
#include <stdexcept>
#include <utility>

namespace
{

using handeye::OverlayLook;
using namespace handeye::test;

// Averaged differences of edge pixels: another Mesa moves shading by a grey level or two, a fault moves hundreds of pixels.
constexpr double Threshold = 25;

cv::Mat pictureOf(const OverlayLook& look, const handeye::CameraModel& camera = fieldCamera())
{
  const Pipeline pipeline = fieldPipeline(camera);
  pipeline->SetLook(look);
  return rendered(pipeline);
}

handeye::StylusShape smallStylus()
{
  handeye::StylusShape shape;
  shape.ballRadiusMm = 5;
  shape.shaftRadiusMm = 2.5;
  shape.shaftLengthMm = 80;
  shape.rayLengthMm = 60;
  return shape;
}

/// The stylus with its tip here, its shaft towards the camera and the upper right.
void holdStylus(const Pipeline& pipeline, const Eigen::Vector3d& tip_Camera)
{
  pipeline->SetStylusShape(smallStylus());
  pipeline->SetStylusTipToCamera(handeye::toVtk(pose({ 1, 1, 0 }, 0.7, tip_Camera)));
}

cv::Mat difference(const cv::Mat& a, const cv::Mat& b)
{
  cv::Mat result;
  cv::absdiff(a, b, result);
  cv::cvtColor(result, result, cv::COLOR_BGR2GRAY);
  return result;
}

/// A ball in the picture's middle.
Pipeline ballPipeline(double radiusMm, double distanceMm)
{
  const Pipeline pipeline = fieldPipeline();
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(radiusMm);
  ball->SetThetaResolution(90);
  ball->SetPhiResolution(90);
  ball->Update();
  pipeline->SetModel(ball->GetOutput());
  pipeline->SetModelToCamera(handeye::toVtk(pose({ 0, 0, 1 }, 0, { 0, 0, distanceMm })));
  return pipeline;
}

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

Eigen::Matrix<double, 6, 6> shiftCovariance(double sigmaXMm, double sigmaYMm)
{
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  covariance(3, 3) = sigmaXMm * sigmaXMm;
  covariance(4, 4) = sigmaYMm * sigmaYMm;
  return covariance;
}

}  // namespace

TEST(OverlayLook, Plain_LooksAsBefore)
{
  expectLikeBaseline(pictureOf({}), "", Threshold);
}

TEST(OverlayLook, RawBarrel_LooksAsBefore)
{
  expectLikeBaseline(pictureOf({}, barrelCamera()), "", Threshold);
}

TEST(OverlayLook, UndistortedBarrel_LooksAsBefore)
{
  OverlayLook look;
  look.undistorted = true;
  expectLikeBaseline(pictureOf(look, barrelCamera()), "", Threshold);
}

TEST(OverlayLook, Outline_LooksAsBefore)
{
  OverlayLook look;
  look.outline = true;
  expectLikeBaseline(pictureOf(look), "", Threshold);
  look.surface = false;
  expectLikeBaseline(pictureOf(look), "Alone", Threshold);
}

TEST(OverlayLook, Wireframe_LooksAsBefore)
{
  OverlayLook look;
  look.wireframe = true;
  const Pipeline pipeline = fieldPipeline();
  pipeline->SetLook(look);
  pipeline->SetModelOpacity(1);
  expectLikeBaseline(rendered(pipeline), "", 60);  // thousands of lines of a pixel's width: all of them are edges
}

TEST(OverlayLook, Clipping_LooksAsBefore)
{
  OverlayLook look;
  look.clipping = true;
  look.clippingDepth = 0.4;
  expectLikeBaseline(pictureOf(look), "", Threshold);
}

TEST(OverlayLook, Keyhole_LooksAsBefore)
{
  OverlayLook look;
  look.keyhole = true;
  look.keyholeCenter = { 0.55, 0.55 };
  look.keyholeRadius = 0.22;
  expectLikeBaseline(pictureOf(look), "", Threshold);
}

TEST(OverlayLook, Ghosting_LooksAsBefore)
{
  OverlayLook look;
  look.ghosting = true;
  const Pipeline pipeline = fieldPipeline();
  pipeline->SetLook(look);
  pipeline->SetModelOpacity(1);
  expectLikeBaseline(rendered(pipeline), "", Threshold);
}

TEST(OverlayLook, DepthColors_LooksAsBefore)
{
  OverlayLook look;
  look.depthColors = true;
  expectLikeBaseline(pictureOf(look), "", Threshold);
}

TEST(OverlayLook, ErrorHalo_LooksAsBefore)
{
  OverlayLook look;
  look.errorHalo = true;
  look.outline = true;
  const Pipeline pipeline = fieldPipeline();
  pipeline->SetLook(look);
  pipeline->SetCalibrationCovariance(shiftCovariance(1.2, 0.5));
  expectLikeBaseline(rendered(pipeline), "", Threshold);
}

TEST(OverlayLook, Stylus_LooksAsBefore)
{
  const Pipeline pipeline = fieldPipeline();
  pipeline->SetModelOpacity(1);
  holdStylus(pipeline, { 6, -4, 95 });
  expectLikeBaseline(rendered(pipeline), "InFront", Threshold);
  OverlayLook look;
  look.occlusion = false;
  pipeline->SetLook(look);
  expectLikeBaseline(rendered(pipeline), "NotHiding", Threshold);
}

TEST(OverlayLook, Faded_LooksAsBefore)
{
  const Pipeline pipeline = fieldPipeline();
  pipeline->SetFade(0.35);
  pipeline->SetNotice("the phantom is not seen, for 0.4 s");
  expectLikeBaseline(rendered(pipeline), "", Threshold);
}

TEST(OverlayLook, ResizedWindow_LooksAsBefore)
{
  const Pipeline pipeline = fieldPipeline(barrelCamera());
  OverlayLook look;
  look.outline = true;
  look.keyhole = true;
  look.keyholeRadius = 0.3;
  pipeline->SetLook(look);
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  pipeline->AttachTo(window);
  static_cast<void>(renderedWindow(window, 320, 240));
  expectLikeBaseline(renderedWindow(window, 400, 200), "", 60);  // outlines are not smoothed here
}

TEST(OverlayLook, DoubledPixelRatio_IsTheSamePictureFiner)
{
  // A window on a HiDPI screen has twice the device pixels: everything must cover twice as many, lines and halo included.
  const Pipeline pipeline = fieldPipeline();
  OverlayLook look;
  look.outline = true;
  look.outlineWidthPx = 4;
  look.errorHalo = true;
  look.keyhole = true;
  pipeline->SetLook(look);
  pipeline->SetCalibrationCovariance(shiftCovariance(1, 1));
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  pipeline->AttachTo(window);
  const cv::Mat once = renderedWindow(window, FieldWidth, FieldHeight);
  cv::Mat twice = renderedWindow(window, 2 * FieldWidth, 2 * FieldHeight);
  cv::resize(twice, twice, once.size(), 0, 0, cv::INTER_AREA);
  expectLikeBaseline(twice, "", Threshold);
  EXPECT_LT(cv::mean(difference(once, twice))[0], 3);  // grey levels; edges are smooth in the one and not in the other
}

TEST(OverlayLook, Outline_LiesOnTheModelsEdge)
{
  const Pipeline pipeline = ballPipeline(20, 150);
  const cv::Mat mask = renderedMask(pipeline);
  OverlayLook look;
  look.surface = false;
  look.outline = true;
  look.outlineWidthPx = 2;
  pipeline->SetLook(look);
  const cv::Mat picture = rendered(pipeline);
  const cv::Mat changed = difference(picture, fieldVideo()) > 30;
  cv::Mat inside, outside;
  cv::distanceTransform(mask, inside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::distanceTransform(255 - mask, outside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  double signedSum = 0;
  int count = 0;
  for (int v = 0; v < changed.rows; ++v)
  {
    for (int u = 0; u < changed.cols; ++u)
    {
      if (changed.at<uchar>(v, u))
      {
        const bool isInside = mask.at<uchar>(v, u) != 0;
        const double away = isInside ? 0.5 - inside.at<float>(v, u) : outside.at<float>(v, u) - 0.5;
        EXPECT_LT(std::abs(away), 2.5) << u << ", " << v;
        signedSum += away;
        ++count;
      }
    }
  }
  EXPECT_GT(count, 300);
  EXPECT_LT(std::abs(signedSum / count), 0.3);  // as much outside as inside
}

TEST(OverlayLook, Keyhole_LeavesTheVideoOutsideOfItUnchanged)
{
  OverlayLook look;
  look.keyhole = true;
  look.keyholeCenter = { 0.5, 0.5 };
  look.keyholeRadius = 0.2;
  const cv::Mat changed = difference(pictureOf(look), fieldVideo());
  cv::Mat outside(changed.size(), CV_8U, cv::Scalar(255)), inside(changed.size(), CV_8U, cv::Scalar(0));
  const cv::Point middle(FieldWidth / 2, FieldHeight / 2);
  cv::circle(outside, middle, int(0.2 * FieldHeight) + 2, cv::Scalar(0), cv::FILLED);
  cv::circle(inside, middle, int(0.15 * FieldHeight), cv::Scalar(255), cv::FILLED);
  EXPECT_EQ(cv::countNonZero(changed & outside), 0);
  EXPECT_GT(cv::countNonZero(changed & inside), 0.5 * cv::countNonZero(inside));
}

TEST(OverlayLook, ClippingPlane_CutsFromTheNearestToTheFurthest)
{
  const Pipeline pipeline = ballPipeline(20, 150);
  const int whole = cv::countNonZero(renderedMask(pipeline));
  OverlayLook look;
  look.clipping = true;
  int before = whole;
  for (const double depth : { 0.0, 0.55, 0.8, 1.0 })
  {
    look.clippingDepth = depth;
    pipeline->SetLook(look);
    const int left = cv::countNonZero(renderedMask(pipeline));
    EXPECT_LE(left, before) << depth;
    before = left;
    // What is left of a ball beyond a plane: all of it until past the middle, then the disc that the plane cuts, in perspective.
    const double planeMm = 130 + 40 * depth;
    const double disc = (20 * 20 - std::pow(planeMm - 150, 2)) / (planeMm * planeMm);
    const double outline = 20 * 20 / (150.0 * 150 - 20 * 20);
    EXPECT_NEAR(double(left) / whole, depth < 0.5 ? 1 : disc / outline, 0.02) << depth;
  }
}

TEST(OverlayLook, Ghosting_ShowsTheVideosEdgesAndNothingElse)
{
  OverlayLook look;
  const Pipeline pipeline = fieldPipeline();
  pipeline->SetModelOpacity(1);
  const cv::Mat without = difference(rendered(pipeline), fieldVideo());
  look.ghosting = true;
  pipeline->SetLook(look);
  const cv::Mat with = difference(rendered(pipeline), fieldVideo());
  const cv::Mat mask = renderedMask(pipeline);
  cv::Mat grey, edges, flat;
  cv::cvtColor(fieldVideo(), grey, cv::COLOR_BGR2GRAY);
  cv::morphologyEx(grey, edges, cv::MORPH_GRADIENT, cv::Mat::ones(3, 3, CV_8U));
  cv::Mat core;
  cv::erode(mask, core, cv::Mat::ones(5, 5, CV_8U));
  flat = (edges == 0) & core;
  cv::erode(flat, flat, cv::Mat::ones(3, 3, CV_8U));
  const cv::Mat strong = (edges > 90) & core;
  ASSERT_GT(cv::countNonZero(strong), 50);
  EXPECT_LT(cv::mean(with, strong)[0], 0.45 * cv::mean(without, strong)[0]);
  EXPECT_NEAR(cv::mean(with, flat)[0], cv::mean(without, flat)[0], 0.5);
}

TEST(OverlayLook, DepthColors_NearIsRedFarIsBlue)
{
  OverlayLook look;
  look.depthColors = true;
  const Pipeline pipeline = ballPipeline(30, 150);
  pipeline->SetModelOpacity(1);
  pipeline->SetLook(look);
  const cv::Mat picture = rendered(pipeline);
  const cv::Vec3b middle = picture.at<cv::Vec3b>(122, 158), rim = picture.at<cv::Vec3b>(122, 158 + 57);
  EXPECT_GT(middle[2], middle[0] + 80);  // the nearest point of the ball
  EXPECT_GT(rim[1], middle[1]);          // its rim is half way through the range: green
  EXPECT_LT(int(rim[2]) - rim[1], int(middle[2]) - middle[1]);
}

TEST(OverlayLook, ErrorHalo_IsAsWideAsThePredictedError)
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

TEST(OverlayLook, ErrorHalo_FollowsPlaceAndDepth)
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

TEST(OverlayLook, StylusInFront_IsSeenInTheVideo_BehindItIsHidden)
{
  OverlayLook look;
  look.stylus = false;
  const Pipeline pipeline = ballPipeline(30, 150);
  pipeline->SetModelOpacity(1);
  pipeline->SetLook(look);
  const cv::Mat without = rendered(pipeline);
  const cv::Point middle(158, 122);
  holdStylus(pipeline, { 0, 0, 100 });
  const cv::Mat inFront = rendered(pipeline);
  const cv::Rect ball(middle.x - 6, middle.y - 6, 12, 12);
  EXPECT_EQ(largestDifference(inFront(ball), fieldVideo()(ball)), 0);
  EXPECT_GT(largestDifference(without(ball), fieldVideo()(ball)), 20);
  holdStylus(pipeline, { 0, 0, 400 });  // the whole stylus is behind the ball, or beside it
  pipeline->SetStylusTipToCamera(handeye::toVtk(pose({ 1, 0, 0 }, 0, { 0, 0, 400 })));
  EXPECT_EQ(largestDifference(rendered(pipeline), without), 0);
  holdStylus(pipeline, { 0, 0, 100 });
  look.occlusion = false;
  pipeline->SetLook(look);
  EXPECT_EQ(largestDifference(rendered(pipeline), without), 0);
  pipeline->SetStylusTipToCamera(nullptr);
  EXPECT_EQ(largestDifference(rendered(pipeline), without), 0);
}

TEST(OverlayLook, Fade_GoesToTheVideoAlone)
{
  OverlayLook look;
  look.outline = true;
  const Pipeline pipeline = fieldPipeline();
  pipeline->SetLook(look);
  double before = 1e9;
  for (const double fade : { 1.0, 0.6, 0.2, 0.0 })
  {
    pipeline->SetFade(fade);
    const double changed = cv::mean(difference(rendered(pipeline), fieldVideo()))[0];
    EXPECT_LT(changed, before) << fade;
    before = changed;
  }
  EXPECT_EQ(before, 0);
}

TEST(OverlayLook, AllLooksAtOnce_ChangeNoPixelAwayFromTheModel)
{
  OverlayLook look;
  look.outline = look.clipping = look.keyhole = look.ghosting = true;
  const Pipeline pipeline = fieldPipeline(barrelCamera());
  cv::Mat around;
  cv::dilate(renderedMask(pipeline), around, cv::Mat::ones(9, 9, CV_8U));
  pipeline->SetLook(look);
  EXPECT_EQ(cv::countNonZero(difference(rendered(pipeline), fieldVideo()) & ~around), 0);
}

TEST(OverlayLook, UndistortedVideoOfALensWithoutDistortion_IsTheVideo)
{
  OverlayLook look;
  look.undistorted = true;
  const Pipeline pipeline = fieldPipeline(fieldCamera({}));
  pipeline->SetModelVisible(false);
  pipeline->SetLook(look);
  EXPECT_LE(largestDifference(rendered(pipeline), fieldVideo()), 64);  // interpolated between pixels at sharp edges
  EXPECT_LT(cv::mean(difference(rendered(pipeline), fieldVideo()))[0], 1.5);
  const cv::Mat flat = rendered(pipeline)(cv::Rect(60, 50, 20, 20));  // red in the video, and red it stays
  EXPECT_EQ(cv::mean(flat), cv::mean(fieldVideo()(cv::Rect(60, 50, 20, 20))));
}

TEST(OverlayLook, EveryKey_DoesWhatItsHelpSays)
{
  OverlayLook look;
  double opacity = 0.5;
  for (const handeye::OverlayKey& key : handeye::overlayKeys())
  {
    EXPECT_FALSE(key.help.empty()) << key.key;
    EXPECT_NE(handeye::overlayKeyHelp().find(key.help), std::string::npos) << key.key;
    if (key.name.empty())
    {
      continue;
    }
    const bool* value = handeye::findOverlaySwitch(look, key.name);
    ASSERT_NE(value, nullptr) << key.name;
    const bool before = *value;
    EXPECT_TRUE(handeye::applyOverlayKey(key.key, look, opacity));
    EXPECT_EQ(*value, !before) << key.name;
    EXPECT_TRUE(handeye::applyOverlayKey(char(std::toupper(key.key)), look, opacity));
    EXPECT_EQ(*value, before) << key.name;
  }
  EXPECT_EQ(handeye::findOverlaySwitch(look, "nothing"), nullptr);
  EXPECT_FALSE(handeye::applyOverlayKey('#', look, opacity));
  for (int i = 0; i < 20; ++i)
  {
    EXPECT_TRUE(handeye::applyOverlayKey('+', look, opacity));
    EXPECT_TRUE(handeye::applyOverlayKey(']', look, opacity));
    EXPECT_TRUE(handeye::applyOverlayKey('<', look, opacity));
  }
  EXPECT_EQ(opacity, 1);
  EXPECT_EQ(look.clippingDepth, 1);
  EXPECT_GT(look.keyholeRadius, 0);
  look.undistorted = true;
  EXPECT_TRUE(handeye::applyOverlayKey('0', look, opacity));
  EXPECT_EQ(look.clippingDepth, OverlayLook().clippingDepth);
  EXPECT_TRUE(look.undistorted);
}

TEST(OverlayLook, Keys_ChangeThePicture)
{
  const Pipeline pipeline = fieldPipeline();
  const cv::Mat before = rendered(pipeline);
  EXPECT_TRUE(pipeline->HandleKey('o'));
  EXPECT_GT(largestDifference(rendered(pipeline), before), 20);
  EXPECT_TRUE(pipeline->HandleKey('O'));
  EXPECT_EQ(largestDifference(rendered(pipeline), before), 0);
  EXPECT_FALSE(pipeline->HandleKey('#'));
}

TEST(OverlayLook, Nonsense_IsRefused)
{
  const Pipeline pipeline = fieldPipeline();
  const auto refused = [&pipeline](auto change)
  {
    OverlayLook look;
    change(look);
    EXPECT_THROW(pipeline->SetLook(look), std::invalid_argument);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](OverlayLook& look) { look.outlineWidthPx = 0; });
  refused([nan](OverlayLook& look) { look.keyholeRadius = nan; });
  refused([nan](OverlayLook& look) { look.keyholeCenter[1] = nan; });
  refused([](OverlayLook& look) { look.clippingDepth = 1.1; });
  refused([](OverlayLook& look) { look.ghostingStrength = -1; });
  refused([](OverlayLook& look) { look.outlineColor[2] = 2; });
  EXPECT_THROW(pipeline->SetFade(nan), std::invalid_argument);
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
  covariance(2, 2) = nan;
  EXPECT_THROW(pipeline->SetCalibrationCovariance(covariance), std::invalid_argument);
  handeye::StylusShape shape;
  shape.ballRadiusMm = -1;
  EXPECT_THROW(pipeline->SetStylusShape(shape), std::invalid_argument);
}
