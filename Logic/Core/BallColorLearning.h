// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallColor.h"
#include "BallDetection.h"

#include <opencv2/core.hpp>

#include <string>

namespace handeye
{

struct BallColorLearningResult
{
  enum class Status
  {
    Ok,
    NoColor,       ///< what lies around the place is grey, white or black
    NoBall,        ///< what has the colour covers too much of the image to be a ball
    NotFoundThere  ///< with the colour no ball is found in the image, or one elsewhere
  };

  Status status = Status::NoColor;
  std::string message;  ///< for a person: what was learnt, or why nothing was
  BallColor color;      ///< meaningful where usable
  int pixels = 0;       ///< how many it was learnt from

  bool isUsable() const { return status == Status::Ok; }
};

/// Learns the ball's colour from one click on it.
///
/// The hue is the most frequent one around the place, weighted by chroma, so that a click on the highlight is as good as one beside
/// it. What is connected to the place and has that hue then gives how far hue, saturation and brightness vary over the ball.
/// @param image as for detectBall()
/// @param pixel somewhere on the ball
/// @throws std::invalid_argument for an image that detectBall() would refuse, or a place outside of it
/// Thread-safe.
[[nodiscard]] BallColorLearningResult learnBallColor(
  const cv::Mat& image, const cv::Point& pixel, BallColor::ChannelOrder order = BallColor::ChannelOrder::Bgr);

/// The same, and the ball is looked for with the colour in the same image: a click that missed it teaches nothing.
/// @param camera, ballRadiusMm as for detectBall(); so are the options, of which the colour is not used
/// @throws std::invalid_argument as learnBallColor() and detectBall()
/// Thread-safe.
[[nodiscard]] BallColorLearningResult learnBallColor(const cv::Mat& image, const cv::Point& pixel, const CameraModel& camera,
  double ballRadiusMm, const BallDetectionOptions& options = {});

}  // namespace handeye
