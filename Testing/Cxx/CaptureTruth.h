// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "Recording.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace handeye::testing
{

/// What a rendered capture knows about itself (truth.json).
struct CaptureTruth
{
  struct Ball
  {
    Eigen::Vector3d ball_Camera;  ///< mm
    Eigen::Vector2d ball_Image;   ///< px
    double visibleShare = 1;      ///< of its outline
  };

  Eigen::Isometry3d markerToCamera = Eigen::Isometry3d::Identity();
  Eigen::Vector3d tip_Stylus = Eigen::Vector3d::Zero();
  double ballRadiusMm = 0;
  std::vector<std::optional<Ball>> calibration;  ///< one a frame; empty where no ball is in view
  std::vector<std::optional<Ball>> validation;
  std::optional<Eigen::Isometry3d> modelToPhantom;
};

CaptureTruth readTruth(const std::filesystem::path& capture);

/// The shift (px, without distortion) between two hand-eyes over the working volume: 5 depths between these, 9 x 7 pixels.
struct VolumeError
{
  double meanPx = 0;
  double maximumPx = 0;
};
VolumeError errorOverVolume(const CameraModel& camera, double nearestMm, double furthestMm, const Eigen::Isometry3d& markerToCamera,
  const Eigen::Isometry3d& trueMarkerToCamera);

/// What tracking noise alone leaves: the true rays of the calibration's frames, with the tracked points as they are.
VolumeError trackingFloor(const CaptureTruth& truth, const io::Recording& calibration, const CameraModel& camera);

/// The depths of the balls of the calibration's frames.
double nearestBallMm(const CaptureTruth& truth);
double furthestBallMm(const CaptureTruth& truth);

}  // namespace handeye::testing
