// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace handeye
{

struct PoseAgeOptions
{
  double currentSec = 0.15;  ///< a pose no older than this is as good as new
  double goneSec = 0.6;      ///< a pose older than this is not shown at all; in between it fades evenly

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// When a tool was last seen.
struct ToolSight
{
  std::string name;               ///< for a person: "phantom", "camera marker"
  std::optional<double> seenSec;  ///< time of the latest valid pose; nothing: never seen
};

struct PoseAge
{
  enum class Status
  {
    Current,
    Fading,  ///< shown where it last was, paler and paler
    Gone,    ///< too old: nothing is shown
    NeverSeen
  };

  Status status = Status::NeverSeen;
  double opacity = 0;            ///< 0 to 1: what the overlay's opacity is multiplied by
  std::optional<double> ageSec;  ///< of the oldest tool's pose; nothing if one was never seen
  std::string message;           ///< which tools are not seen, and for how long; empty while all are current

  bool isUsable() const { return status == Status::Current || status == Status::Fading; }
};

/// What an overlay that needs several tools may still show: the tool that was not seen for the longest time decides. An overlay
/// that stays where it was while a tool is hidden looks right and is wrong; so it fades, and says which tool it is.
///
///     opacity = clamp((goneSec - age) / (goneSec - currentSec), 0, 1)
///
/// @param nowSec in the clock of the poses; an age below 0 (a pose from the future of a slower clock) counts as 0
/// @throws std::invalid_argument for a time that is not finite (naming the tool), without tools, or where the options do not check
/// Thread-safe.
[[nodiscard]] PoseAge judgePoseAge(const std::vector<ToolSight>& tools, double nowSec, const PoseAgeOptions& options = {});

/// The same for what was placed when all tools were seen at once: if that is longer ago than each tool by itself (they were
/// hidden in turn), it decides.
/// @param togetherSec when all of them were last seen at once; nothing: never yet, each tool by itself decides
[[nodiscard]] PoseAge judgePoseAge(
  const std::vector<ToolSight>& tools, const std::optional<double>& togetherSec, double nowSec, const PoseAgeOptions& options = {});

/// "current", "fading", "gone", "never_seen": the word that result files use.
std::string toString(PoseAge::Status status);

}  // namespace handeye
