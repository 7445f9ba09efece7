// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TipTrack.h"

#include "Statistics.h"

#include <algorithm>
#include <cmath>

namespace handeye
{

TipTrack::TipTrack(const PoseTrack& marker, const PoseTrack& stylus, const Eigen::Vector3d& tip_Stylus)
{
  std::vector<double> spacings;
  for (double timeSec : stylus.timesSec())
  {
    Knot knot{ timeSec, std::nullopt };
    const PoseAtTime markerToTracker = marker.at(timeSec), stylusToTracker = stylus.at(timeSec);
    if (markerToTracker.isUsable() && stylusToTracker.isUsable())
    {
      const Eigen::Vector3d tip_Tracker = stylusToTracker.transform * tip_Stylus;
      knot.tip_Marker = markerToTracker.transform.inverse() * tip_Tracker;
    }
    if (!knots_.empty())
    {
      spacings.push_back(timeSec - knots_.back().timeSec);
    }
    knots_.push_back(knot);
  }
  if (!spacings.empty())
  {
    maximumGapSec_ = std::max(maximumGapSec_, 1.5 * median(spacings));
  }
  noiseMm_ = measureNoise();
}

/// Whether a knot and the one after it are measurements with nothing missing in between.
bool TipTrack::isJoined(std::size_t first) const
{
  return first + 1 < knots_.size() && knots_[first].tip_Marker && knots_[first + 1].tip_Marker &&
    knots_[first + 1].timeSec - knots_[first].timeSec <= maximumGapSec_;
}

double TipTrack::measureNoise() const
{
  constexpr double SquaresOfFourthDifference = 70;  // 1 + 16 + 36 + 16 + 1
  std::vector<double> lengths;
  for (std::size_t k = 0; k + 4 < knots_.size(); ++k)
  {
    if (isJoined(k) && isJoined(k + 1) && isJoined(k + 2) && isJoined(k + 3))
    {
      const Eigen::Vector3d outer = *knots_[k].tip_Marker + *knots_[k + 4].tip_Marker;
      const Eigen::Vector3d inner = *knots_[k + 1].tip_Marker + *knots_[k + 3].tip_Marker;
      lengths.push_back((outer - 4 * inner + 6 * *knots_[k + 2].tip_Marker).norm());
    }
  }
  return lengths.empty() ? 0 : median(lengths) / MedianOfChi3 / std::sqrt(SquaresOfFourthDifference);
}

std::optional<TipTrack::Place> TipTrack::at(double timeSec) const
{
  const auto after =
    std::upper_bound(knots_.begin(), knots_.end(), timeSec, [](double time, const Knot& knot) { return time < knot.timeSec; });
  if (after == knots_.begin())
  {
    return std::nullopt;
  }
  const std::size_t k = std::size_t(after - knots_.begin()) - 1;
  if (knots_[k].timeSec == timeSec)
  {
    return knots_[k].tip_Marker ? std::optional<Place>({ *knots_[k].tip_Marker, 1 }) : std::nullopt;
  }
  if (!isJoined(k))
  {
    return std::nullopt;
  }
  const bool isCubic = k > 0 && isJoined(k - 1) && isJoined(k + 1);
  const std::size_t first = isCubic ? k - 1 : k, last = isCubic ? k + 2 : k + 1;
  Place place;
  place.noiseShare = 0;
  for (std::size_t i = first; i <= last; ++i)
  {
    double weight = 1;  // Lagrange
    for (std::size_t j = first; j <= last; ++j)
    {
      weight *= j == i ? 1 : (timeSec - knots_[j].timeSec) / (knots_[i].timeSec - knots_[j].timeSec);
    }
    place.tip_Marker += weight * *knots_[i].tip_Marker;
    place.noiseShare += weight * weight;
  }
  return place;
}

}  // namespace handeye
