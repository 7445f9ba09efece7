// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardFinders.h"

#include "BoardDictionary.h"
#include "BoardEdges.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <numeric>

namespace handeye
{

namespace
{

using Points = std::vector<Eigen::Vector2d>;

Points toEigen(const std::vector<cv::Point2f>& points)
{
  Points converted;
  for (const cv::Point2f& point : points)
  {
    converted.emplace_back(point.x, point.y);
  }
  return converted;
}

/// A numbering with the columns or the rows counted from the other end.
Points flipped(const Points& points, int columns, bool flipsColumns, bool flipsRows)
{
  const int rows = int(points.size()) / columns;
  Points result;
  for (int i = 0; i < int(points.size()); ++i)
  {
    const int column = flipsColumns ? columns - 1 - i % columns : i % columns;
    const int row = flipsRows ? rows - 1 - i / columns : i / columns;
    result.push_back(points[std::size_t(row * columns + column)]);
  }
  return result;
}

/// Whether x turns to y as it does on the board: a picture is not a mirror.
bool isRightHanded(const Points& points, int columns)
{
  const Eigen::Vector2d x = points[std::size_t(columns - 1)] - points[0],
                        y = points[points.size() - std::size_t(columns)] - points[0];
  return x.x() * y.y() - x.y() * y.x() > 0;
}

/// Root mean square distance (px) from the best homography of the board.
double misfit(const Points& points, const BoardDescription& board)
{
  std::vector<cv::Point2f> from, to, mapped;
  for (int id = 0; id < board.pointCount(); ++id)
  {
    const Eigen::Vector3d place = boardPoint(board, id);
    from.emplace_back(float(place.x()), float(place.y()));
    to.emplace_back(float(points[std::size_t(id)].x()), float(points[std::size_t(id)].y()));
  }
  const cv::Mat homography = fitHomography(from, to);
  if (homography.empty())
  {
    return std::numeric_limits<double>::infinity();
  }
  cv::perspectiveTransform(from, mapped, homography);
  return cv::norm(cv::Mat(to), cv::Mat(mapped)) / std::sqrt(double(to.size()));
}

/// Whether the squares between four points alternate as they should: the one after point 0 is black.
bool hasOurColours(const cv::Mat& grey8, const Points& points, int columns)
{
  double difference = 0;  // white minus black
  const int rows = int(points.size()) / columns;
  for (int row = 0; row + 1 < rows; ++row)
  {
    for (int column = 0; column + 1 < columns; ++column)
    {
      const std::size_t i = std::size_t(row * columns + column), below = i + std::size_t(columns);
      const double value = valueAt(grey8, (points[i] + points[i + 1] + points[below] + points[below + 1]) / 4);
      difference += (row + column) % 2 == 0 ? -value : value;
    }
  }
  return difference > 0;
}

void setWholeGrid(Points points, BoardDetection& detection)
{
  detection.points_Image = std::move(points);
  detection.ids.resize(detection.points_Image.size());
  std::iota(detection.ids.begin(), detection.ids.end(), 0);
  detection.status = BoardDetection::Status::Ok;
  detection.message = "all " + std::to_string(detection.ids.size()) + " points";
}

}  // namespace

cv::Mat fitHomography(const std::vector<cv::Point2f>& from, const std::vector<cv::Point2f>& to)
{
  return from.size() < 4 ? cv::Mat() : cv::findHomography(from, to, 0);
}

Points numberGrid(const Points& found, const BoardDescription& board, const std::function<bool(const Points&)>& isColourRight)
{
  const int columns = board.pointColumns();
  Points best;
  double leastMisfit = std::numeric_limits<double>::infinity();
  for (int turn = 0; turn < 4; ++turn)
  {
    const Points points = flipped(found, columns, turn % 2 == 1, turn / 2 == 1);
    if (!isRightHanded(points, columns) || (isColourRight && !isColourRight(points)))
    {
      continue;
    }
    const double fit = misfit(points, board);
    if (fit < 0.99 * leastMisfit)  // equal ones: the finder's own order
    {
      leastMisfit = fit;
      best = points;
    }
  }
  return best;
}

void findChessboard(const cv::Mat& grey8, const BoardDescription& board, BoardDetection& detection)
{
  const cv::Size size(board.columns, board.rows);
  std::vector<cv::Point2f> corners;
  const int flags = cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_ACCURACY;
  if (!cv::findChessboardCornersSB(grey8, size, corners, flags) || int(corners.size()) != board.pointCount())
  {
    detection.message = "no chessboard with " + std::to_string(board.columns) + " x " + std::to_string(board.rows) +
      " inner corners is seen as a whole";
    return;
  }
  const Points found = toEigen(corners);
  const auto isColourRight = [&](const Points& points) { return hasOurColours(grey8, points, board.columns); };
  Points points = numberGrid(found, board, isColourRight);
  if (points.empty())
  {
    points = numberGrid(found, board, {});  // white where ours is black, and looking the same turned
  }
  setWholeGrid(std::move(points), detection);
}

void findCharuco(const cv::Mat& grey8, const BoardDescription& board, int minimumPoints, BoardDetection& detection)
{
  const cv::Ptr<cv::aruco::CharucoBoard> charuco = makeCharucoBoard(board);
  const cv::Ptr<cv::aruco::DetectorParameters> parameters = cv::aruco::DetectorParameters::create();
  std::vector<std::vector<cv::Point2f>> markers;
  std::vector<int> markerIds;
  cv::aruco::detectMarkers(grey8, charuco->dictionary, markers, markerIds, parameters);
  if (markerIds.empty())
  {
    detection.message = "no marker of " + board.dictionary + " is seen";
    return;
  }
  const int strange =
    int(std::count_if(markerIds.begin(), markerIds.end(), [&](int id) { return id >= int(charuco->ids.size()); }));
  if (2 * strange > int(markerIds.size()))
  {
    detection.status = BoardDetection::Status::WrongBoard;
    detection.message = "most markers that are seen are not on this board: it has other columns or rows, or another is in view";
    return;
  }
  std::vector<cv::Point2f> corners;
  std::vector<int> ids;
  cv::aruco::interpolateCornersCharuco(markers, markerIds, grey8, charuco, corners, ids);
  if (int(ids.size()) < minimumPoints)
  {
    detection.status = BoardDetection::Status::TooFewPoints;
    detection.message =
      std::to_string(ids.size()) + " corners of the board are seen, " + std::to_string(minimumPoints) + " are needed";
    return;
  }
  std::vector<std::size_t> order(ids.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
  for (const std::size_t i : order)
  {
    detection.ids.push_back(ids[i]);
    detection.points_Image.emplace_back(corners[i].x, corners[i].y);
  }
  detection.status = BoardDetection::Status::Ok;
  detection.message = std::to_string(ids.size()) + " of " + std::to_string(board.pointCount()) + " corners";
}

}  // namespace handeye
