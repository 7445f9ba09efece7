// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The fit to the pixels from starts that are not good, of small and half hidden balls: it arrives, or says that it does not.
#include "EvenLightFit.h"

#include "LinearLightImage.h"
#include "SphereRenderer.h"
#include "TestCameras.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace handeye;
using namespace handeye::test;
using namespace handeye::simulation;

namespace
{

/// A ball in even light, whose right part is covered from a column on, and its true outline.
struct Scene
{
  Scene(double imageRadiusPx, bool isHalf, bool isShaded, double noise)
    : radiusPx(imageRadiusPx)
  {
    ball.center_Camera = Eigen::Vector3d(1.3, -2.1, 15 / std::sin(std::atan(radiusPx / Focal)));
    ball.isShaded = isShaded;
    cone.axis_Camera = ball.center_Camera.normalized();
    cone.halfAngle = std::asin(ball.radiusMm / ball.center_Camera.norm());
    outline = cone.outline(camera, std::max(48, int(2 * EIGEN_PI * radiusPx)));
    SphereScene scene(camera);
    scene.add(ball);
    const int column = int(std::lround(camera.project(cone.axis_Camera).point_Image.x())) + 1;
    if (isHalf)
    {
      scene.cover(cv::Rect(column, 0, camera.width() - column, camera.height()));
    }
    Photograph how;
    how.blurPx = BlurPx;
    how.noise = noise;
    how.seed = 5;
    image = scene.photograph(how);
    for (std::size_t i = 0; i < outline.points_Image.size(); ++i)
    {
      if (!isHalf || outline.points_Image[i].x() < column - 0.5)
      {
        support.push_back(i);
      }
    }
  }

  std::optional<EvenLightResult> fitFrom(const Eigen::Vector3d& step, double blurPx = BlurPx) const
  {
    return fitInEvenLight(LinearLightImage(image), outline, { step, support, radiusPx, blurPx });
  }

  /// How far the outline is from the true one, at most along what is seen, px.
  double missPx(const EvenLightResult& result) const
  {
    double most = 0;
    for (const std::size_t i : support)
    {
      most = std::max(most, std::abs(outline.rates[i].dot(result.step)));
    }
    return most;
  }

  static constexpr double Focal = 600, BlurPx = 0.75;
  const CameraModel camera = makeCamera(320, 240, Focal, Focal, 160.2, 119.6, {});
  double radiusPx;
  RenderedBall ball;
  SphereCone cone;
  SphereCone::Outline outline;
  cv::Mat image;
  std::vector<std::size_t> support;
};

/// A shift of the outline by so many px to one side, and of its radius.
Eigen::Vector3d stepOf(double px, double angle, double radiusPx)
{
  return Eigen::Vector3d(px * std::cos(angle), px * std::sin(angle), radiusPx) / Scene::Focal;
}

}  // namespace

TEST(EvenLightFit, FromStartsThatAreOff_ItArrives)
{
  for (const double radiusPx : { 6.0, 9.0, 30.0 })
  {
    for (const bool isHalf : { false, true })
    {
      const Scene scene(radiusPx, isHalf, false, 1);
      int arrived = 0, tried = 0;
      for (const double px : { 0.0, 0.15, 0.3 })
      {
        for (int direction = 0; direction < 8; ++direction)
        {
          const std::optional<EvenLightResult> result = scene.fitFrom(stepOf(px, direction * EIGEN_PI / 4, 0.5 * px), 0.65);
          ++tried;
          arrived += result ? 1 : 0;
          if (result)
          {
            EXPECT_LT(scene.missPx(*result), 0.12) << radiusPx << " px, half " << isHalf << ", from " << px << " px, " << direction;
          }
        }
      }
      EXPECT_GE(arrived, tried - 1) << radiusPx << " px, half " << isHalf;
    }
  }
}

TEST(EvenLightFit, ShadedBall_IsFittedWellOrNotAtAll)
{
  for (const double radiusPx : { 9.0, 30.0, 60.0 })
  {
    const Scene scene(radiusPx, false, true, 1);
    const std::optional<EvenLightResult> result = scene.fitFrom(stepOf(0.1, 1, 0));
    std::printf("%.0f px: %s %.3f px off\n", radiusPx, result ? "fitted," : "not fitted,", result ? scene.missPx(*result) : 0);
    if (result)
    {
      EXPECT_LT(scene.missPx(*result), 0.1) << radiusPx;
    }
  }
}

TEST(EvenLightFit, TooLittleToGoBy_IsNotFitted)
{
  Scene scene(9, true, false, 1);
  scene.support.resize(6);
  EXPECT_FALSE(scene.fitFrom(stepOf(0.2, 0, 0)));
}
