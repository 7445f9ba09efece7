// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PoseAge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace handeye
{

namespace
{

std::string sentence(const ToolSight& tool, double nowSec)
{
  if (!tool.seenSec)
  {
    return "the " + tool.name + " has not been seen yet";
  }
  char age[32];
  std::snprintf(age, sizeof(age), "%.1f s", std::max(0.0, nowSec - *tool.seenSec));
  return "the " + tool.name + " is not seen, for " + age;
}

void checkInput(const std::vector<ToolSight>& tools, double nowSec)
{
  if (tools.empty())
  {
    throw std::invalid_argument("the age of poses needs at least one tool");
  }
  if (!std::isfinite(nowSec))
  {
    throw std::invalid_argument("the time now is not a finite number");
  }
  for (const ToolSight& tool : tools)
  {
    if (tool.seenSec && !std::isfinite(*tool.seenSec))
    {
      throw std::invalid_argument("the time at which the " + tool.name + " was seen is not a finite number");
    }
  }
}

}  // namespace

void PoseAgeOptions::check() const
{
  if (!(this->currentSec >= 0) || !std::isfinite(this->currentSec))
  {
    throw std::invalid_argument("the age up to which a pose is current must be 0 s or more");
  }
  if (!(this->goneSec > this->currentSec) || !std::isfinite(this->goneSec))
  {
    throw std::invalid_argument("the age at which a pose is gone must be more than the age up to which it is current");
  }
}

PoseAge judgePoseAge(const std::vector<ToolSight>& tools, double nowSec, const PoseAgeOptions& options)
{
  options.check();
  checkInput(tools, nowSec);
  PoseAge result;
  bool neverSeen = false;
  double oldestSec = 0;
  for (const ToolSight& tool : tools)
  {
    const double ageSec = tool.seenSec ? std::max(0.0, nowSec - *tool.seenSec) : 0;
    neverSeen = neverSeen || !tool.seenSec;
    oldestSec = std::max(oldestSec, ageSec);
    if (!tool.seenSec || ageSec > options.currentSec)
    {
      result.message += (result.message.empty() ? "" : "; ") + sentence(tool, nowSec);
    }
  }
  if (neverSeen)
  {
    return result;
  }
  result.ageSec = oldestSec;
  result.opacity = std::clamp((options.goneSec - oldestSec) / (options.goneSec - options.currentSec), 0.0, 1.0);
  result.status = oldestSec <= options.currentSec ? PoseAge::Status::Current
    : oldestSec < options.goneSec                 ? PoseAge::Status::Fading
                                                  : PoseAge::Status::Gone;
  return result;
}

PoseAge judgePoseAge(
  const std::vector<ToolSight>& tools, const std::optional<double>& togetherSec, double nowSec, const PoseAgeOptions& options)
{
  const PoseAge each = judgePoseAge(tools, nowSec, options);
  if (!each.isUsable() || !togetherSec)
  {
    return each;
  }
  std::string names;
  for (const ToolSight& tool : tools)
  {
    names += (names.empty() ? "" : " and ") + tool.name;
  }
  const PoseAge together = judgePoseAge({ { names + " at once", togetherSec } }, nowSec, options);
  return together.opacity < each.opacity ? together : each;
}

std::string toString(PoseAge::Status status)
{
  switch (status)
  {
    case PoseAge::Status::Current:
      return "current";
    case PoseAge::Status::Fading:
      return "fading";
    case PoseAge::Status::Gone:
      return "gone";
    case PoseAge::Status::NeverSeen:
      return "never_seen";
  }
  return "unknown";
}

}  // namespace handeye
