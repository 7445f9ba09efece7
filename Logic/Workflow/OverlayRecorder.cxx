// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OverlayRecorder.h"

#include "FileError.h"
#include "ImageFile.h"
#include "SequenceMetafileWriter.h"

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include <cmath>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace handeye
{

namespace
{

struct Encoder
{
  std::string ending;
  std::string name;
  int fourcc;
  int backend;
};

const std::vector<Encoder>& encoders()
{
  static const std::vector<Encoder> all{
    { ".mp4", "H.264", cv::VideoWriter::fourcc('a', 'v', 'c', '1'), cv::CAP_FFMPEG },
    { ".mp4", "MPEG-4", cv::VideoWriter::fourcc('m', 'p', '4', 'v'), cv::CAP_FFMPEG },
    { ".ogv", "Theora", cv::VideoWriter::fourcc('t', 'h', 'e', 'o'), cv::CAP_FFMPEG },
    { ".avi", "motion JPEG", cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), cv::CAP_ANY },
  };
  return all;
}

bool isKnownEnding(const std::string& ending)
{
  for (const Encoder& encoder : encoders())
  {
    if (encoder.ending == ending)
    {
      return true;
    }
  }
  return false;
}

io::SequenceFrame sequenceFrame(double timeSec, const OverlayTransformSet& transforms)
{
  if (!std::isfinite(timeSec))
  {
    throw std::invalid_argument("the time of a picture is not a finite number");
  }
  io::SequenceFrame frame;
  frame.timestampSec = timeSec;
  for (const auto& [name, transform] : transforms)
  {
    if (transform && !transform->matrix().allFinite())
    {
      throw std::invalid_argument("the transform " + name + " holds numbers that are not finite");
    }
    io::SequenceTransform& kept = frame.transforms[name];
    kept.status = transform ? "OK" : "INVALID";
    // The format has numbers for a tool that was not seen, too (PLUS writes the identity); its status says that they mean nothing.
    kept.matrix = transform ? transform->matrix() : Eigen::Matrix4d(Eigen::Matrix4d::Identity());
  }
  return frame;
}

io::SequenceMetafileWriterOptions transformsOnly()
{
  io::SequenceMetafileWriterOptions options;
  options.transformsOnly = true;
  return options;
}

void checkPicture(const cv::Mat& bgr)
{
  if (bgr.empty() || bgr.type() != CV_8UC3)
  {
    throw std::invalid_argument("a picture of an overlay must have 8 bits and 3 channels");
  }
}

}  // namespace

void OverlayRecorderOptions::check() const
{
  if (!(std::isfinite(this->framesPerSec) && this->framesPerSec > 0))
  {
    throw std::invalid_argument("a video's frames per second must be more than 0");
  }
}

struct OverlayRecorder::Writers
{
  Writers(const std::filesystem::path& video, const std::filesystem::path& metafile)
    : partPath(video)
    , transforms(metafile, transformsOnly())
  {
    partPath.replace_extension(".part" + video.extension().string());
  }

  ~Writers()
  {
    frames.release();
    std::error_code ignored;
    std::filesystem::remove(partPath, ignored);
  }

  std::filesystem::path partPath;
  cv::VideoWriter frames;
  io::SequenceMetafileWriter transforms;
  cv::Size size;
  std::string encoder;
};

OverlayRecorder::OverlayRecorder(const std::filesystem::path& video, const OverlayRecorderOptions& options)
  : path_(video)
  , options_(options)
{
  options_.check();
  if (!isKnownEnding(video.extension().string()))
  {
    throw io::FileError(video, "the ending of a video must be .mp4, .ogv or .avi");
  }
}

OverlayRecorder::~OverlayRecorder() = default;

std::filesystem::path OverlayRecorder::metafileOf(const std::filesystem::path& file)
{
  std::filesystem::path metafile = file;
  return metafile.replace_extension(".igs.mha");
}

int OverlayRecorder::frameCount() const
{
  return frameCount_;
}

std::string OverlayRecorder::encoder() const
{
  return writers_ ? writers_->encoder : std::string();
}

void OverlayRecorder::open(const cv::Size& size)
{
  auto writers = std::make_unique<Writers>(path_, metafileOf(path_));
  writers->size = size;
  const cv::Size even(size.width + size.width % 2, size.height + size.height % 2);
  std::string tried;
  for (const Encoder& encoder : encoders())
  {
    if (encoder.ending != path_.extension().string())
    {
      continue;
    }
    if (writers->frames.open(writers->partPath.string(), encoder.backend, encoder.fourcc, options_.framesPerSec, even))
    {
      writers->encoder = encoder.name;
      writers_ = std::move(writers);
      return;
    }
    tried += (tried.empty() ? "" : " nor ") + encoder.name;
  }
  throw io::FileError(path_,
    "the video cannot be begun: the folder cannot be written to, or this OpenCV encodes neither " + tried +
      "; an .avi (motion JPEG) needs no encoder besides OpenCV");
}

void OverlayRecorder::append(const cv::Mat& bgr, double timeSec, const OverlayTransformSet& transforms)
{
  checkPicture(bgr);
  if (isClosed_)
  {
    throw std::invalid_argument("the video is finished, no more pictures can be added");
  }
  const io::SequenceFrame frame = sequenceFrame(timeSec, transforms);
  if (!writers_)
  {
    open(bgr.size());
  }
  if (bgr.size() != writers_->size)
  {
    throw std::invalid_argument("picture " + std::to_string(frameCount_) + " of the video has another size than the ones before");
  }
  cv::Mat even = bgr;
  if (bgr.cols % 2 != 0 || bgr.rows % 2 != 0)
  {
    cv::copyMakeBorder(bgr, even, 0, bgr.rows % 2, 0, bgr.cols % 2, cv::BORDER_REPLICATE);
  }
  writers_->transforms.append(frame);
  writers_->frames.write(even);
  ++frameCount_;
}

void OverlayRecorder::close()
{
  if (isClosed_)
  {
    return;
  }
  if (!writers_)
  {
    throw io::FileError(path_, "there were no pictures, so there is no video");
  }
  isClosed_ = true;
  writers_->frames.release();
  std::error_code error;
  if (!std::filesystem::exists(writers_->partPath) || std::filesystem::file_size(writers_->partPath, error) == 0 || error)
  {
    throw io::FileError(path_, "the video could not be written");
  }
  writers_->transforms.close();
  std::filesystem::rename(writers_->partPath, path_, error);
  if (error)
  {
    throw io::FileError(path_, "the video could not be given its name: " + error.message());
  }
}

void writeOverlaySnapshot(
  const std::filesystem::path& png, const cv::Mat& bgr, double timeSec, const OverlayTransformSet& transforms)
{
  checkPicture(bgr);
  const io::SequenceFrame frame = sequenceFrame(timeSec, transforms);
  io::writePng(png, bgr);
  io::SequenceMetafileWriter writer(OverlayRecorder::metafileOf(png), transformsOnly());
  writer.append(frame);
  writer.close();
}

}  // namespace handeye
