// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SessionCapture.h"

#include "TimedPose.h"

namespace handeye
{

namespace
{

struct ToolPose
{
  std::string status;  ///< "ok", "stylus_missing", ...
  std::string message;
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
};

ToolPose poseOf(const io::SessionSample& sample, const std::string& name, const std::string& tool)
{
  const auto found = sample.transforms.find(name);
  if (found == sample.transforms.end() || !found->second.matrix)
  {
    return { tool + "_missing", "the sample has no " + name, {} };
  }
  const std::string& status = found->second.status;
  if (!status.empty() && status != "OK")
  {
    return { tool + "_invalid", name + " is not valid (" + status + ")", {} };
  }
  return { "ok", "", Eigen::Isometry3d(*found->second.matrix) };
}

}  // namespace

CapturedFrame evaluateSample(const io::SessionSample& sample, const cv::Mat& image, const ToolNames& tools,
  const BallDetector& detector, const Eigen::Vector3d& tip_Stylus)
{
  CapturedFrame captured;
  captured.frame = sample.id;
  captured.ball = detector.detect(image);
  captured.status = toString(captured.ball.status);
  captured.message = captured.ball.message;
  const ToolPose marker = poseOf(sample, tools.markerToTracker, "marker");
  const ToolPose stylus = poseOf(sample, tools.stylusToTracker, "stylus");
  for (const ToolPose& pose : { marker, stylus })
  {
    if (pose.status != "ok")
    {
      captured.status = pose.status;
      captured.message = pose.message;
      return captured;
    }
  }
  const Eigen::Vector3d tip_Tracker = stylus.transform * tip_Stylus;
  const Eigen::Isometry3d trackerToMarker = marker.transform.inverse();
  captured.tip_Marker = trackerToMarker * tip_Tracker;
  captured.stylusToMarker = trackerToMarker.linear() * stylus.transform.linear();
  return captured;
}

io::SessionSample sampleOfFrame(const io::Recording& recording, int frame, const ToolNames& tools)
{
  constexpr double usualFramesPerSec = 30;
  recording.requireTransform(tools.markerToTracker);
  recording.requireTransform(tools.stylusToTracker);
  io::SessionSample sample;
  sample.timeSec = recording.timestampSec(frame).value_or(frame / usualFramesPerSec);
  for (const std::string& name : { tools.markerToTracker, tools.stylusToTracker })
  {
    const io::TransformSample pose = poseOfFrame(recording, frame, name, tools.latencySec);
    if (pose.status != io::TransformSample::Status::Missing)
    {
      sample.transforms[name] = { pose.transform.matrix(), pose.isUsable() ? "OK" : "INVALID" };
    }
  }
  sample.pairing = { { "latencySec", tools.latencySec != 0 ? tools.latencySec : recording.appliedLatencySec() },
    { "recording", recording.path().string() }, { "frame", frame } };
  return sample;
}

}  // namespace handeye
