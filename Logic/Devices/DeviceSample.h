// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <variant>

namespace handeye::devices
{

/// The pose of a tool: p_To = transform * p_From for the name "<From>To<To>", mm.
struct TrackedPose
{
  bool isValid = false;
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();  ///< not meaningful unless isValid
  std::string reason;                                           ///< why it is not valid, a sentence
  Eigen::Matrix4d received = Eigen::Matrix4d::Identity();       ///< the numbers as they came; may be anything
};

/// A frame of a video: rows from the top, CV_8U or CV_16U with 1, 3 (BGR) or 4 (BGRA) channels.
struct VideoFrame
{
  cv::Mat image;
  /// Where an IMAGE message places the picture: p_Reference = imageToReference * (column, row, slice, 1), RAS, mm.
  Eigen::Matrix4d imageToReference = Eigen::Matrix4d::Identity();
};

/// A text, such as a STRING message.
struct DeviceText
{
  std::string text;
};

/// What a device says of itself (STATUS).
struct DeviceStatus
{
  int code = 0;  ///< 1 is OK
  std::int64_t subcode = 0;
  std::string error;
  std::string message;
};

/// Metadata of an image: the latency (s) with which the poses beside it were already brought to its moment.
constexpr const char* AppliedLatencyKey = "AppliedLatencySec";

/// Anything that a source delivers, with its times.
struct DeviceSample
{
  std::string name;        ///< "StylusToTracker", "Image_Reference", ...
  double timeSec = 0;      ///< by the clock of who measured it
  double receivedSec = 0;  ///< by this computer's clock, seconds since 1970
  std::map<std::string, std::string> metadata;
  std::variant<TrackedPose, VideoFrame, DeviceText, DeviceStatus> content;

  const TrackedPose* pose() const { return std::get_if<TrackedPose>(&content); }
  const VideoFrame* frame() const { return std::get_if<VideoFrame>(&content); }
  const DeviceText* text() const { return std::get_if<DeviceText>(&content); }
  const DeviceStatus* status() const { return std::get_if<DeviceStatus>(&content); }

  /// About how much memory it takes.
  std::size_t bytes() const;
};

/// Seconds since 1970.
double systemTimeSec();

}  // namespace handeye::devices
