// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "FramePairing.h"
#include "StillnessDetector.h"

#include <Eigen/Core>
#include <QString>

#include <optional>

namespace handeye
{

/// Where the stylus' tip is on the phantom while it is touched:
///
///     tip_Phantom = inverse(phantomToTracker) * stylusToTracker * tip_Stylus        mm
///
/// and where it rests (see StillnessDetector). Frames are given one by one; not safe to share between threads.
class TouchTask
{
public:
  /// Another stylus, or another phantom: begins anew.
  void reset(
    const std::optional<Eigen::Vector3d>& tip_Stylus, const std::string& stylusToTracker, const std::string& phantomToTracker);

  void add(const devices::PairedFrame& frame);

  /// Nothing while a tool is not seen; problem() says which.
  const std::optional<Eigen::Vector3d>& tip_Phantom() const { return tip_Phantom_; }
  const QString& problem() const { return problem_; }
  /// The mean of the rest that is under way.
  std::optional<Eigen::Vector3d> rest_Phantom() const;

private:
  std::string stylusToTracker_, phantomToTracker_;
  std::optional<Eigen::Vector3d> tip_Stylus_, tip_Phantom_;
  std::optional<StillnessDetector> stillness_;
  double newestSec_ = -1;
  QString problem_;
};

}  // namespace handeye
