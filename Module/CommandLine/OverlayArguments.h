// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CommandOutput.h"
#include "OverlayLook.h"
#include "vtkHandEyeStereoOverlay.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace handeye::cli
{

/// What `handeye overlay` was asked for.
struct OverlayArguments
{
  std::string recording, calibration, model, registration, folder;
  std::string phantomTransform = "PhantomToTracker";
  std::string markerTransform, stylusTransform;
  std::optional<double> latencySec;
  bool mask = false;
  std::string color;
  double opacity = -1;

  OverlayLook look;
  std::vector<std::string> lookNames, withoutNames;
  std::string lens = "raw";
  std::vector<double> keyhole;
  std::string stylus;
  double shaftRadiusMm = 4, shaftLengthMm = 150, rayLengthMm = 100;
  bool fade = false, smooth = false;

  std::string right, rightCamera, stereo;
  bool swapped = false;

  std::string video;
  double framesPerSec = 30;
  CommandOutput output;

  bool isStereo() const { return !this->right.empty(); }
};

/// All options of the command.
void addOverlayOptions(CLI::App& command, OverlayArguments& arguments);

/// The look that the options ask for. @throws CLI::ValidationError for options that contradict each other
OverlayLook overlayLookOf(const OverlayArguments& arguments);

/// The layout of --stereo; side by side if it is not given.
vtkHandEyeStereoOverlay::Layout stereoLayoutOf(const std::string& word);

}  // namespace handeye::cli
