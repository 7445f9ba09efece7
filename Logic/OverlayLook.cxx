// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OverlayLook.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

namespace handeye
{

namespace
{

constexpr double OpacityStep = 0.1;
constexpr double ClippingStep = 0.05;
constexpr double KeyholeStep = 1.15;
constexpr double SmallestKeyhole = 0.03;
constexpr double LargestKeyhole = 2;

struct Switch
{
  OverlayKey key;
  bool OverlayLook::*value;
};

const std::vector<Switch>& switches()
{
  static const std::vector<Switch> all{
    { { 'u', "undistorted", "straightened video with the model drawn plainly, or the raw video with a bent model" },
      &OverlayLook::undistorted },
    { { 'm', "surface", "surface of the model" }, &OverlayLook::surface },
    { { 'o', "outline", "outline of the model" }, &OverlayLook::outline },
    { { 'w', "wireframe", "edges of the triangles in place of the surface" }, &OverlayLook::wireframe },
    { { 'c', "clipping", "cut away what is nearer than a plane facing the camera" }, &OverlayLook::clipping },
    { { 'k', "keyhole", "the surface only within a round window" }, &OverlayLook::keyhole },
    { { 'g', "ghosting", "edges of the video stay visible through the surface" }, &OverlayLook::ghosting },
    { { 'd', "depth-colors", "colours by depth: red is near, blue is far" }, &OverlayLook::depthColors },
    { { 'h', "halo", "rim as wide as the predicted error" }, &OverlayLook::errorHalo },
    { { 't', "stylus", "tip of the stylus and its ray" }, &OverlayLook::stylus },
    { { 'f', "occlusion", "the model gives way where the stylus is in front of it" }, &OverlayLook::occlusion },
  };
  return all;
}

std::vector<OverlayKey> makeKeys()
{
  std::vector<OverlayKey> keys;
  for (const Switch& one : switches())
  {
    keys.push_back(one.key);
  }
  keys.push_back({ '+', "", "more opaque" });
  keys.push_back({ '-', "", "more transparent" });
  keys.push_back({ ']', "", "clipping plane further away" });
  keys.push_back({ '[', "", "clipping plane nearer" });
  keys.push_back({ '>', "", "larger window (keyhole)" });
  keys.push_back({ '<', "", "smaller window (keyhole)" });
  keys.push_back({ '0', "", "the plain look again" });
  return keys;
}

bool stepNumber(char key, OverlayLook& look, double& opacity)
{
  switch (key)
  {
    case '+':
    case '=':
      opacity = std::min(1.0, opacity + OpacityStep);
      return true;
    case '-':
      opacity = std::max(0.0, opacity - OpacityStep);
      return true;
    case ']':
      look.clippingDepth = std::min(1.0, look.clippingDepth + ClippingStep);
      return true;
    case '[':
      look.clippingDepth = std::max(0.0, look.clippingDepth - ClippingStep);
      return true;
    case '>':
      look.keyholeRadius = std::min(LargestKeyhole, look.keyholeRadius * KeyholeStep);
      return true;
    case '<':
      look.keyholeRadius = std::max(SmallestKeyhole, look.keyholeRadius / KeyholeStep);
      return true;
    default:
      return false;
  }
}

void require(bool good, const char* sentence)
{
  if (!good)
  {
    throw std::invalid_argument(sentence);
  }
}

bool isShare(double value)
{
  return value >= 0 && value <= 1;
}

}  // namespace

void OverlayLook::check() const
{
  require(std::isfinite(this->outlineWidthPx) && this->outlineWidthPx > 0, "the outline's width must be more than 0 px");
  for (const std::array<double, 3>& color : { this->outlineColor, this->haloColor })
  {
    require(std::all_of(color.begin(), color.end(), isShare), "red, green and blue of a colour must lie between 0 and 1");
  }
  require(isShare(this->clippingDepth), "the depth of the clipping plane must lie between 0 (nearest) and 1 (furthest)");
  require(std::isfinite(this->keyholeCenter[0]) && std::isfinite(this->keyholeCenter[1]), "the keyhole's centre must be finite");
  require(std::isfinite(this->keyholeRadius) && this->keyholeRadius > 0, "the keyhole's radius must be more than 0");
  require(isShare(this->ghostingStrength), "the strength of the ghosting must lie between 0 and 1");
}

const std::vector<OverlayKey>& overlayKeys()
{
  static const std::vector<OverlayKey> keys = makeKeys();
  return keys;
}

std::string overlayKeyHelp()
{
  std::string text;
  for (const OverlayKey& key : overlayKeys())
  {
    text += std::string(1, key.key) + "  " + key.help + "\n";
  }
  return text;
}

bool applyOverlayKey(char key, OverlayLook& look, double& opacity)
{
  const char small = char(std::tolower(static_cast<unsigned char>(key)));
  for (const Switch& one : switches())
  {
    if (one.key.key == small)
    {
      look.*one.value = !(look.*one.value);
      return true;
    }
  }
  if (small == '0')
  {
    const bool undistorted = look.undistorted;
    look = OverlayLook();
    look.undistorted = undistorted;
    return true;
  }
  return stepNumber(small, look, opacity);
}

bool* findOverlaySwitch(OverlayLook& look, const std::string& name)
{
  for (const Switch& one : switches())
  {
    if (one.key.name == name)
    {
      return &(look.*one.value);
    }
  }
  return nullptr;
}

}  // namespace handeye
