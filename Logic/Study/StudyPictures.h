// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallDetection.h"
#include "BoardDetection.h"
#include "StudyCamera.h"

#include <Eigen/Geometry>

#include <memory>

namespace handeye::study
{

/// Pictures of ball and board by one eye, and what our detectors find in them: the optics blur by 0.7 px, the sensor adds noise of
/// 1.5 steps of 8 bits. The ball is shaded by a lamp and has nothing behind it.
///
/// Thread-safe: nothing changes after construction, which takes about a second for a megapixel.
class StudyPictures
{
public:
  StudyPictures(const StudyCamera& camera, const StudyEye& eye);
  ~StudyPictures();

  [[nodiscard]] BallDetection findBall(
    const Eigen::Vector3d& ball_Camera, BallDetectionOptions::Method method, unsigned seed) const;
  [[nodiscard]] BoardDetection findBoard(const Eigen::Isometry3d& boardToCamera, unsigned seed) const;

private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

/// The noise of features as our detectors have it on rendered pictures: root mean square errors per axis against the truth.
struct FeatureNoise
{
  double ballSigmaPx = 0, cornerSigmaPx = 0;
  int balls = 0, ballsFound = 0;
  int boards = 0, boardsFound = 0, corners = 0;
};

/// Measures it at random places, as in the trials. Deterministic.
[[nodiscard]] FeatureNoise measureFeatureNoise(
  const StudyCamera& camera, const StudyEye& eye, const StudyPictures& pictures, int pictureCount, unsigned seed);

}  // namespace handeye::study
