// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CommonOptions.h"
#include "OverlayArguments.h"

#include <cmath>
#include <map>

namespace handeye::cli
{

namespace
{

using Layout = vtkHandEyeStereoOverlay::Layout;

std::string checkColor(const std::string& text)
{
  const bool good = text.size() == 6 && text.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
  return good ? std::string() : "'" + text + "' is not a colour, six hexadecimal digits such as 30b0ff are expected";
}

std::string checkShare(const std::string& text)
{
  double share = -1;
  const bool good = CLI::detail::lexical_cast(text, share) && share >= 0 && share <= 1;
  return good ? std::string() : "'" + text + "' is not an opacity or share, a number from 0 to 1 is expected";
}

std::string checkPositive(const std::string& text)
{
  double number = 0;
  const bool good = CLI::detail::lexical_cast(text, number) && number > 0 && std::isfinite(number);
  return good ? std::string() : "'" + text + "' is not a positive number";
}

std::string lookWords()
{
  std::string words;
  for (const OverlayKey& key : overlayKeys())
  {
    // The lens has its own option.
    if (!key.name.empty() && key.name != "undistorted")
    {
      words += (words.empty() ? "" : ", ") + key.name;
    }
  }
  return words;
}

std::string checkLook(const std::string& word)
{
  OverlayLook look;
  const bool good = word != "undistorted" && findOverlaySwitch(look, word);
  return good ? std::string() : "'" + word + "' is not a look, one of " + lookWords() + " is expected";
}

const std::map<std::string, Layout>& layouts()
{
  static const std::map<std::string, Layout> all{ { "side-by-side", Layout::SideBySide }, { "top-bottom", Layout::TopBottom },
    { "interlaced", Layout::Interlaced }, { "anaglyph", Layout::Anaglyph } };
  return all;
}

CLI::Validator validator(std::string (*check)(const std::string&))
{
  return CLI::Validator([check](std::string& text) { return check(text); }, std::string());
}

void addLookOptions(CLI::App& command, OverlayArguments& arguments)
{
  command.add_option("--color", arguments.color, "Colour of the model, red green blue; ivory if not given")
    ->check(validator(checkColor))
    ->type_name("RRGGBB");
  command.add_option("--opacity", arguments.opacity, "Opacity of the model, 0 to 1; 0.65 if not given")
    ->check(validator(checkShare))
    ->type_name("SHARE");
  command.add_flag("--mask", arguments.mask, "White where the model is, black elsewhere");
  command
    .add_option("--lens", arguments.lens,
      "The video as recorded and the model bent as the lens bends light, or both straightened (with the focal lengths, the "
      "principal point and the size of the camera)")
    ->check(CLI::IsMember({ "raw", "undistorted" }))
    ->type_name("raw|undistorted")
    ->default_str("raw");
  command.add_option("--look", arguments.lookNames, "Looks to switch on, separated by commas: " + lookWords())
    ->delimiter(',')
    ->check(validator(checkLook))
    ->type_name("NAME,...");
  command.add_option("--without", arguments.withoutNames, "Looks to switch off; surface, stylus and occlusion are on without it")
    ->delimiter(',')
    ->check(validator(checkLook))
    ->type_name("NAME,...");
  command.add_option("--outline-width", arguments.look.outlineWidthPx, "Width of the outline, px of the video")
    ->check(validator(checkPositive))
    ->type_name("PX")
    ->capture_default_str();
  command
    .add_option(
      "--clipping-depth", arguments.look.clippingDepth, "Clipping plane between the model's nearest (0) and furthest (1) depth")
    ->check(validator(checkShare))
    ->type_name("SHARE")
    ->capture_default_str();
  command
    .add_option("--keyhole", arguments.keyhole,
      "The keyhole's centre (shares of width and height from the upper left) and radius (share of the height); switches it on")
    ->expected(3)
    ->delimiter(',')
    ->type_name("X,Y,RADIUS");
}

void addStylusOptions(CLI::App& command, OverlayArguments& arguments)
{
  command
    .add_option("--stylus", arguments.stylus,
      "Show the stylus' tip, and its ray where `handeye spin` has added the shaft; the model gives way where it is in front")
    ->type_name("stylus.json");
  addTransformOption(command, "--stylus-transform", arguments.stylusTransform, "stylus");
  command.add_option("--shaft-radius", arguments.shaftRadiusMm, "Radius of the stylus' shaft, mm")
    ->check(validator(checkPositive))
    ->type_name("MM")
    ->capture_default_str();
  command.add_option("--shaft-length", arguments.shaftLengthMm, "Length of the stylus' shaft, mm")
    ->check(validator(checkPositive))
    ->type_name("MM")
    ->capture_default_str();
  command.add_option("--ray-length", arguments.rayLengthMm, "Length of the ray from the tip, mm")
    ->check(validator(checkPositive))
    ->type_name("MM")
    ->capture_default_str();
}

void addOutputOptions(CLI::App& command, OverlayArguments& arguments)
{
  command.add_flag("--fade", arguments.fade,
    "While a tool is hidden, the model fades where it was last and a sentence in the picture says so; without it, the model is "
    "left "
    "out at once");
  command.add_flag("--smooth", arguments.smooth, "Take the tracker's jitter out of the model's pose; the delay is reported");
  CLI::Option* right =
    command.add_option("--right", arguments.right, "The right eye's images, with the same tracking")->type_name("RECORDING");
  command.add_option("--right-camera", arguments.rightCamera, "The right eye's lens, if not that of the calibration")
    ->type_name("CAMERA")
    ->needs(right);
  std::vector<std::string> words;
  for (const auto& layout : layouts())
  {
    words.push_back(layout.first);
  }
  command.add_option("--stereo", arguments.stereo, "How both eyes share a picture")
    ->check(CLI::IsMember(words))
    ->type_name("side-by-side|top-bottom|interlaced|anaglyph")
    ->default_str("side-by-side")
    ->needs(right);
  command.add_flag("--swap-eyes", arguments.swapped, "The left eye's picture where the right one's would be")->needs(right);
  command
    .add_option("--video", arguments.video, "Also a video, .mp4, .ogv or .avi; the transforms are written beside it (.igs.mha)")
    ->type_name("FILE");
  command.add_option("--frame-rate", arguments.framesPerSec, "Frames per second of the video")
    ->check(validator(checkPositive))
    ->type_name("HZ")
    ->capture_default_str();
}

}  // namespace

void addOverlayOptions(CLI::App& command, OverlayArguments& arguments)
{
  addRecordingArgument(command, arguments.recording, "Images, and the poses of the camera's marker and the phantom");
  addCalibrationOption(command, arguments.calibration);
  command.add_option("--model", arguments.model, "Surface mesh: STL, PLY, OBJ, VTP or legacy VTK, mm")
    ->required()
    ->type_name("MESH");
  command.add_option("--registration", arguments.registration, "What `handeye landmarks` wrote")
    ->required()
    ->type_name("phantom.json");
  addTransformOption(command, "--phantom-transform", arguments.phantomTransform, "phantom's marker");
  addTransformOption(command, "--marker-transform", arguments.markerTransform, "camera's marker");
  addLatencyOption(command, arguments.latencySec);
  addLookOptions(command, arguments);
  addStylusOptions(command, arguments);
  addOutputOptions(command, arguments);
  command.add_option("-o,--output", arguments.folder, "Folder for the pictures, 0000.png and so on, and their transforms.igs.mha")
    ->required()
    ->type_name("DIR");
  arguments.output.addTo(command, false);
}

OverlayLook overlayLookOf(const OverlayArguments& arguments)
{
  OverlayLook look = arguments.look;
  look.undistorted = arguments.lens == "undistorted";
  for (const std::string& name : arguments.lookNames)
  {
    *findOverlaySwitch(look, name) = true;
  }
  if (!arguments.keyhole.empty())
  {
    look.keyhole = true;
    look.keyholeCenter = { arguments.keyhole[0], arguments.keyhole[1] };
    look.keyholeRadius = arguments.keyhole[2];
  }
  for (const std::string& name : arguments.withoutNames)
  {
    *findOverlaySwitch(look, name) = false;
  }
  try
  {
    look.check();
  }
  catch (const std::invalid_argument& error)
  {
    throw CLI::ValidationError("overlay", error.what());
  }
  return look;
}

vtkHandEyeStereoOverlay::Layout stereoLayoutOf(const std::string& word)
{
  const auto found = layouts().find(word);
  return found == layouts().end() ? Layout::SideBySide : found->second;
}

}  // namespace handeye::cli
