// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardCapture.h"
#include "BoardDescription.h"
#include "CommandOutput.h"
#include "LensViewCollector.h"
#include "SourceOptions.h"

#include <memory>
#include <string>
#include <vector>

namespace handeye::cli
{

/// One eye's pictures of the board.
struct LensPictures
{
  std::vector<BoardFrame> frames;
  std::vector<LensView> views;
  std::unique_ptr<LensViewCollector> collector;  ///< null before the first picture
  int width = 0;
  int height = 0;
};

/// Those of a recording.
/// @param all every picture that shows the board, not only those that are sharp and new
/// @param label of the eye, for messages
/// @throws io::FileError where there are no pictures, or not all of one size
LensPictures readLensPictures(const std::string& recording, const BoardDescription& board, const LensViewCollectorOptions& options,
  bool all, const std::string& label, const CommandOutput& output);

/// How long a live video is looked at.
struct LiveLensOptions
{
  double seconds = 0;      ///< of stream time; 0: until there are views from everywhere
  std::string keepFolder;  ///< gets the pictures of the views, frames/0000.png and so on: a RECORDING; empty: they are not kept
};

/// Those of a live video: hands-free, each view said as it is taken, with what to do next. Ends when the views are complete, when the
/// time is up, when a source is missing, or at Ctrl+C; what was taken until then is the result. Pictures that come while the board is
/// looked for in another one are left out.
LensPictures watchLensPictures(LiveSources& sources, const BoardDescription& board, const LensViewCollectorOptions& options,
  const LiveLensOptions& live, const CommandOutput& output);

}  // namespace handeye::cli
