// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardCapture.h"
#include "BoardDescription.h"
#include "CommandOutput.h"
#include "LensViewCollector.h"
#include "SourceOptions.h"

#include <optional>
#include <string>
#include <vector>

namespace handeye::cli
{

/// One eye's pictures of the board.
struct LensPictures
{
  std::vector<BoardFrame> frames;  ///< of a live video those that were taken, numbered as their stored pictures
  std::vector<LensView> views;
  std::optional<LensViewCollector> collector;  ///< none before the first picture
  int width = 0;
  int height = 0;
  std::string summary;  ///< "14 of 20 frames (not used: 6 moving)"
  std::string problem;  ///< of a live video that ended early: which source is missing, and why
};

/// Those of a recording.
/// @param all every picture that shows the board, not only those that are sharp and new
/// @param label of the eye, for messages
/// @throws io::FileError where there are no pictures, or not all of one size
LensPictures readLensPictures(const std::string& recording, const BoardDescription& board, const LensViewCollectorOptions& options,
  bool all, const std::string& label, const CommandOutput& output);

/// How a live video is looked at.
struct LiveLensOptions
{
  double seconds = 0;       ///< at most so much stream time; 0: no limit
  std::string storeFolder;  ///< gets the pictures of the views, frames/0000.png and so on: a RECORDING; empty: they are not stored
};

/// Those of a live video: hands-free, each view said as it is taken, with what to do next. Ends when the views are complete, when the
/// time is up, when a source is missing or none has pictures, or at Ctrl+C; what was taken until then is the result. Pictures that
/// come while the board is looked for in another one are left out.
/// @throws io::FileError where the folder for the pictures has some already, or cannot be made
LensPictures watchLensPictures(LiveSources& sources, const BoardDescription& board, const LensViewCollectorOptions& options,
  const LiveLensOptions& live, const CommandOutput& output);

}  // namespace handeye::cli
