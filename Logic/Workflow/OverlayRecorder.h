// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace handeye
{

/// What was known when a picture of an overlay was made: transforms by name ("ModelToCamera": p_Camera = transform * p_Model, mm);
/// nothing for one whose tool was not seen, which is kept as INVALID.
using OverlayTransformSet = std::map<std::string, std::optional<Eigen::Isometry3d>>;

struct OverlayRecorderOptions
{
  double framesPerSec = 30;  ///< of the video file; the times of the frames are in the metafile beside it

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// Writes the pictures of an overlay as a video, and their transforms as a sequence metafile (.igs.mha, transforms only) of the
/// same name beside it: frame i of the one belongs to frame i of the other.
///
/// The file's ending chooses the format: .mp4 (H.264 where OpenCV's FFmpeg can encode it, MPEG-4 otherwise), .ogv (Theora), .avi
/// (motion JPEG, which every OpenCV can). A picture with an odd width or height has its last column or row doubled, as these
/// formats hold even sizes only. Both files are written under other names and renamed by close(); without it, nothing remains.
///
/// Not safe to share between threads.
class OverlayRecorder
{
public:
  /// @throws io::FileError for another ending; std::invalid_argument where the options do not check
  explicit OverlayRecorder(const std::filesystem::path& video, const OverlayRecorderOptions& options = {});
  ~OverlayRecorder();
  OverlayRecorder(const OverlayRecorder&) = delete;
  OverlayRecorder& operator=(const OverlayRecorder&) = delete;

  /// @param bgr 8 bits, 3 channels, the same size in every frame
  /// @param timeSec of the frame, in the clock of the recording
  /// @throws std::invalid_argument for another picture, a time or a transform that is not finite (naming it), or after close();
  ///   io::FileError where the file cannot be written, or no encoder is there: the message says which formats are
  void append(const cv::Mat& bgr, double timeSec, const OverlayTransformSet& transforms);

  /// Finishes both files. @throws io::FileError where they cannot be written, or if there were no frames
  void close();

  int frameCount() const;

  /// What encodes the video: "H.264", "MPEG-4", "Theora", "motion JPEG"; empty before the first frame.
  std::string encoder() const;

  /// The metafile beside a video or a picture: the same name with .igs.mha.
  static std::filesystem::path metafileOf(const std::filesystem::path& file);

private:
  struct Writers;

  void open(const cv::Size& size);

  std::filesystem::path path_;
  OverlayRecorderOptions options_;
  std::unique_ptr<Writers> writers_;
  int frameCount_ = 0;
  bool isClosed_ = false;
};

/// One picture of an overlay as a PNG file, and its transforms in a sequence metafile beside it.
/// @throws io::FileError where they cannot be written; std::invalid_argument as OverlayRecorder::append()
void writeOverlaySnapshot(
  const std::filesystem::path& png, const cv::Mat& bgr, double timeSec, const OverlayTransformSet& transforms);

}  // namespace handeye
