// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallDetector.h"

#include <opencv2/core.hpp>

#include <optional>

namespace handeye
{

/// Follows the ball through a video: looks first where the last frame (or the tracker) says it is, and in the whole image when it is
/// not there. The ball that it finds is as exact as
/// BallDetector's; a second ball outside of the window is not noticed.
///
/// Not thread-safe: one tracker, one video.
class BallTracker
{
public:
  explicit BallTracker(const BallDetector& detector)
    : detector_(detector)
  {
  }

  /// The ball in the next frame.
  /// @param prediction as for BallDetector::detect(); the window is then laid around it instead of around the last place
  [[nodiscard]] BallDetection next(const cv::Mat& image, const std::optional<BallPrediction>& prediction = {});

  /// Forgets the last place, for instance when the video was interrupted.
  void reset()
  {
    last_.reset();
    motion_Image_.setZero();
  }

  /// Where the last frame was searched: a window, or the whole image (px).
  const cv::Rect& searched() const { return searched_; }

private:
  /// The window in which the ball should be; nothing where that is not known.
  std::optional<cv::Rect> expect(const std::optional<BallPrediction>& prediction) const;
  /// Whether a ball lies in a window as a whole, unless the image itself ends there.
  static bool isInside(const BallDetection& found, const cv::Rect& window, const cv::Rect& whole);

  BallDetector detector_;
  std::optional<BallDetection> last_;
  Eigen::Vector2d motion_Image_ = Eigen::Vector2d::Zero();  ///< px, from the frame before the last one to the last one
  cv::Rect searched_;
};

}  // namespace handeye
