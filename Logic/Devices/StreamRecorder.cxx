// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StreamRecorder.h"

#include "NumberText.h"

#include <exception>
#include <stdexcept>
#include <utility>

namespace handeye::devices
{

io::SequenceTransform toSequenceTransform(const Eigen::Isometry3d& transform, bool isValid)
{
  return { transform.matrix(), isValid ? "OK" : "INVALID" };
}

StreamRecorder::StreamRecorder(const std::filesystem::path& video, const std::filesystem::path& poses)
{
  if (!video.empty())
  {
    video_.writer = std::make_unique<io::SequenceMetafileWriter>(video);
  }
  if (!poses.empty())
  {
    io::SequenceMetafileWriterOptions options;
    options.transformsOnly = true;
    poses_.writer = std::make_unique<io::SequenceMetafileWriter>(poses, options);
  }
}

StreamRecorder::~StreamRecorder() = default;

template<typename Write> bool StreamRecorder::attempt(File& file, Write write)
{
  if (!file.writer || file.hasFailed)
  {
    return !file.hasFailed;
  }
  try
  {
    write();
  }
  catch (const std::invalid_argument& error)
  {
    leaveOut(error.what());
  }
  catch (const std::exception& error)
  {
    fail(file, error.what());
  }
  return !file.hasFailed;
}

void StreamRecorder::fail(File& file, const std::string& error)
{
  file.hasFailed = true;
  error_ += (error_.empty() ? "" : "; ") + error;
}

void StreamRecorder::leaveOut(const std::string& reason)
{
  ++leftOutCount_;
  leftOutReason_ = leftOutReason_.empty() ? reason : leftOutReason_;
}

/// @return false where the tool's name cannot be a field, or is there already
bool StreamRecorder::addTransform(io::SequenceFrame& fields, const std::string& name, const io::SequenceTransform& transform)
{
  constexpr std::size_t MostNames = 1000;
  const std::string key = io::withoutTransformSuffix(name);
  const bool isTwice = key != name && leftOutTools_.count(name) == 0 && fields.transforms.count(key) > 0;
  if (key.empty() || key.find_first_of(" \t\r\n=") != std::string::npos || isTwice || leftOutTools_.count(name) > 0)
  {
    if (leftOutTools_.size() < MostNames && leftOutTools_.insert(name).second)
    {
      leaveOut("the tool " + io::inQuotes(name) + " cannot be recorded: its name has blanks or '=', or is there twice");
    }
    return false;
  }
  fields.transforms[key] = transform;
  return true;
}

bool StreamRecorder::add(const PairedFrame& frame)
{
  return attempt(video_,
    [&]
    {
      io::SequenceFrame fields;
      fields.timestampSec = frame.image.timeSec;
      fields.unfilteredTimestampSec = frame.image.timeSec;
      fields.frameNumber = frameCount_;
      for (const auto& [name, pose] : frame.poses)
      {
        if (addTransform(fields, name, toSequenceTransform(pose.transform, pose.isUsable())))
        {
          fields.fields[name + "PairingStatus"] = toString(pose.status);
        }
      }
      video_.writer->setField(io::AppliedLatencyField, io::formatDouble(frame.latencySec));
      video_.writer->append(fields, frame.image.frame()->image);
      ++frameCount_;
    });
}

bool StreamRecorder::add(const DeviceSample& sample)
{
  const TrackedPose* pose = sample.pose();
  return attempt(poses_,
    [&]
    {
      if (pose == nullptr)
      {
        return;
      }
      if (pending_.timestampSec && *pending_.timestampSec != sample.timeSec)
      {
        flushPoses();
      }
      pending_.timestampSec = pending_.unfilteredTimestampSec = sample.timeSec;
      poseCount_ += addTransform(pending_, sample.name, toSequenceTransform(pose->transform, pose->isValid)) ? 1 : 0;
    });
}

void StreamRecorder::flushPoses()
{
  if (pending_.timestampSec)
  {
    const io::SequenceFrame frame = std::exchange(pending_, {});
    poses_.writer->append(frame);
  }
}

bool StreamRecorder::close()
{
  attempt(poses_, [&] { flushPoses(); });
  for (File* file : { &video_, &poses_ })
  {
    try
    {
      if (file->writer)
      {
        file->writer->close();
      }
    }
    catch (const std::exception& error)
    {
      fail(*file, error.what());
    }
    file->writer.reset();
  }
  return !hasFailed();
}

}  // namespace handeye::devices
