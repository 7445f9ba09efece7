// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LensPictures.h"

#include "BoardPattern.h"
#include "FileError.h"
#include "ImageFile.h"
#include "Recording.h"
#include "StopSignal.h"

#include <filesystem>
#include <iostream>
#include <optional>

namespace handeye::cli
{

namespace
{

/// What keeps being wrong is said again after so long, s of stream time.
constexpr double SayAgainSec = 3;
/// So many samples are read at once before a picture is looked at.
constexpr int MostAtOnce = 500;

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

/// Looks at one picture of a live video after the other.
class Watcher
{
public:
  Watcher(const BoardDescription& board, const LensViewCollectorOptions& options, const LiveLensOptions& live,
    const CommandOutput& output)
    : board_(board)
    , options_(options)
    , live_(live)
    , output_(output)
  {
    if (!live.keepFolder.empty() && std::filesystem::exists(kept(0)))
    {
      throw io::FileError(live.keepFolder, "has pictures already: they are not replaced; name another folder");
    }
  }

  void add(const devices::DeviceSample& sample)
  {
    const cv::Mat& image = sample.frame()->image;
    if (!pictures_.collector)
    {
      pictures_.width = image.cols;
      pictures_.height = image.rows;
      pictures_.collector = std::make_unique<LensViewCollector>(image.cols, image.rows, options_);
    }
    if (image.cols != pictures_.width || image.rows != pictures_.height)
    {
      sayProblem("a picture of another size is left out: " + std::to_string(image.cols) + " x " + std::to_string(image.rows) +
          " px, the first had " + std::to_string(pictures_.width) + " x " + std::to_string(pictures_.height),
        sample.timeSec);
      return;
    }
    const int index = int(pictures_.frames.size());
    const BoardDetection detection = detectBoard(image, board_);
    const LensViewVerdict verdict = pictures_.collector->add(index, detection);
    pictures_.frames.push_back({ index,
      verdict.isTaken()        ? "ok"
        : detection.isUsable() ? toString(verdict.status)
                               : toString(detection.status),
      detection.isUsable() ? verdict.message : detection.message, {} });
    if (!verdict.isTaken())
    {
      sayProblem(pictures_.frames.back().message, sample.timeSec);
      return;
    }
    pictures_.frames.back().detection = detection;
    keep(image);
    const LensViewCollector& collector = *pictures_.collector;
    const auto count = collector.views().size();
    output_.say("view " + std::to_string(count) +
      format(" taken, %.0f %% of the image covered. ", 100 * collector.coverageShare()) +
      (collector.isComplete() ? "That is enough." : collector.hint()));
    std::cout << std::flush;
    lastProblem_.clear();
  }

  bool isComplete() const { return pictures_.collector && pictures_.collector->isComplete(); }

  LensPictures result()
  {
    if (pictures_.collector)
    {
      pictures_.views = pictures_.collector->views();
    }
    return std::move(pictures_);
  }

private:
  std::filesystem::path kept(std::size_t view) const
  {
    char name[32];
    std::snprintf(name, sizeof(name), "%04zu.png", view);
    return std::filesystem::path(live_.keepFolder) / "frames" / name;
  }

  /// A full disk does not cost the view.
  void keep(const cv::Mat& image) const
  {
    if (live_.keepFolder.empty())
    {
      return;
    }
    try
    {
      const std::filesystem::path file = kept(pictures_.collector->views().size() - 1);
      std::filesystem::create_directories(file.parent_path());
      io::writePng(file, image);
    }
    catch (const std::exception& error)
    {
      output_.warn({ "the picture of this view could not be stored: " + std::string(error.what()) });
    }
  }

  void sayProblem(const std::string& problem, double timeSec)
  {
    if (problem != lastProblem_ || timeSec > lastSec_ + SayAgainSec)
    {
      output_.warn({ problem });
      lastProblem_ = problem;
      lastSec_ = timeSec;
    }
  }

  const BoardDescription& board_;
  const LensViewCollectorOptions& options_;
  const LiveLensOptions& live_;
  const CommandOutput& output_;
  LensPictures pictures_;
  std::string lastProblem_;
  double lastSec_ = 0;
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
  pictures.collector = std::make_unique<LensViewCollector>(pictures.width, pictures.height, options);
  pictures.views = selectLensViews(pictures.frames, all ? nullptr : pictures.collector.get());
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
  sources.pairing.toolNames.clear();
  sources.start();
  catchStopSignals();
  devices::FramePairing pairing(sources.pairing);
  output.say("Show the board from all sides and in all corners; hold it still each time. Ctrl+C ends with what there is.");
  std::cout << std::flush;
  const auto isDone = [&]
  { return isStopAsked() || watcher.isComplete() || (live.seconds > 0 && sources.streamSec() > live.seconds); };
  while (!isDone() && sources.isAlive())
  {
    std::optional<devices::DeviceSample> newest;
    for (int count = 0; count < MostAtOnce; ++count)
    {
      std::optional<devices::DeviceSample> sample = sources.pop(newest ? 0 : 0.1);
      if (!sample)
      {
        break;
      }
      if (!sample->frame())
      {
        continue;
      }
      pairing.add(std::move(*sample));
      sources.warnOfOtherImages(pairing, output);
      while (std::optional<devices::PairedFrame> frame = pairing.takeRest())
      {
        newest = std::move(frame->image);
      }
    }
    if (newest)
    {
      watcher.add(*newest);
    }
  }
  const std::string missing = sources.missingAtEnd();
  sources.stop();
  if (!missing.empty())
  {
    output.warn({ missing });
  }
  return watcher.result();
}

}  // namespace handeye::cli
