// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LensWarp.h"

#include <array>

namespace handeye
{

/// Which of two eyes a picture is for, where both share the pixels of a window.
struct EyeChannel
{
  std::array<bool, 3> colors{ true, true, true };  ///< red, green, blue that are written
  bool luma = false;                               ///< brightness in place of colour: the red of an anaglyph
  bool alternateRows = false;                      ///< every other row of the window
  double rowOffset = 0;  ///< 0 or 1: rows (from the bottom) of which this plus the row is even are written

  bool operator==(const EyeChannel& other) const
  {
    return this->colors == other.colors && this->luma == other.luma && this->alternateRows == other.alternateRows &&
      this->rowOffset == other.rowOffset;
  }
};

/// What vtkHandEyeLensMapper makes of the pixels of a mesh; distances in mm, `Camera` frame; device px.
struct LensAppearance
{
  /// Parts of the shader; a change builds it anew.
  struct Features
  {
    bool limit = true;     ///< leave out what the lens model does not reach; not needed for a mesh that is all within it
    bool compose = false;  ///< mix the video in, no blending; what follows needs it
    bool mix = false;      ///< opacity below 1, or one of keyhole and ghosting
    bool keyhole = false;
    bool ghosting = false;
    bool clip = false;
    bool depthColors = false;

    bool operator==(const Features& other) const
    {
      return this->limit == other.limit && this->compose == other.compose && this->mix == other.mix &&
        this->keyhole == other.keyhole && this->ghosting == other.ghosting && this->clip == other.clip &&
        this->depthColors == other.depthColors;
    }
  };

  Features features;
  EyeChannel eye;
  double opacity = 1;
  double outputAlpha = 1;                       ///< what the framebuffer's alpha becomes
  std::array<double, 4> picture{ 0, 0, 1, 1 };  ///< x, y (lower left corner), width, height of the picture in the framebuffer
  std::array<int, 2> videoSize{ 1, 1 };
  bool undistortedVideo = false;  ///< `lookup` and `pinhole` then say which pixel of the video belongs where
  LensWarp lookup;
  std::array<double, 4> pinhole{ 1, 1, 0, 0 };     ///< fx fy cx cy, px of the video
  double clipDepthMm = 0;                          ///< nearer than this is not drawn
  std::array<double, 2> depthRangeMm{ 0, 1 };      ///< the ends of the colours by depth
  std::array<double, 3> keyhole{ 0.5, 0.5, 100 };  ///< centre (shares of the picture from the lower left), radius
  double ghosting = 1;
};

}  // namespace handeye
