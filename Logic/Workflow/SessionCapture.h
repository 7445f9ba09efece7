// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallDetector.h"
#include "Capture.h"
#include "Session.h"

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace handeye
{

/// One sample of a session as readCapture() gives it for a frame of a recording: the ball in its image, and the ball's place by the
/// tracker,
///
///     tip_Marker = inverse(markerToTracker) * stylusToTracker * tip_Stylus        mm
///
/// from the poses of the sample's own moment; the latency is in them already, and tools.latencySec is not looked at. A sample that
/// was excluded is evaluated like any other.
/// @param image as for detectBall()
/// @throws std::invalid_argument for an image that detectBall() would refuse
/// Thread-safe.
[[nodiscard]] CapturedFrame evaluateSample(const io::SessionSample& sample, const cv::Mat& image, const ToolNames& tools,
  const BallDetector& detector, const Eigen::Vector3d& tip_Stylus);

/// A frame of a recording as a session stores it: its poses, valid or not, and its time (the frame's number over 30 per second
/// where the recording has none).
/// @throws io::FileError, listing the transforms that there are, where a tool is not in the recording
[[nodiscard]] io::SessionSample sampleOfFrame(const io::Recording& recording, int frame, const ToolNames& tools);

}  // namespace handeye
