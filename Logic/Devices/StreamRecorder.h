// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "FramePairing.h"
#include "SequenceMetafileWriter.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace handeye::devices
{

/// Records what is captured, while it is captured, to sequence metafiles: images with the poses of their moments, and, in a second
/// file, every pose at its own time. Pixels go to the disk as they come; memory holds a few hundred bytes a frame.
///
/// A disk that is full or gone ends the recording and nothing else: add() then returns false and error() says why. The files are
/// complete or not there (see SequenceMetafileWriter).
///
/// Not safe to share between threads.
class StreamRecorder
{
public:
  /// @param video file for images and their poses; empty for none
  /// @param poses file for all poses; empty for none
  /// @param appliedLatencySec that the frames have been paired with; the video's file says so, and nobody applies it again
  /// @throws io::FileError where a folder cannot be written to
  StreamRecorder(const std::filesystem::path& video, const std::filesystem::path& poses, double appliedLatencySec = 0);
  ~StreamRecorder();

  /// @return false if it could not be recorded, or recording has failed before
  bool add(const PairedFrame& frame);
  /// A pose at its own time; poses of one time come together into one frame of the file.
  bool add(const DeviceSample& sample);

  /// Finishes the files. @return false where that failed
  bool close();

  int frameCount() const { return frameCount_; }
  int poseCount() const { return poseCount_; }
  bool hasFailed() const { return !error_.empty(); }
  /// A sentence.
  const std::string& error() const { return error_; }

private:
  template<typename Write> bool attempt(Write write);
  void flushPoses();

  std::unique_ptr<io::SequenceMetafileWriter> video_, poses_;
  io::SequenceFrame pending_;  ///< the poses of one time
  int frameCount_ = 0, poseCount_ = 0;
  std::string error_;
};

/// The fields that a recording has of one pose: the matrix and "OK" or "INVALID".
io::SequenceTransform toSequenceTransform(const Eigen::Isometry3d& transform, bool isValid);

}  // namespace handeye::devices
