// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <utility>

namespace handeye::cli
{

/// What is wrong frame after frame, said so that a person can read it: a line a second at most, and the same line every five seconds.
class PacedMessages
{
public:
  explicit PacedMessages(std::function<void(const std::string&)> say)
    : say_(std::move(say))
  {
  }

  /// @param timeSec of the stream
  void add(const std::string& message, double timeSec)
  {
    if (!message.empty() && timeSec > lastSec_ + 1 && (message != last_ || timeSec > lastSec_ + 5))
    {
      say_(message);
      last_ = message;
      lastSec_ = timeSec;
    }
  }

private:
  std::function<void(const std::string&)> say_;
  std::string last_;
  double lastSec_ = -1e300;
};

}  // namespace handeye::cli
