// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallOptions.h"

#include "BallColorLearning.h"
#include "CommonOptions.h"
#include "FileError.h"

#include <charconv>
#include <cmath>
#include <map>
#include <regex>
#include <stdexcept>

namespace handeye::cli
{

namespace
{

const std::map<std::string, double>& namedHues()
{
  static const std::map<std::string, double> hues = { { "red", 0 }, { "orange", 30 }, { "yellow", 60 }, { "green", 120 },
    { "cyan", 180 }, { "blue", 230 }, { "magenta", 300 } };
  return hues;
}

double hueOf(const std::string& word)
{
  const auto named = namedHues().find(word);
  if (named != namedHues().end())
  {
    return named->second;
  }
  double hueDeg = 0;
  if (!CLI::detail::lexical_cast(word, hueDeg) || !std::isfinite(hueDeg))
  {
    std::string words;
    for (const auto& hue : namedHues())
    {
      words += hue.first + ", ";
    }
    throw CLI::ValidationError("--ball-color", "'" + word + "' is not a hue: " + words + "or a number of degrees is expected");
  }
  return hueDeg;
}

int toInt(const std::ssub_match& digits)
{
  int value = 0;
  const std::string text = digits.str();
  if (std::from_chars(text.data(), text.data() + text.size(), value).ec != std::errc())
  {
    throw CLI::ValidationError("--ball-at", "'" + text + "' is too large");
  }
  return value;
}

}  // namespace

void BallOptions::addTo(CLI::App& command)
{
  addSegmentationOption(command, options_.method);
  CLI::Option* color = command
                         .add_option_function<std::string>(
                           "--ball-color", [this](const std::string& word) { options_.color.hueDeg = hueOf(word); },
                           "The ball's colour by name, or its hue in degrees (0 red, 120 green, 240 blue)")
                         ->type_name("COLOR")
                         ->default_str("red");
  command.add_option("--ball-at", learnAt_, "Learn the ball's colour from this pixel of a frame (the first one unless given)")
    ->type_name("[FRAME:]X,Y")
    ->excludes(color);
  command.add_option("--nearest-mm", options_.nearestMm, "Working range: a ball nearer than this is not the ball")->type_name("MM");
  command.add_option("--furthest-mm", options_.furthestMm, "Working range: a ball further away is not the ball")
    ->type_name("MM")
    ->default_str("");
}

BallDetectionOptions BallOptions::forRecording(const io::Recording& recording, const CommandOutput& output) const
{
  BallDetectionOptions options = options_;
  try
  {
    options.check();
  }
  catch (const std::invalid_argument& error)
  {
    throw CLI::ValidationError("--nearest-mm, --furthest-mm", error.what());
  }
  const bool asksForMore =
    !learnAt_.empty() || options.color.hueDeg != 0 || options.nearestMm > 0 || std::isfinite(options.furthestMm);
  if (options.method == BallDetectionOptions::Method::Hough && asksForMore)
  {
    throw CLI::ValidationError("--segmentation",
      "hough is the paper's pipeline: it looks for red and knows no working range; leave the other ball options out");
  }
  if (learnAt_.empty())
  {
    return options;
  }
  static const std::regex pattern("(?:([0-9]+):)?([0-9]+),([0-9]+)");
  std::smatch parts;
  if (!std::regex_match(learnAt_, parts, pattern))
  {
    throw CLI::ValidationError("--ball-at", "'" + learnAt_ + "' is not a place: X,Y or FRAME:X,Y in pixels is expected");
  }
  const int frame = parts[1].matched ? toInt(parts[1]) : 0;
  if (frame >= recording.frameCount() || !recording.hasImage(frame))
  {
    throw CLI::ValidationError("--ball-at", "the recording has no image in frame " + std::to_string(frame));
  }
  try
  {
    const BallColorLearningResult learnt = learnBallColor(recording.image(frame), { toInt(parts[2]), toInt(parts[3]) });
    if (!learnt.isUsable())
    {
      throw CLI::ValidationError("--ball-at", learnt.message);
    }
    output.say("ball's colour        " + learnt.message);
    options.color = learnt.color;
  }
  catch (const std::invalid_argument& error)
  {
    throw CLI::ValidationError("--ball-at", error.what());
  }
  return options;
}

}  // namespace handeye::cli
