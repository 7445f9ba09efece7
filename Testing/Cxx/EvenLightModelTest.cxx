// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EvenLightModel.h"

#include "TestCameras.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>

using namespace handeye;
using namespace handeye::test;

namespace
{

/// A ball in even light, in front of something even, partly behind something with a straight edge; without noise.
class EvenLight : public testing::Test
{
protected:
  static constexpr double BlurPx = 0.8, RadiusPx = 40;

  EvenLight()
  {
    cone.axis_Camera = Eigen::Vector3d(0.05, -0.04, 1).normalized();
    cone.halfAngle = std::atan(RadiusPx / 500);
    outline = cone.outline(camera, 200);
  }

  /// Of a pixel by what it is that it sees: the ball where it is inside, what hides beyond the line, else what is around.
  Eigen::Vector3f lightAt(const Eigen::Vector2d& place_Image) const
  {
    // The blur, by adding up over a grid of places.
    constexpr int Steps = 24;
    constexpr double Reach = 3.5;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weights = 0;
    for (int i = 0; i < Steps; ++i)
    {
      for (int k = 0; k < Steps; ++k)
      {
        const Eigen::Vector2d away(Reach * (2 * (i + 0.5) / Steps - 1), Reach * (2 * (k + 0.5) / Steps - 1));
        const double weight = std::exp(-away.squaredNorm() / 2);
        sum += weight * sharpLightAt(place_Image + BlurPx * away).cast<double>();
        weights += weight;
      }
    }
    return (sum / weights).cast<float>();
  }

  Eigen::Vector3f sharpLightAt(const Eigen::Vector2d& place_Image) const
  {
    if (isHiding && normal_Image.dot(place_Image) > beyondPx)
    {
      return ofHiding;
    }
    const Eigen::Vector3d ray = camera.unproject(place_Image).ray_Camera;
    return std::acos(std::min(1.0, ray.dot(cone.axis_Camera))) < cone.halfAngle ? ofBall : ofRest;
  }

  /// The pixels along the outline, with the light that they have.
  std::vector<OutlinePixel> pixels() const
  {
    std::vector<OutlinePixel> all;
    const Eigen::Vector2d centre = camera.project(cone.axis_Camera).point_Image;
    for (int y = int(centre.y() - RadiusPx) - 8; y <= centre.y() + RadiusPx + 8; ++y)
    {
      for (int x = int(centre.x() - RadiusPx) - 8; x <= centre.x() + RadiusPx + 8; ++x)
      {
        OutlinePixel pixel;
        pixel.place_Image = Eigen::Vector2f(float(x), float(y));
        const Eigen::Vector2d place(x, y);
        double nearest = 1e300;
        for (std::size_t i = 0; i < outline.points_Image.size(); ++i)
        {
          const double apart = (place - outline.points_Image[i]).norm();
          pixel.index = apart < nearest ? i : pixel.index;
          nearest = std::min(nearest, apart);
        }
        pixel.offsetPx = float(outline.normals_Image[pixel.index].dot(place - outline.points_Image[pixel.index]));
        if (pixel.offsetPx > -7 && pixel.offsetPx < 6)
        {
          pixel.light = lightAt(place);
          all.push_back(pixel);
        }
      }
    }
    return all;
  }

  /// Point by point: the ball ends there as it should.
  std::vector<char> seen() const
  {
    std::vector<char> isSeen;
    for (const Eigen::Vector2d& point : outline.points_Image)
    {
      isSeen.push_back(!isHiding || normal_Image.dot(point) < beyondPx - 1 ? 1 : 0);
    }
    return isSeen;
  }

  std::vector<HidingEdge> find(const std::vector<OutlinePixel>& all) const
  {
    EvenLightModel model(outline, RadiusPx, BlurPx);
    model.collect(all, model.shallowPx());
    model.average(seen());
    const std::vector<char> isSeen = seen();
    return findHidingEdges({ outline, all, model.inside(), model.outside(), isSeen, model.nearPx(), NoiseVariance });
  }

  static constexpr float NoiseVariance = 1e-6F;
  const CameraModel camera = makeCamera(640, 480, 500, 500, 320, 240, {});
  SphereCone cone;
  SphereCone::Outline outline;
  bool isHiding = true;
  /// The line that hides: what is further along this is behind it.
  Eigen::Vector2d normal_Image = Eigen::Vector2d(0.8, 0.6);
  double beyondPx = Eigen::Vector2d(0.8, 0.6).dot(Eigen::Vector2d(345, 220)) + 12.3;
  const Eigen::Vector3f ofBall{ 0.6F, 0.3F, 0.1F }, ofRest{ 0.1F, 0.15F, 0.2F }, ofHiding{ 0.3F, 0.6F, 0.5F };
};

}  // namespace

TEST_F(EvenLight, StraightHidingEdge_IsFound)
{
  const std::vector<HidingEdge> edges = find(pixels());
  ASSERT_EQ(edges.size(), 2U) << "it crosses the outline twice";
  for (const HidingEdge& edge : edges)
  {
    EXPECT_GT(edge.normal_Image.dot(normal_Image), 0.9) << edge.normal_Image.transpose();
    // Good to about a px before it is fitted.
    const Eigen::Vector2d onEdge = edge.pivot_Image + edge.offsetPx * edge.normal_Image;
    EXPECT_NEAR(normal_Image.dot(onEdge), beyondPx, 1.5);
    EXPECT_LT((edge.light - ofHiding).norm(), 0.01F);
  }
}

TEST_F(EvenLight, WithoutAnythingInFront_ThereIsNoEdge)
{
  isHiding = false;
  EXPECT_TRUE(find(pixels()).empty());
}

/// Gauss and Newton's steps by EvenLightModel::add() end at the line, and at the ball's place.
TEST_F(EvenLight, FittedEdge_IsAtTheLine)
{
  const std::vector<OutlinePixel> all = pixels();
  const std::vector<char> isSeen = seen();
  EvenLightModel model(outline, RadiusPx, BlurPx);
  model.place(Eigen::Vector3d(0.0004, -0.0003, 0.0002), 1.15 * BlurPx, find(all));
  for (int round = 0; round < 12; ++round)
  {
    model.collect(all, model.shallowPx());
    model.average(isSeen);
    const int count = model.parameterCount();
    EvenLightModel::Matrix information = EvenLightModel::Matrix::Identity(count, count) * 1e-9;
    EvenLightModel::Vector right = EvenLightModel::Vector::Zero(count);
    for (const OutlinePixel& pixel : all)
    {
      const PixelDifference difference = model.differenceOf(pixel);
      if (difference.isCounted && difference.isWithin(3))
      {
        model.add(pixel, difference, 1, information, right);
      }
    }
    model.move(information.ldlt().solve(right));
  }
  // The outline's rates are px a radian.
  EXPECT_LT(500 * model.step().norm(), 0.1) << model.step().transpose();
  ASSERT_EQ(model.edges().size(), 2U);
  for (const HidingEdge& edge : model.edges())
  {
    const Eigen::Vector2d onEdge = edge.pivot_Image + edge.offsetPx * edge.normal_Image;
    EXPECT_NEAR(normal_Image.dot(onEdge), beyondPx, 0.1);
  }
}

/// What add() takes for the derivatives are those of the difference, by all parameters. At the truth, where there is none, since the
/// variances that a difference is divided by are taken for constant.
TEST_F(EvenLight, Derivatives_AreTheDifferencesOwn)
{
  const std::vector<OutlinePixel> all = pixels();
  std::vector<HidingEdge> edges = find(all);
  ASSERT_EQ(edges.size(), 2U);
  for (HidingEdge& edge : edges)
  {
    edge.normal_Image = normal_Image;
    edge.offsetPx = beyondPx - normal_Image.dot(edge.pivot_Image);
  }
  EvenLightModel model(outline, RadiusPx, BlurPx);
  model.place(Eigen::Vector3d::Zero(), BlurPx, edges);
  model.collect(all, model.shallowPx());
  model.average(seen());
  const int count = model.parameterCount();
  ASSERT_EQ(count, 8);
  const double steps[] = { 1e-4, 1e-4, 1e-4, 0.02, 0.02, 2e-3, 0.02, 2e-3 };
  int withEdge = 0;
  for (const OutlinePixel& pixel : all)
  {
    const PixelDifference at = model.differenceOf(pixel);
    if (!at.isCounted || !at.isWithin(2))
    {
      continue;
    }
    withEdge += at.edge >= 0 ? 1 : 0;
    OutlinePixel brighter = pixel;
    brighter.light += Eigen::Vector3f(0.02F, -0.01F, 0.03F);
    const PixelDifference off = model.differenceOf(brighter);
    EvenLightModel::Matrix information = EvenLightModel::Matrix::Zero(count, count);
    EvenLightModel::Vector right = EvenLightModel::Vector::Zero(count);
    model.add(brighter, off, 1, information, right);
    for (int parameter = 0; parameter < count; ++parameter)
    {
      EvenLightModel::Vector by = EvenLightModel::Vector::Zero(count);
      by[parameter] = steps[parameter];
      EvenLightModel up = model, down = model;
      up.move(by);
      down.move(-by);
      const PixelDifference above = up.differenceOf(pixel), below = down.differenceOf(pixel);
      if (above.edge != at.edge || below.edge != at.edge || !above.isCounted || !below.isCounted)
      {
        continue;
      }
      SCOPED_TRACE(::testing::Message() << pixel.place_Image.transpose() << ", parameter " << parameter << ", edge " << at.edge);
      const Eigen::Vector3d slope = (above.difference - below.difference).cast<double>() / (2 * by[parameter]);
      // Of the largest that there is: per rad of the outline, per px, per rad of the edge.
      const double tolerance = parameter < 3 ? 10 : parameter % 2 == 1 && parameter > 3 ? 0.1 : 0.03;
      EXPECT_NEAR(std::sqrt(information(parameter, parameter)), slope.norm(), tolerance + 0.03 * slope.norm());
      EXPECT_NEAR(right[parameter], -slope.dot(off.difference.cast<double>()),
        (tolerance + 0.03 * slope.norm()) * double(off.difference.norm()));
    }
  }
  EXPECT_GT(withEdge, 20);
}
