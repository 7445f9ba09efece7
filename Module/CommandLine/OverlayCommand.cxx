// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Commands.h"
#include "FileError.h"
#include "OverlayArguments.h"
#include "OverlayWriter.h"

#include <algorithm>
#include <filesystem>
#include <memory>

namespace handeye::cli
{

namespace
{

void makeFolder(const std::filesystem::path& folder)
{
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
  {
    throw io::FileError(folder, "the folder cannot be made: " + error.message());
  }
}

/// The mean and the largest delay of the smoothing, for the result.
void addDelay(const nlohmann::json& frames, nlohmann::json& result, const CommandOutput& output)
{
  double sumSec = 0, largestSec = 0;
  int count = 0;
  for (const nlohmann::json& frame : frames)
  {
    if (frame.contains("smoothingDelaySec"))
    {
      const double delaySec = frame.at("smoothingDelaySec").get<double>();
      sumSec += delaySec;
      largestSec = std::max(largestSec, delaySec);
      ++count;
    }
  }
  if (count > 0)
  {
    result["smoothingDelaySec"] = { { "mean", sumSec / count }, { "max", largestSec } };
    output.say(
      format("smoothing delays the model by %.0f ms in the mean, at most %.0f ms", 1000 * sumSec / count, 1000 * largestSec));
  }
}

int runOverlay(const OverlayArguments& arguments)
{
  static_cast<void>(overlayLookOf(arguments));
  const StoredCalibration stored = readCalibration(arguments.calibration);
  const io::Recording recording = io::Recording::open(arguments.recording);
  arguments.output.warn(recording.warnings());
  makeFolder(arguments.folder);
  OverlayWriter writer(arguments, stored, recording);
  nlohmann::json frames = nlohmann::json::array();
  const Progress progress = arguments.output.progress("drawing, frame");
  for (int frame = 0; frame < recording.frameCount(); ++frame)
  {
    frames.push_back(writer.draw(frame));
    if (progress)
    {
      progress(frame + 1, recording.frameCount());
    }
  }
  writer.close();
  const std::string message =
    "model drawn on " + std::to_string(writer.drawn()) + " of " + std::to_string(recording.frameCount()) + " frames";
  nlohmann::json result = { { "schema", "handeye-overlay/1" }, { "status", writer.drawn() > 0 ? "ok" : "nothing_drawn" },
    { "message", message }, { "frames", frames } };
  addDelay(frames, result, arguments.output);
  arguments.output.say(message + ", pictures in " + arguments.folder);
  return arguments.output.finish(result);
}

}  // namespace

void addOverlayCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<OverlayArguments>();
  CLI::App* command =
    app.add_subcommand("overlay", "Draw a model onto the video where the phantom is: one PNG a frame, lens distortion included");
  addOverlayOptions(*command, *arguments);
  command->callback([arguments, &exitCode] { exitCode = runOverlay(*arguments); });
}

}  // namespace handeye::cli
