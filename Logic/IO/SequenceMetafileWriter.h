// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "AtomicFile.h"
#include "SequenceMetafile.h"

#include <opencv2/core.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace handeye::io
{

struct SequenceMetafileWriterOptions
{
  bool compressed = false;      ///< one zlib stream over all pixels
  bool transformsOnly = false;  ///< images given to append() are an error

  /// Fields of the file as a whole, written after the ones of the format itself; these may not be given here.
  std::map<std::string, std::string> fields;
};

/// Writes a sequence metafile frame by frame; SequenceMetafile reads back the same numbers, bit for bit.
///
/// The format wants all frames' fields before the first pixel, so pixels wait in a temporary file beside the result. close() puts
/// both together in another temporary file and renames it: the result is either complete or not there, and an older file
/// of this name stays as it is until then. Without close(), nothing remains.
///
/// Images are written in orientation MF (rows from the top); BGR(A) in memory becomes RGB(A) in the file.
class SequenceMetafileWriter
{
public:
  /// @throws FileError where the folder cannot be written to; std::invalid_argument for a field that is the writer's own, or no
  /// field
  explicit SequenceMetafileWriter(const std::filesystem::path& path, const SequenceMetafileWriterOptions& options = {});
  ~SequenceMetafileWriter();
  SequenceMetafileWriter(const SequenceMetafileWriter&) = delete;
  SequenceMetafileWriter& operator=(const SequenceMetafileWriter&) = delete;

  /// A field of the file as a whole that is known only later, until close(). @throws std::invalid_argument as the constructor does
  void setField(const std::string& name, const std::string& value);

  /// Adds a frame.
  /// @param frame its fields; names must not hold blanks, '=' or line ends, values no line ends
  /// @param image 8 or 16 bits, 1, 3 or 4 channels, the same size and type in every frame. An empty one is written in black with
  ///   ImageStatus INVALID.
  /// @throws std::invalid_argument for other input: the frame is not taken, the next one can be. FileError where it cannot be
  /// written (disk full): no more frames are taken then, and close() still makes a file of those before
  void append(const SequenceFrame& frame, const cv::Mat& image = {});

  /// Finishes the file. @throws FileError where it cannot be written; nothing is left behind then
  void close();

private:
  struct Pixels;

  void write(const SequenceFrame& frame, const cv::Mat& image);
  void appendHeader(const SequenceFrame& frame, bool hasImage);
  std::string fileHeader() const;

  std::filesystem::path path_;
  SequenceMetafileWriterOptions options_;
  int frameCount_ = 0;
  std::unique_ptr<Pixels> pixels_;
  bool isClosed_ = false, hasFailed_ = false;
};

}  // namespace handeye::io
