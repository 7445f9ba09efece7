// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallDetection.h"
#include "CommandOutput.h"
#include "Recording.h"

#include <CLI/CLI.hpp>

#include <string>

namespace handeye::cli
{

/// The options that say what the ball looks like and how it is found; the same in every command that looks for it.
class BallOptions
{
public:
  void addTo(CLI::App& command);

  /// The options for a recording; a colour that is to be learnt is learnt from it, and what was learnt is said.
  /// @throws CLI::ValidationError where the place to learn from makes no sense, io::FileError where the frame cannot be read
  [[nodiscard]] BallDetectionOptions forRecording(const io::Recording& recording, const CommandOutput& output) const;

private:
  BallDetectionOptions options_;
  std::string learnAt_;  ///< "X,Y" or "FRAME:X,Y"
};

}  // namespace handeye::cli
