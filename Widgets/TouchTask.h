// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "DeviceSample.h"
#include "PoseTrack.h"
#include "StillnessDetector.h"

#include <Eigen/Core>
#include <QString>

#include <chrono>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

namespace handeye
{

/// Where the stylus' tip is on the phantom while it is touched:
///
///     tip_Phantom = inverse(phantomToTracker) * stylusToTracker * tip_Stylus        mm
///
/// and where it rests (see StillnessDetector). Every pose of the stylus counts, whatever the video does; the phantom's pose is that
/// of the same moment.
///
/// onSample() belongs to the thread of the sources, the rest to that of the user interface.
class TouchTask
{
public:
  struct Touch
  {
    std::optional<Eigen::Vector3d> tip_Phantom;   ///< nothing while a tool is not seen
    std::optional<Eigen::Vector3d> rest_Phantom;  ///< the mean of the rest that is under way
    QString problem;                              ///< why there is no tip, a sentence
  };

  /// Whose tip is followed; another stylus, or another phantom, begins anew.
  void follow(
    const std::optional<Eigen::Vector3d>& tip_Stylus, const std::string& stylusToTracker, const std::string& phantomToTracker);

  /// Other devices: their times may be any.
  void restart();

  void onSample(const devices::DeviceSample& sample);

  Touch newest() const;

private:
  void clear();
  void take(double timeSec);

  mutable std::mutex mutex_;
  std::string stylusToTracker_, phantomToTracker_;
  std::optional<Eigen::Vector3d> tip_Stylus_;
  PoseTrack stylus_, phantom_;
  std::deque<double> waitingSec_;  ///< moments of the stylus for which the phantom's pose has not come yet
  std::optional<StillnessDetector> stillness_;
  std::chrono::steady_clock::time_point taken_;  ///< when the newest moment was taken
  Touch touch_;
};

}  // namespace handeye
