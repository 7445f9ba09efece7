// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CaptureTask.h"
#include "LiveCapture.h"
#include "Session.h"

#include <memory>
#include <optional>
#include <set>
#include <string>

namespace handeye
{

/// What belongs to the work's thread.
struct CaptureTask::Work
{
  std::optional<io::Session> session;
  std::optional<CaptureInputs> inputs;
  std::unique_ptr<devices::LiveCapture> live;
  std::set<int> deleted;
  int sessionCount = 0;  ///< of CaptureTask::session_, when the folder was opened
  bool isHandsFree = false;
  int takeTries = 0;  ///< frames in which the sample that was asked for is still looked for
  devices::LiveCapture::Step::Status lastStatus = devices::LiveCapture::Step::Status::Accepted;
  std::string lastMessage;

  /// How many samples are not deleted.
  int shownCount() const;
  /// The places that are taken are looked at anew.
  void renewLive();
  /// A message with the tools' words in place of the names of their streams.
  QString inWords(const std::string& message) const;
  /// A stored sample with the inputs as they are.
  CaptureSample evaluate(int id) const;
};

}  // namespace handeye
