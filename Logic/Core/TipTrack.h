// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "PoseTrack.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace handeye
{

/// The way of the stylus' tip as the camera's marker sees it, between the moments at which the tracker measured:
///
///     tip_Marker(t) = inverse(markerToTracker(t)) * stylusToTracker(t) * tip_Stylus        (mm)
///
/// At the stylus' own times the tip is what was measured; in between it lies on the cubic through the two measurements before and the two
/// after (on the line between one and one where there are no more). A mean of measurements has less noise than one of them. What looks
/// for the moment of least scatter would prefer the middle between two measurements for that alone: Place::noiseShare and noiseMm() say
/// how much of the noise is left, so that it can be given back.
///
/// Thread-safe once made.
class TipTrack
{
public:
  struct Place
  {
    Eigen::Vector3d tip_Marker = Eigen::Vector3d::Zero();  ///< mm
    double noiseShare = 1;                                 ///< of the variance of one measurement: the sum of squared weights
  };

  /// @param marker,stylus as calibrateLatency() takes them
  TipTrack(const PoseTrack& marker, const PoseTrack& stylus, const Eigen::Vector3d& tip_Stylus);

  /// Nothing where a tool was not seen, outside of the measurements, or where those on both sides are too far apart: more than 0.1 s, or
  /// than one and a half times what is usual in the track.
  [[nodiscard]] std::optional<Place> at(double timeSec) const;

  /// Standard deviation of one measurement per axis, mm: from the median of fourth differences of consecutive measurements, in which smooth
  /// motion cancels. 0 if there are fewer than five in a row.
  [[nodiscard]] double noiseMm() const { return noiseMm_; }

private:
  struct Knot
  {
    double timeSec;
    std::optional<Eigen::Vector3d> tip_Marker;
  };

  bool isJoined(std::size_t first) const;
  double measureNoise() const;

  std::vector<Knot> knots_;
  double maximumGapSec_ = 0.1;
  double noiseMm_ = 0;
};

}  // namespace handeye
