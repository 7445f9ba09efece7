// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Every look: what it promises, measured in the picture; its keys, and what is refused.
#include "ImageBaseline.h"
#include "OverlayLook.h"
#include "OverlayTestScene.h"

#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

using handeye::OverlayLook;
using namespace handeye::test;

TEST(OverlayLookEffect, Outline_LiesOnTheModelsEdge)
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

TEST(OverlayLookEffect, Keyhole_LeavesTheVideoOutsideOfItUnchanged)
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

TEST(OverlayLookEffect, ClippingPlane_CutsFromTheNearestToTheFurthest)
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

TEST(OverlayLookEffect, Ghosting_ShowsTheVideosEdgesAndNothingElse)
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

TEST(OverlayLookEffect, DepthColors_NearIsRedFarIsBlue)
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

TEST(OverlayLookEffect, StylusInFront_IsSeenInTheVideo_BehindItIsHidden)
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

TEST(OverlayLookEffect, Fade_GoesToTheVideoAlone)
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

TEST(OverlayLookEffect, AllLooksAtOnce_ChangeNoPixelAwayFromTheModel)
{
  OverlayLook look;
  look.outline = look.clipping = look.keyhole = look.ghosting = true;
  const Pipeline pipeline = fieldPipeline(barrelCamera());
  cv::Mat around;
  cv::dilate(renderedMask(pipeline), around, cv::Mat::ones(9, 9, CV_8U));
  pipeline->SetLook(look);
  EXPECT_EQ(cv::countNonZero(difference(rendered(pipeline), fieldVideo()) & ~around), 0);
}

TEST(OverlayLookEffect, UndistortedVideoOfALensWithoutDistortion_IsTheVideo)
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

TEST(OverlayLookEffect, EveryKey_DoesWhatItsHelpSays)
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

TEST(OverlayLookEffect, Keys_ChangeThePicture)
{
  const Pipeline pipeline = fieldPipeline();
  const cv::Mat before = rendered(pipeline);
  EXPECT_TRUE(pipeline->HandleKey('o'));
  EXPECT_GT(largestDifference(rendered(pipeline), before), 20);
  EXPECT_TRUE(pipeline->HandleKey('O'));
  EXPECT_EQ(largestDifference(rendered(pipeline), before), 0);
  EXPECT_FALSE(pipeline->HandleKey('#'));
}

TEST(OverlayLookEffect, Nonsense_IsRefused)
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
