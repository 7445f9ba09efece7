// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "SequenceMetafile.h"
#include "TransformSample.h"

#include <opencv2/core.hpp>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace handeye::io
{

/// A recording of tracked tools, with or without the camera's images. It is one of
///
/// - one sequence metafile with pixels;
/// - a folder: `frames/0000.jpg` (or .jpeg, .png, .bmp, .tif, .tiff; one a frame, numbered from 0) beside `tracking.igs.mha`, a
///   sequence metafile whose frame i belongs to image i;
/// - one sequence metafile with transforms only.
///
/// Frames are numbered from 0. Where images and tracking differ in number, the frames that have both are used and a warning says
/// what was left out. Images are read when asked for, one at a time.
///
/// Not safe to share between threads: image() keeps its place in the file.
class Recording
{
public:
  /// @throws FileError where the recording cannot be read; for a folder it says which file was expected
  [[nodiscard]] static Recording open(const std::filesystem::path& path);

  /// For uses that need pictures only, such as lens calibration: `tracking.igs.mha` may be missing from a folder.
  /// @throws FileError as open(), and where there are no images
  [[nodiscard]] static Recording openImages(const std::filesystem::path& path);

  /// The file or folder that was opened.
  const std::filesystem::path& path() const { return path_; }

  int frameCount() const { return frameCount_; }
  bool hasImages() const;
  /// Whether this frame has an image; frames/ may have gaps.
  bool hasImage(int frame) const;

  /// Sorted, without the trailing "Transform": "StylusToTracker".
  const std::vector<std::string>& transformNames() const;

  /// One transform of one frame, mm.
  /// @param frame 0 to frameCount() - 1, otherwise std::out_of_range
  /// @param name "StylusToTracker" or "StylusToTrackerTransform"
  /// A matrix is a rigid motion if R^T R is the identity within 1e-3 entrywise, det R is positive and its last row is 0 0 0 1; it
  /// is then made orthonormal. Any other is Invalid.
  [[nodiscard]] TransformSample transform(int frame, const std::string& name) const;

  /// @throws FileError, listing the transforms that there are, where no frame has this one
  void requireTransform(const std::string& name) const;

  /// When the frame was recorded; empty where the file does not say.
  std::optional<double> timestampSec(int frame) const;

  /// The latency that the poses of the frames have been taken at already (the field AppliedLatencySec, which our recorder and
  /// session write); 0 where the file does not say.
  double appliedLatencySec() const { return appliedLatencySec_; }

  /// The image as recorded, in rows from the top: 8 or 16 bits; grey, BGR or BGRA (OpenCV's order).
  /// @throws FileError where it is missing or damaged; std::out_of_range for a frame that there is not
  cv::Mat image(int frame) const;

  /// Sentences for the user: gaps, differing counts, frames without tracking.
  const std::vector<std::string>& warnings() const { return warnings_; }

private:
  Recording() = default;
  static Recording openFolder(const std::filesystem::path& folder, bool needsTracking);
  void checkFrame(int frame) const;
  void readAppliedLatency();

  std::filesystem::path path_;
  int frameCount_ = 0;
  double appliedLatencySec_ = 0;
  std::optional<SequenceMetafile> metafile_;  ///< empty for a folder of pictures without tracking
  bool isFolder_ = false;
  std::map<int, std::filesystem::path> imageFiles_;  ///< by frame; of a folder
  std::vector<std::string> warnings_;
};

}  // namespace handeye::io
