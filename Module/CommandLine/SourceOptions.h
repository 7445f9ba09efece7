// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CommandOutput.h"
#include "FramePairing.h"
#include "Source.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace handeye::cli
{

/// The sources of a command: `--server HOST:PORT` (several), `--video DEVICE`, `--replay RECORDING`; samples of all of them in one
/// row.
/// Where there are several, times are brought to this computer's clock.
class LiveSources
{
public:
  devices::FramePairingOptions pairing;  ///< with --latency in it

  void addTo(CLI::App& command);
  /// For pictures alone: no latency, a replay needs no tracking, and no source is needed.
  void addPicturesTo(CLI::App& command);

  /// One of them was given.
  bool isAskedFor() const { return !servers_.empty() || !video_.empty() || !replay_.empty(); }

  void start();
  void stop();

  /// How long one may be silent, s.
  double waitSec() const { return waitSec_; }

  /// The next sample of any of them.
  std::optional<devices::DeviceSample> pop(double timeoutSec);

  /// Says, once each, which videos are left out.
  void warnOfOtherImages(const devices::FramePairing& pairs, const CommandOutput& output);

  /// Time of the newest sample since the first one.
  double streamSec() const { return newestSec_ - firstSec_; }

  /// False when every source has come to its end, or one of them is missing.
  bool isAlive() const;

  /// Why a source that was asked for is missing: it cannot be read, or nothing came from it for the time that is given (--wait). Empty if
  /// none is.
  std::string missing() const;
  /// The same at the end of the work, when a source that has given nothing yet is missing, too.
  std::string missingAtEnd() const;

  /// What the sources say of themselves.
  std::string message() const;
  nlohmann::json statusJson() const;

private:
  std::vector<std::string> servers_;
  std::string video_, replay_;
  double speed_ = 1, waitSec_ = 10;
  bool needsTracking_ = true;
  struct Entry
  {
    std::unique_ptr<devices::Source> source;
    bool isLive = true;    ///< as opposed to a file, which may have pauses
    double newestSec = 0;  ///< by this computer's clock; of its start before the first sample
    bool hasSample = false;
    devices::ClockOffset offset;
  };

  void addSourcesTo(CLI::App& command, bool isRequired);
  void add(std::unique_ptr<devices::Source> source, bool isLive);
  static std::string problemOf(const Entry& entry);

  std::vector<Entry> entries_;
  std::set<std::string> saidImages_;
  std::size_t next_ = 0;
  double firstSec_ = 0, newestSec_ = 0;
  bool hasSample_ = false;
};

}  // namespace handeye::cli
