// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OutlineHiding.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace handeye;

namespace
{

/// The share by adding up a grid: a blurred pixel at the origin; one line `inside` away in the direction x, one `seen` away in a direction
/// of this cosine.
double shareByGrid(double inside, double seen, double cosine)
{
  constexpr double Step = 0.01, Reach = 6;
  const double sine = std::sqrt(1 - cosine * cosine);
  double sum = 0;
  for (double x = -Reach + Step / 2; x < Reach; x += Step)
  {
    if (x >= inside)
    {
      continue;
    }
    // cosine x + sine y < seen
    const double y = (seen - cosine * x) / sine;
    sum += Step * std::exp(-x * x / 2) / std::sqrt(2 * double(EIGEN_PI)) * 0.5 * std::erfc(-y / std::sqrt(2.0));
  }
  return sum;
}

}  // namespace

TEST(OutlineHiding, ShareOfWedge_IsTheIntegralOfTheBlur)
{
  for (const double cosine : { -0.9, -0.5, 0.0, 0.3, 0.8, 0.95 })
  {
    for (const double inside : { -2.1, -0.4, 0.0, 0.9, 2.6 })
    {
      for (const double seen : { -1.7, 0.0, 0.6, 3.1 })
      {
        SCOPED_TRACE(::testing::Message() << inside << ", " << seen << ", cosine " << cosine);
        EXPECT_NEAR(shareOfWedge(inside, seen, cosine).share, shareByGrid(inside, seen, cosine), 1e-3);
      }
    }
  }
}

TEST(OutlineHiding, ShareOfWedge_HasItsDerivatives)
{
  constexpr double Step = 0.05;
  for (const double cosine : { -0.6, 0.0, 0.7 })
  {
    for (const double inside : { -1.2, 0.1, 1.4 })
    {
      for (const double seen : { -0.8, 0.3, 1.1 })
      {
        SCOPED_TRACE(::testing::Message() << inside << ", " << seen << ", cosine " << cosine);
        const WedgeShare at = shareOfWedge(inside, seen, cosine);
        const auto share = [&](double h, double k) { return shareOfWedge(h, k, cosine).share; };
        EXPECT_NEAR(at.byInside, (share(inside + Step, seen) - share(inside - Step, seen)) / (2 * Step), 2e-3);
        EXPECT_NEAR(at.bySeen, (share(inside, seen + Step) - share(inside, seen - Step)) / (2 * Step), 2e-3);
      }
    }
  }
}

TEST(OutlineHiding, NormalsThatAreNearlyAlike_CountAsAsFarApartAsCanBeTold)
{
  constexpr double Step = 0.02;
  for (const double cosine : { -1.0, -0.99, -0.975, 0.975, 0.99, 1.0 })
  {
    const double told = cosine < 0 ? -0.97 : 0.97;
    for (const double inside : { -1.2, 0.1, 1.4 })
    {
      for (const double seen : { -0.8, 0.3, 1.1 })
      {
        SCOPED_TRACE(::testing::Message() << inside << ", " << seen << ", cosine " << cosine);
        const WedgeShare at = shareOfWedge(inside, seen, cosine), atTold = shareOfWedge(inside, seen, told);
        EXPECT_EQ(at.share, atTold.share);
        const auto share = [&](double h, double k) { return shareOfWedge(h, k, cosine).share; };
        // Ten points of a rule: the bivariate density is narrow there.
        EXPECT_NEAR(at.byInside, (share(inside + Step, seen) - share(inside - Step, seen)) / (2 * Step), 0.02);
        EXPECT_NEAR(at.bySeen, (share(inside, seen + Step) - share(inside, seen - Step)) / (2 * Step), 0.02);
      }
    }
  }
}

TEST(OutlineHiding, FarFromEitherLine_ThereIsOnlyTheOther)
{
  EXPECT_NEAR(shareOfWedge(0.7, 9, 0.4).share, 0.5 * std::erfc(-0.7 / std::sqrt(2.0)), 1e-3);
  EXPECT_NEAR(shareOfWedge(9, -0.3, -0.4).share, 0.5 * std::erfc(0.3 / std::sqrt(2.0)), 1e-3);
  EXPECT_NEAR(shareOfWedge(-9, 1, 0.4).share, 0, 1e-3);
}

TEST(OutlineHiding, Edge_TurnsAboutItsPivot)
{
  HidingEdge edge;
  edge.pivot_Image = { 10, 20 };
  edge.normal_Image = { 0.6, 0.8 };
  edge.offsetPx = 0.5;
  const Eigen::Vector2d place(13, 18);
  const double before = edge.beyondPx(place), rate = edge.turnRate(place);
  EXPECT_NEAR(before, 0.6 * 3 - 0.8 * 2 - 0.5, 1e-12);
  edge.move(0.2, 1e-4);
  EXPECT_NEAR(edge.beyondPx(place), before - 0.2 + 1e-4 * rate, 1e-7);
  EXPECT_NEAR(edge.normal_Image.norm(), 1, 1e-12);
}
