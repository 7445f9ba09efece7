// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StreamRecorder.h"

#include "NumberText.h"

#include <exception>

namespace handeye::devices
{

io::SequenceTransform toSequenceTransform(const Eigen::Isometry3d& transform, bool isValid)
{
  return { transform.matrix(), isValid ? "OK" : "INVALID" };
}

StreamRecorder::StreamRecorder(const std::filesystem::path& video, const std::filesystem::path& poses, double appliedLatencySec)
{
  if (!video.empty())
  {
    io::SequenceMetafileWriterOptions options;
    options.fields[io::AppliedLatencyField] = io::formatDouble(appliedLatencySec);
    video_ = std::make_unique<io::SequenceMetafileWriter>(video, options);
  }
  if (!poses.empty())
  {
    io::SequenceMetafileWriterOptions options;
    options.transformsOnly = true;
    poses_ = std::make_unique<io::SequenceMetafileWriter>(poses, options);
  }
}

StreamRecorder::~StreamRecorder() = default;

template<typename Write> bool StreamRecorder::attempt(Write write)
{
  if (hasFailed())
  {
    return false;
  }
  try
  {
    write();
    return true;
  }
  catch (const std::exception& error)
  {
    error_ = error.what();
    video_.reset();
    poses_.reset();
    return false;
  }
}

bool StreamRecorder::add(const PairedFrame& frame)
{
  return attempt(
    [&]
    {
      if (!video_)
      {
        return;
      }
      io::SequenceFrame fields;
      fields.timestampSec = frame.image.timeSec;
      fields.unfilteredTimestampSec = frame.image.timeSec;
      fields.frameNumber = frameCount_;
      for (const auto& [name, pose] : frame.poses)
      {
        fields.transforms[name] = toSequenceTransform(pose.transform, pose.isUsable());
        fields.fields[name + "PairingStatus"] = toString(pose.status);
      }
      video_->append(fields, frame.image.frame()->image);
      ++frameCount_;
    });
}

bool StreamRecorder::add(const DeviceSample& sample)
{
  const TrackedPose* pose = sample.pose();
  return attempt(
    [&]
    {
      if (!poses_ || pose == nullptr)
      {
        return;
      }
      if (pending_.timestampSec && *pending_.timestampSec != sample.timeSec)
      {
        flushPoses();
      }
      pending_.timestampSec = pending_.unfilteredTimestampSec = sample.timeSec;
      pending_.transforms[sample.name] = toSequenceTransform(pose->transform, pose->isValid);
      ++poseCount_;
    });
}

void StreamRecorder::flushPoses()
{
  if (pending_.timestampSec)
  {
    poses_->append(pending_);
    pending_ = {};
  }
}

bool StreamRecorder::close()
{
  return attempt(
    [&]
    {
      if (poses_)
      {
        flushPoses();
        poses_->close();
      }
      if (video_)
      {
        video_->close();
      }
    });
}

}  // namespace handeye::devices
