// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSlicerHandEyeCalibrationModuleLogicExport.h"

#include <array>
#include <string>
#include <vector>

namespace handeye
{

/// How an overlay looks: what a surgeon or an engineer switches on and off while watching. All looks can be combined.
///
/// Places and lengths in the picture are shares of it (0, 0 is the upper left corner; lengths are shares of the height) or video
/// pixels, so that a look is the same in a window of any size and device pixel ratio.
struct OverlayLook
{
  bool undistorted = false;  ///< the video is straightened and the model drawn plainly; otherwise the lens bends the model
  bool surface = true;       ///< the model's shaded surface; without it, only what else is on is seen
  bool outline = false;      ///< a line where the model ends, and where one part of it lies before another
  bool wireframe = false;    ///< the edges of the foremost triangles, in place of the surface
  bool clipping = false;  ///< what is nearer than a plane that faces the camera is cut away; surfaces seen from inside are reddish
  bool keyhole = false;   ///< the surface only within a round window in the picture
  bool ghosting = false;  ///< the surface gives way where the video has edges, so that they stay visible
  bool depthColors = false;  ///< red is near, blue is far; the distances are written beside it
  bool errorHalo = false;    ///< a rim around the model as wide as the predicted error; needs a covariance
  bool stylus = true;        ///< the stylus' tip and the ray that it points along, while the stylus is known
  bool occlusion = true;     ///< the model gives way where the tracked stylus is in front of it

  double outlineWidthPx = 2.5;  ///< of the video, across the line; more than 0
  std::array<double, 3> outlineColor{ 0.1, 1.0, 0.35 };
  std::array<double, 3> haloColor{ 1.0, 0.75, 0.1 };
  double clippingDepth = 0.5;                       ///< the plane between the model's nearest (0) and furthest (1) depth
  std::array<double, 2> keyholeCenter{ 0.5, 0.5 };  ///< shares of the picture's width and height
  double keyholeRadius = 0.3;                       ///< share of the picture's height; more than 0
  double ghostingStrength = 1;  ///< 0: no effect, 1: strong edges of the video are seen as if there were no model

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT void check() const;
};

/// What a key does.
struct OverlayKey
{
  char key;          ///< lower case
  std::string name;  ///< of the look, a word as the command line uses it: "outline"; empty for a key that steps a number
  std::string help;  ///< for a person
};

/// All keys, in the order in which a help text lists them.
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT const std::vector<OverlayKey>& overlayKeys();

/// One line a key: "o  outline of the model".
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT std::string overlayKeyHelp();

/// Changes a look, and the model's opacity (0 to 1), as the key says; upper and lower case are the same.
/// @return false for a key that means nothing here
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT bool applyOverlayKey(char key, OverlayLook& look, double& opacity);

/// The switch of a look by its name in overlayKeys(), to be read or set; null for a name that is none.
VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT bool* findOverlaySwitch(OverlayLook& look, const std::string& name);

}  // namespace handeye
