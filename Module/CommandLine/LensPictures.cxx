// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LensPictures.h"

#include "FileError.h"
#include "ImageFile.h"
#include "LensCollection.h"
#include "PacedMessages.h"
#include "Recording.h"
#include "StopSignal.h"

#include <cstdio>
#include <filesystem>
#include <iostream>

namespace handeye::cli
{

namespace
{

void readSize(const io::Recording& recording, LensPictures& pictures)
{
  for (int frame = 0; frame < recording.frameCount(); ++frame)
  {
    if (!recording.hasImage(frame))
    {
      continue;
    }
    const cv::Mat image = recording.image(frame);
    if (pictures.width != 0 && (image.cols != pictures.width || image.rows != pictures.height))
    {
      throw io::FileError(recording.path(),
        "image " + std::to_string(frame) + " has " + std::to_string(image.cols) + " x " + std::to_string(image.rows) +
          " pixels, those before it " + std::to_string(pictures.width) + " x " + std::to_string(pictures.height));
    }
    pictures.width = image.cols;
    pictures.height = image.rows;
  }
}

std::string summaryOf(std::size_t used, std::size_t all, const std::string& notUsed)
{
  return std::to_string(used) + " of " + std::to_string(all) + " frames" + (notUsed.empty() ? "" : " (not used: " + notUsed + ")");
}

/// Where the pictures of the views are stored.
class PictureFolder
{
public:
  explicit PictureFolder(const std::string& folder)
    : folder_(folder)
  {
    if (folder.empty())
    {
      return;
    }
    const std::filesystem::path frames = folder_ / "frames";
    std::error_code error;
    std::filesystem::create_directories(frames, error);
    if (error)
    {
      throw io::FileError(folder, "cannot be made: " + error.message());
    }
    if (!std::filesystem::is_empty(frames))
    {
      throw io::FileError(folder, "has pictures already: they are not replaced; name another folder");
    }
  }

  void add(std::size_t view, const cv::Mat& image) const
  {
    if (!folder_.empty())
    {
      char name[32];
      std::snprintf(name, sizeof(name), "%04zu.png", view);
      io::writePng(folder_ / "frames" / name, image);
    }
  }

private:
  std::filesystem::path folder_;
};

/// Looks at one picture of a live video after the other.
class Watcher
{
public:
  Watcher(const BoardDescription& board, const LensViewCollectorOptions& options, const LiveLensOptions& live,
    const CommandOutput& output)
    : pictures_(board, options)
    , folder_(live.storeFolder)
    , output_(output)
    , hints_([&output](const std::string& message) { output.say(message); })
  {
  }

  void add(const devices::DeviceSample& sample)
  {
    const cv::Mat& image = sample.frame()->image;
    try
    {
      const LensCollection::Look look = pictures_.add(image);
      if (look.isTaken)
      {
        sayTaken();
        folder_.add(pictures_.detections().size() - 1, image);
      }
      else
      {
        hints_.add(look.message, sample.timeSec);
      }
    }
    catch (const std::exception& error)  // a picture of another size; a full disk, which does not cost the view
    {
      hints_.add(error.what(), sample.timeSec);
    }
    std::cout << std::flush;
  }

  bool hasPictures() const { return pictures_.collector() != nullptr; }
  bool isComplete() const { return hasPictures() && pictures_.collector()->isComplete(); }

  LensPictures result() const
  {
    LensPictures result;
    result.views = pictures_.views();
    result.width = pictures_.width();
    result.height = pictures_.height();
    if (hasPictures())
    {
      result.collector = *pictures_.collector();
    }
    for (std::size_t i = 0; i < pictures_.detections().size(); ++i)
    {
      result.frames.push_back({ int(i), "ok", {}, pictures_.detections()[i] });
    }
    std::string notTaken;
    for (const auto& [reason, count] : pictures_.notTaken())
    {
      notTaken += (notTaken.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
    }
    result.summary = summaryOf(result.views.size(), std::size_t(pictures_.pictureCount()), notTaken);
    return result;
  }

private:
  void sayTaken() const
  {
    const LensViewCollector& collector = *pictures_.collector();
    output_.say("view " + std::to_string(collector.views().size()) +
      format(" taken, %.0f %% of the image covered. ", 100 * collector.coverageShare()) +
      (collector.isComplete() ? "That is enough." : collector.hint()));
  }

  LensCollection pictures_;
  PictureFolder folder_;
  const CommandOutput& output_;
  PacedMessages hints_;
};

}  // namespace

LensPictures readLensPictures(const std::string& path, const BoardDescription& board, const LensViewCollectorOptions& options,
  bool all, const std::string& label, const CommandOutput& output)
{
  const io::Recording recording = io::Recording::openImages(path);
  output.warn(recording.warnings());
  LensPictures pictures;
  readSize(recording, pictures);
  pictures.frames = readBoardFrames(recording, board, {}, output.progress("looking for the board" + label + ", frame"));
  if (pictures.width == 0)
  {
    throw io::FileError(path, "the recording has no images, which this step needs");
  }
  pictures.collector.emplace(pictures.width, pictures.height, options);
  pictures.views = selectLensViews(pictures.frames, all ? nullptr : &*pictures.collector);
  pictures.summary = summaryOf(pictures.views.size(), pictures.frames.size(), countStatuses(pictures.frames));
  if (all)
  {
    for (const BoardFrame& frame : pictures.frames)  // for the coverage map
    {
      pictures.collector->add(frame.frame, frame.detection);
    }
  }
  return pictures;
}

LensPictures watchLensPictures(LiveSources& sources, const BoardDescription& board, const LensViewCollectorOptions& options,
  const LiveLensOptions& live, const CommandOutput& output)
{
  Watcher watcher(board, options, live, output);
  sources.start();
  catchStopSignals();
  devices::FramePairing pairing(sources.pairing);
  output.say("Show the board from all sides and in all corners; hold it still each time. Ctrl+C ends with what there is.");
  std::cout << std::flush;
  const double startSec = devices::systemTimeSec();
  const auto isWithoutPictures = [&] { return !watcher.hasPictures() && devices::systemTimeSec() > startSec + sources.waitSec(); };
  const auto isDone = [&]
  {
    return isStopAsked() || watcher.isComplete() || isWithoutPictures() || !sources.isAlive() ||
      (live.seconds > 0 && sources.streamSec() > live.seconds);
  };
  while (!isDone())
  {
    // The newest picture of all that have come.
    std::optional<devices::PairedFrame> newest;
    std::optional<devices::DeviceSample> sample;
    while (!isDone() && (sample = sources.pop(newest ? 0 : 0.1)))
    {
      pairing.add(std::move(*sample));
      while (std::optional<devices::PairedFrame> frame = pairing.takeRest())
      {
        newest = std::move(frame);
      }
    }
    sources.warnOfOtherImages(pairing, output);
    if (newest)
    {
      watcher.add(newest->image);
    }
  }
  LensPictures result = watcher.result();
  result.problem = sources.missingAtEnd();
  if (result.problem.empty() && !watcher.hasPictures())
  {
    result.problem = "no picture came" +
      (sources.pairing.imageName.empty() ? std::string() : " of '" + sources.pairing.imageName + "'") + ". " + sources.message();
  }
  sources.stop();
  return result;
}

}  // namespace handeye::cli
