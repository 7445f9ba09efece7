// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "TransformSample.h"

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace handeye::io
{

class SequencePixels;
struct SequenceHeader;

/// The field of a file whose poses have been taken at the images' times plus a latency: by how much, s.
constexpr const char* AppliedLatencyField = "AppliedLatencySec";

/// One transform of one frame as the file has it.
struct SequenceTransform
{
  std::optional<Eigen::Matrix4d> matrix;  ///< p_To = matrix * p_From, mm; may hold NaN, and need not be rigid
  std::string status;                     ///< the file's TransformStatus; empty where it does not say, which counts as "OK"
};

/// What the header of a sequence metafile says about one frame.
struct SequenceFrame
{
  std::map<std::string, SequenceTransform> transforms;  ///< by name without the trailing "Transform": "StylusToTracker"
  std::optional<double> timestampSec;
  std::optional<double> unfilteredTimestampSec;
  std::optional<long long> frameNumber;       ///< the device's own count
  std::optional<bool> isImageValid;           ///< ImageStatus = OK
  std::map<std::string, std::string> fields;  ///< every other field, without "Seq_Frame0000_"
};

/// Reader of sequence metafiles (.igs.mha, .mha) as PLUS and SlicerIGT write them.
///
/// A text header of `Key = Value` lines, the last of which is `ElementDataFile = LOCAL` (or the plain name of a file beside it),
/// then the pixels of all frames, as they are or as one zlib stream. DimSize is `W H N` or `W H 1 N`; `0 0 N` is transforms only.
/// Pixels are MET_UCHAR or MET_USHORT with 1, 3 or 4 channels.
///
/// The header is held in memory; pixels are read one frame at a time, so that a recording may be larger than the memory. Going
/// forward through a compressed file costs one inflation in all; going back starts it again from the beginning.
///
/// Frames that the header does not mention are frames without transforms; warnings() lists them.
///
/// Not safe to share between threads: image() keeps its place in the file.
/// Reference: https://plustoolkit.github.io, "Sequence metafile"; MetaIO, MetaImage.
class SequenceMetafile
{
public:
  /// Reads the header and checks that the announced pixels are there, as far as this can be done without reading them.
  /// @throws FileError naming the line or field
  [[nodiscard]] static SequenceMetafile open(const std::filesystem::path& path);

  SequenceMetafile(SequenceMetafile&&) noexcept;
  SequenceMetafile& operator=(SequenceMetafile&&) noexcept;
  ~SequenceMetafile();

  const std::filesystem::path& path() const;
  int frameCount() const;
  bool hasImages() const;
  int width() const;   ///< px; 0 without images
  int height() const;  ///< px; 0 without images

  /// The names that occur in any frame, sorted, without the trailing "Transform".
  const std::vector<std::string>& transformNames() const;

  /// What the header says of a frame; an empty one if it says nothing. std::out_of_range for a frame that there is not.
  const SequenceFrame& frame(int index) const;

  /// One transform, checked: see Recording::transform().
  [[nodiscard]] TransformSample transform(int index, const std::string& name) const;

  /// The image of a frame in rows from the top: CV_8U or CV_16U with 1, 3 or 4 channels. The file holds RGB and RGBA, the result is
  /// BGR and BGRA, OpenCV's order.
  ///
  /// UltrasoundImageOrientation tells how the rows are stored. MF and XX are taken as stored; MN is flipped top to bottom, UF left
  /// to right, UN both ways.
  /// @throws FileError where the pixels are damaged or the orientation is a transposed one (FM, NM, ...)
  cv::Mat image(int index) const;

  /// The fields of the file as a whole: "NDims", "Kinds", ...
  const std::map<std::string, std::string>& fields() const;
  const std::vector<std::string>& warnings() const;

private:
  SequenceMetafile();

  std::unique_ptr<SequenceHeader> header_;
  std::unique_ptr<SequencePixels> pixels_;  ///< null without images
};

/// "StylusToTracker" from "StylusToTrackerTransform" or from itself.
std::string withoutTransformSuffix(const std::string& name);

}  // namespace handeye::io
