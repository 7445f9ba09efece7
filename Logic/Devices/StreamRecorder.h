// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "FramePairing.h"
#include "SequenceMetafileWriter.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <string>

namespace handeye::devices
{

/// Records what is captured, while it is captured, to sequence metafiles: images with the poses of their moments, and, in a second
/// file, every pose at its own time. Pixels go to the disk as they come; memory holds a few hundred bytes a frame.
///
/// What cannot be written is left out and counted, and the rest goes on: a tool whose name cannot be a field (blanks, '='), an
/// image of another size than the first. A disk that is full or gone ends the recording to that file and nothing else: add() then
/// returns false, error() says why, and close() makes a file of what came before, where there is room for it. The files are
/// complete or not there (see SequenceMetafileWriter).
///
/// Not safe to share between threads.
class StreamRecorder
{
public:
  /// @param video file for images and their poses; empty for none
  /// @param poses file for all poses; empty for none
  /// The video's file says which latency its frames have been paired with (PairedFrame::latencySec), and nobody applies it again.
  /// @throws io::FileError where a folder cannot be written to
  StreamRecorder(const std::filesystem::path& video, const std::filesystem::path& poses);
  ~StreamRecorder();

  /// @return false if its file has failed
  bool add(const PairedFrame& frame);
  /// A pose at its own time; poses of one time come together into one frame of the file.
  bool add(const DeviceSample& sample);

  /// Finishes the files, also after a failure. @return false where that, or recording, failed
  bool close();

  int frameCount() const { return frameCount_; }
  int poseCount() const { return poseCount_; }
  /// Frames that were left out, and tools, once each; why, in a sentence.
  int leftOutCount() const { return leftOutCount_; }
  const std::string& leftOutReason() const { return leftOutReason_; }
  bool hasFailed() const { return !error_.empty(); }
  /// A sentence.
  const std::string& error() const { return error_; }

private:
  /// One of the files.
  struct File
  {
    std::unique_ptr<io::SequenceMetafileWriter> writer;
    bool hasFailed = false;
  };

  template<typename Write> bool attempt(File& file, Write write);
  void fail(File& file, const std::string& error);
  void leaveOut(const std::string& reason);
  bool addTransform(io::SequenceFrame& fields, const std::string& name, const io::SequenceTransform& transform);
  void flushPoses();

  File video_, poses_;
  io::SequenceFrame pending_;  ///< the poses of one time
  int frameCount_ = 0, poseCount_ = 0, leftOutCount_ = 0;
  std::set<std::string> leftOutTools_;
  std::string error_, leftOutReason_;
};

/// The fields that a recording has of one pose: the matrix and "OK" or "INVALID".
io::SequenceTransform toSequenceTransform(const Eigen::Isometry3d& transform, bool isValid);

}  // namespace handeye::devices
