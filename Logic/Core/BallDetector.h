// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallDetection.h"
#include "CameraModel.h"

#include <opencv2/core.hpp>

#include <memory>
#include <optional>

namespace handeye
{

class RayGrid;

/// Where the ball should be, by the tracker and an earlier calibration. Never needed: the first captures have none.
struct BallPrediction
{
  Eigen::Vector3d ball_Camera = { 0, 0, 0 };  ///< mm: markerToCamera * tip_Marker
  double sigmaPx = 10;                        ///< standard deviation of where it is seen, px

  /// @throws std::invalid_argument where a number makes no sense
  void check() const;
};

/// Finds the ball in images of one camera; detectBall() for many images, with what is known used to look faster and to believe less.
///
/// Frames: `Camera` and pixels as CameraModel has them. Thread-safe: detect() changes nothing.
class BallDetector
{
public:
  /// @throws std::invalid_argument for options that make no sense, or a radius (mm) that is not positive
  BallDetector(const CameraModel& camera, double ballRadiusMm, const BallDetectionOptions& options = {});

  /// Looks everywhere in the image.
  /// @param image as for detectBall()
  /// @param prediction if given, a ball further than 4 sigma from it, or at another distance, is not taken (Status::Elsewhere), and of several
  ///        balls the one inside the gate is the ball
  /// @throws std::invalid_argument as detectBall()
  [[nodiscard]] BallDetection detect(const cv::Mat& image, const std::optional<BallPrediction>& prediction = {}) const;

  /// Looks only in a part of the image (px; what lies outside of the image is cut off). The result is in px of the whole image.
  [[nodiscard]] BallDetection detectIn(
    const cv::Mat& image, const cv::Rect& window, const std::optional<BallPrediction>& prediction = {}) const;

  const CameraModel& camera() const { return camera_; }
  double ballRadiusMm() const { return ballRadiusMm_; }
  const BallDetectionOptions& options() const { return options_; }

private:
  BallDetection detectExact(const cv::Mat& image, const cv::Rect& window, const std::optional<BallPrediction>& prediction) const;
  BallDetection detectHough(const cv::Mat& image) const;

  CameraModel camera_;
  double ballRadiusMm_;
  BallDetectionOptions options_;
  std::shared_ptr<const RayGrid> grid_;  ///< if the camera says how large its images are
};

}  // namespace handeye
