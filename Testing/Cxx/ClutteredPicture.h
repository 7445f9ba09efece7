// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "SphereRenderer.h"
#include "TestCameras.h"

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <vector>

namespace handeye::test
{

/// Pictures full of other things, put together from the rendered captures at their own scale, and balls drawn into them.

struct PictureWithoutBall
{
  cv::Mat image;
  CameraModel camera;
};

/// The rendered frames in which no ball is in view (red rings, pink and wooden things; the last ones: red tissue everywhere).
std::vector<PictureWithoutBall> picturesWithoutBall();

/// A picture of this size: a collage of 320 x 240 px parts of the rendered frames of the webcams that show no piece of the ball.
/// Handles and shafts of styluses are among them. The same for the same seed.
cv::Mat clutter(const cv::Size& size, unsigned seed);

/// The linear light (CV_32FC3, 0 to 1) of an encoded 8-bit picture.
cv::Mat toLight(const cv::Mat& encoded);

/// The pixels around the ball that drawing it with such a blur and motion may change.
cv::Rect areaOfBall(const CameraModel& camera, const RenderedBall& ball, double blurPx, const Eigen::Vector2d& motionPx);

/// Draws a ball with its own blur into the light of a part of a picture; what is behind is left as sharp as it is.
/// @param light linear light of `area` of the picture, changed
/// @param camera the lens of the whole picture
/// @param motionPx the way of the ball during the exposure, in the image; `ball` is where it is half-way
void drawBall(cv::Mat& light, const cv::Rect& area, const CameraModel& camera, const RenderedBall& ball, double blurPx,
  const Eigen::Vector2d& motionPx = { 0, 0 });

/// Paints what a mask (CV_8U, 255 is all) shows in one colour over a picture's light, with this blur along its rim.
void paint(cv::Mat& light, const cv::Mat& mask, const Light& color, double blurPx);

/// The picture as if everything had moved by this much (px) during the exposure, evenly and to either side.
cv::Mat smear(const cv::Mat& light, const Eigen::Vector2d& motionPx);

/// What JPEG of this quality (0 to 100) leaves.
cv::Mat throughJpeg(const cv::Mat& image, int quality);

}  // namespace handeye::test
