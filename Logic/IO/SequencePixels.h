// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "SequenceHeader.h"

#include <cstdint>
#include <memory>

namespace handeye::io
{

/// The pixels of a sequence metafile, frame by frame. Keeps its place in the file, hence not for several threads at once.
class SequencePixels
{
public:
  virtual ~SequencePixels() = default;

  /// Reads header.frameBytes() bytes of a frame as they are stored. @throws FileError
  virtual void read(int frame, std::uint8_t* bytes) = 0;

  /// Opens the file for the way its pixels are stored. @throws FileError
  static std::unique_ptr<SequencePixels> open(const SequenceHeader& header);
};

}  // namespace handeye::io
