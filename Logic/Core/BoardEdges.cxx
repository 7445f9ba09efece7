// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardEdges.h"

#include "Statistics.h"

#include <map>
#include <optional>

namespace handeye
{

namespace
{

constexpr double StepPx = 0.25;
constexpr double LeastContrast = 20;  ///< of 255

/// The distance between the places where a profile leaves 10 % and reaches 90 % of its step.
std::optional<double> riseOf(const std::vector<double>& profile)
{
  const auto [lowest, highest] = std::minmax_element(profile.begin(), profile.end());
  const double contrast = *highest - *lowest;
  if (contrast < LeastContrast)
  {
    return std::nullopt;
  }
  const bool rises = profile.back() > profile.front();
  const auto level = [&](std::size_t i) { return ((rises ? profile[i] : profile[profile.size() - 1 - i]) - *lowest) / contrast; };
  const auto crossing = [&](double wanted) -> std::optional<double>
  {
    for (std::size_t i = 1; i < profile.size(); ++i)
    {
      if (level(i - 1) < wanted && level(i) >= wanted)
      {
        return double(i) - (level(i) - wanted) / (level(i) - level(i - 1));
      }
    }
    return std::nullopt;
  };
  const std::optional<double> low = crossing(0.1), high = crossing(0.9);
  return low && high && *high > *low ? std::optional((*high - *low) * StepPx) : std::nullopt;
}

/// The grey values on the way from one place to another.
std::vector<double> profileOf(const cv::Mat& grey8, const Eigen::Vector2d& from, const Eigen::Vector2d& to)
{
  std::vector<double> profile;
  const double length = (to - from).norm();
  for (double along = 0; along <= length; along += StepPx)
  {
    profile.push_back(valueAt(grey8, from + (to - from) * (along / length)));
  }
  return profile;
}

}  // namespace

double valueAt(const cv::Mat& grey8, const Eigen::Vector2d& point_Image)
{
  const double x = std::clamp(point_Image.x(), 0.0, grey8.cols - 1.001), y = std::clamp(point_Image.y(), 0.0, grey8.rows - 1.001);
  const int column = int(x), row = int(y);
  const double u = x - column, v = y - row;
  const auto at = [&](int r, int c) { return double(grey8.at<uchar>(std::min(r, grey8.rows - 1), std::min(c, grey8.cols - 1))); };
  return (1 - v) * ((1 - u) * at(row, column) + u * at(row, column + 1)) +
    v * ((1 - u) * at(row + 1, column) + u * at(row + 1, column + 1));
}

double measureEdgeWidth(const cv::Mat& grey8, const BoardDescription& board, const BoardDetection& detection)
{
  std::map<int, Eigen::Vector2d> points;
  for (std::size_t i = 0; i < detection.ids.size(); ++i)
  {
    points[detection.ids[i]] = detection.points_Image[i];
  }
  const bool hasCircles = board.kind == BoardDescription::Kind::Circles || board.kind == BoardDescription::Kind::AsymmetricCircles;
  // A line between squares can be followed to half a square on both sides; with markers to what is white around them.
  const double reach = board.kind == BoardDescription::Kind::Charuco ? 0.4 * (1 - board.markerMm / board.spacingMm) : 0.4;
  std::vector<double> widths;
  for (const auto& [id, here] : points)
  {
    const auto next = points.find(id + 1);
    if (next == points.end() || id % board.pointColumns() == board.pointColumns() - 1)
    {
      continue;
    }
    const Eigen::Vector2d way = next->second - here, middle = (here + next->second) / 2;
    const Eigen::Vector2d across = reach * Eigen::Vector2d(-way.y(), way.x());
    const std::vector<double> profile =
      hasCircles ? profileOf(grey8, here, middle) : profileOf(grey8, middle - across, middle + across);
    if (const std::optional<double> width = riseOf(profile))
    {
      widths.push_back(*width);
    }
  }
  return widths.empty() ? 0 : median(widths);
}

}  // namespace handeye
