// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Recording.h"

#include "FileError.h"
#include "ImageFile.h"
#include "NumberText.h"
#include "RecordingFolder.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace handeye::io
{

namespace
{

constexpr const char* TrackingName = "tracking.igs.mha";

const std::vector<std::string> NoNames;

std::string listOf(const std::vector<std::string>& names)
{
  std::string text;
  for (const std::string& name : names)
  {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

}  // namespace

Recording Recording::open(const std::filesystem::path& path)
{
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
  {
    return openFolder(path, true);
  }
  Recording recording;
  recording.path_ = path;
  recording.metafile_ = SequenceMetafile::open(path);
  recording.readAppliedLatency();
  recording.frameCount_ = recording.metafile_->frameCount();
  recording.warnings_ = recording.metafile_->warnings();
  const std::filesystem::path folder = std::filesystem::absolute(path, error).parent_path();
  if (!recording.hasImages() && path.filename() == TrackingName && std::filesystem::is_directory(folder / "frames", error))
  {
    recording.warnings_.push_back("the images beside it are not used; open the folder '" + folder.string() + "' to have them");
  }
  return recording;
}

Recording Recording::openImages(const std::filesystem::path& path)
{
  std::error_code error;
  Recording recording = std::filesystem::is_directory(path, error) ? openFolder(path, false) : open(path);
  if (!recording.hasImages())
  {
    throw FileError(path, "has transforms only; a recording with images was expected");
  }
  return recording;
}

Recording Recording::openFolder(const std::filesystem::path& folder, bool needsTracking)
{
  Recording recording;
  recording.path_ = folder;
  recording.isFolder_ = true;
  const std::filesystem::path trackingPath = folder / TrackingName;
  std::error_code error;
  const bool hasTracking = std::filesystem::exists(trackingPath, error);
  if (!hasTracking && needsTracking)
  {
    throw FileError(folder, "a recording's folder has '" + trackingPath.string() + "', which is not there");
  }
  FrameImages images = listFrameImages(folder / "frames");
  recording.warnings_ = images.warnings;
  recording.imageFiles_ = std::move(images.files);
  recording.frameCount_ = recording.imageFiles_.rbegin()->first + 1;
  if (!hasTracking)
  {
    return recording;
  }

  recording.metafile_ = SequenceMetafile::open(trackingPath);
  recording.readAppliedLatency();
  const std::vector<std::string>& warnings = recording.metafile_->warnings();
  recording.warnings_.insert(recording.warnings_.end(), warnings.begin(), warnings.end());
  const int trackedCount = recording.metafile_->frameCount();
  if (trackedCount != recording.frameCount_)
  {
    const bool isMoreImages = recording.frameCount_ > trackedCount;
    recording.warnings_.push_back("images are numbered up to " + std::to_string(recording.frameCount_ - 1) + ", tracking up to " +
      std::to_string(trackedCount - 1) + "; the " + (isMoreImages ? "images" : "tracking frames") + " after " +
      std::to_string(std::min(recording.frameCount_, trackedCount) - 1) + " are not used");
    recording.frameCount_ = std::min(recording.frameCount_, trackedCount);
  }
  return recording;
}

void Recording::readAppliedLatency()
{
  const auto field = metafile_->fields().find(AppliedLatencyField);
  if (field == metafile_->fields().end())
  {
    return;
  }
  const std::optional<double> seconds = parseDouble(field->second);
  if (!seconds || !(std::abs(*seconds) <= 10))
  {
    throw FileError(metafile_->path(),
      std::string("'") + AppliedLatencyField + "' is " + inQuotes(field->second) + "; a time of at most 10 s was expected");
  }
  appliedLatencySec_ = *seconds;
}

bool Recording::hasImages() const
{
  return isFolder_ || metafile_->hasImages();
}

void Recording::checkFrame(int frame) const
{
  if (frame < 0 || frame >= frameCount_)
  {
    throw std::out_of_range("frame " + std::to_string(frame) + " of " + std::to_string(frameCount_));
  }
}

bool Recording::hasImage(int frame) const
{
  checkFrame(frame);
  if (isFolder_)
  {
    return imageFiles_.count(frame) > 0;
  }
  return metafile_->hasImages() && metafile_->frame(frame).isImageValid.value_or(true);
}

const std::vector<std::string>& Recording::transformNames() const
{
  return metafile_ ? metafile_->transformNames() : NoNames;
}

TransformSample Recording::transform(int frame, const std::string& name) const
{
  checkFrame(frame);
  if (!metafile_)
  {
    TransformSample sample;
    sample.reason = "the recording has images only";
    return sample;
  }
  return metafile_->transform(frame, name);
}

void Recording::requireTransform(const std::string& name) const
{
  const std::string wanted = withoutTransformSuffix(name);
  const std::vector<std::string>& names = transformNames();
  if (std::find(names.begin(), names.end(), wanted) == names.end())
  {
    throw FileError(metafile_ ? metafile_->path() : path_,
      "no frame has the transform '" + wanted + "'; " +
        (names.empty() ? "there are no transforms at all" : "there are: " + listOf(names)));
  }
}

std::optional<double> Recording::timestampSec(int frame) const
{
  checkFrame(frame);
  return metafile_ ? metafile_->frame(frame).timestampSec : std::nullopt;
}

cv::Mat Recording::image(int frame) const
{
  checkFrame(frame);
  if (!isFolder_)
  {
    if (metafile_->hasImages() && !hasImage(frame))
    {
      throw FileError(path_, "the image of frame " + std::to_string(frame) + " is marked as not valid (ImageStatus)");
    }
    return metafile_->image(frame);
  }
  if (!hasImage(frame))
  {
    throw FileError(path_ / "frames", "the image of frame " + std::to_string(frame) + " is missing");
  }
  return readImage(imageFiles_.at(frame));
}

}  // namespace handeye::io
