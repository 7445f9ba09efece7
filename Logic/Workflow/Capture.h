// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallDetection.h"
#include "CameraModel.h"
#include "HandEyeCalibration.h"
#include "Recording.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace handeye
{

/// Told after each frame how many of how many are done; returns false to stop. Called in the caller's thread.
using Progress = std::function<bool(int done, int total)>;

/// The names under which a recording holds the tools' poses.
struct ToolNames
{
  std::string stylusToTracker = "StylusToTracker";
  std::string markerToTracker = "MarkerToTracker";
  /// The poses of an image are those at its time plus this; see calibrateLatency(). Not 0: they are interpolated between frames.
  double latencySec = 0;
};

/// What one frame of a capture gives: the ball in the image, and its place in the camera marker's frame.
struct CapturedFrame
{
  int frame = 0;
  /// "ok", or why the frame is no sample: a status of BallDetection, "stylus_invalid", "stylus_missing", "marker_invalid",
  /// "marker_missing", "image_missing"
  std::string status;
  std::string message;                        ///< for a person
  BallDetection ball;                         ///< meaningful where ball.isFound()
  std::optional<Eigen::Vector3d> tip_Marker;  ///< mm
  /// Rotation of p_Marker = stylusToMarker * p_Stylus where there is a tip; otherwise zero.
  Eigen::Matrix3d stylusToMarker = Eigen::Matrix3d::Zero();

  bool isSample() const { return status == "ok"; }
};

/// The camera with the recording's image size.
/// @throws io::FileError where the recording has no images, std::invalid_argument where they are not of the camera's size
CameraModel cameraForRecording(const CameraModel& camera, const io::Recording& recording);

/// Finds the ball in every frame, each for itself.
/// @throws io::FileError where the recording has no images; std::invalid_argument where they do not suit the camera
/// @return as many frames as there are, or fewer if `progress` stopped it
std::vector<CapturedFrame> detectBalls(const io::Recording& recording, const CameraModel& camera, double ballRadiusMm,
  const BallDetectionOptions& options = {}, const Progress& progress = {});

/// The same for a video: in each frame the ball is first looked for near its last place.
std::vector<CapturedFrame> followBall(const io::Recording& recording, const CameraModel& camera, double ballRadiusMm,
  const BallDetectionOptions& options = {}, const Progress& progress = {});

/// The same as detectBalls(), and where the tracker says the ball is:
/// tip_Marker = inverse(markerToTracker) * stylusToTracker * tip_Stylus.
/// @throws as detectBalls(), and io::FileError, listing the transforms that there are, where a tool is not in the recording
std::vector<CapturedFrame> readCapture(const io::Recording& recording, const ToolNames& tools, const CameraModel& camera,
  const Eigen::Vector3d& tip_Stylus, double ballRadiusMm, const BallDetectionOptions& options = {}, const Progress& progress = {});

/// The frames that are samples, as the solver takes them.
std::vector<HandEyeSample> toSamples(const std::vector<CapturedFrame>& frames, int eye = 0);

}  // namespace handeye
