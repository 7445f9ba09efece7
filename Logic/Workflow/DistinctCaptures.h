// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeCalibration.h"

#include <filesystem>
#include <string>
#include <vector>

namespace handeye
{

/// Sees to it that the captures of a comparison have nothing in common: a method that was fitted to what it is judged by looks better
/// than it is, and a capture that is there twice repeats itself perfectly. A session holds copies of a recording's frames, so that
/// paths alone do not tell.
class DistinctCaptures
{
public:
  /// Before anything is looked for in it.
  /// @param what of a sentence: "the validation set", "a capture"
  /// @throws io::FileError where it is, by its canonical path, one that was added before
  void addPath(const std::filesystem::path& path, const std::string& what);

  /// Samples of one that was added: none of them may be those of another. Two are the same where the tip (mm, marker) is and the ball
  /// is found within half a pixel, as two segmentations of one picture do.
  /// @throws io::FileError naming both
  void addSamples(const std::filesystem::path& path, const std::vector<HandEyeSample>& samples);

private:
  struct Capture
  {
    std::filesystem::path path, canonical;
    std::string what;
    std::vector<HandEyeSample> samples;
  };
  std::vector<Capture> captures_;
};

}  // namespace handeye
