// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardFinders.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace handeye
{

namespace
{

/// Blobs of any size that so many circles may have in this picture.
cv::Ptr<cv::FeatureDetector> makeBlobDetector(const cv::Size& image, int circles)
{
  cv::SimpleBlobDetector::Params parameters;
  parameters.minArea = 12;
  parameters.maxArea = float(image.area()) / float(circles);
  parameters.minDistBetweenBlobs = 4;
  return cv::SimpleBlobDetector::create(parameters);
}

/// Encoded values to linear light, 0 to 1.
const std::vector<double>& linearLight()
{
  static const std::vector<double> table = []
  {
    std::vector<double> values;
    for (int i = 0; i < 256; ++i)
    {
      const double encoded = i / 255.0;
      values.push_back(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
    }
    return values;
  }();
  return table;
}

/// The centre of a dark spot's area: of what light is missing within this radius of where it is thought to be.
Eigen::Vector2d centroid(const cv::Mat& grey8, Eigen::Vector2d center, double radiusPx)
{
  for (int iteration = 0; iteration < 3; ++iteration)
  {
    const int reach = int(std::ceil(radiusPx));
    const cv::Rect area =
      cv::Rect(int(std::lround(center.x())) - reach, int(std::lround(center.y())) - reach, 2 * reach + 1, 2 * reach + 1) &
      cv::Rect({ 0, 0 }, grey8.size());
    std::vector<double> rim;
    const auto lightAt = [&](int x, int y) { return linearLight()[grey8.at<uchar>(y, x)]; };
    const auto distance = [&](int x, int y) { return std::hypot(x - center.x(), y - center.y()); };
    double darkest = 1;
    for (int i = 0; i < area.area(); ++i)
    {
      const int x = area.x + i % area.width, y = area.y + i / area.width;
      darkest = std::min(darkest, lightAt(x, y));
      if (std::abs(distance(x, y) - radiusPx) < 1)
      {
        rim.push_back(lightAt(x, y));
      }
    }
    if (rim.empty())
    {
      return center;
    }
    std::nth_element(rim.begin(), rim.begin() + std::ptrdiff_t(rim.size() / 2), rim.end());
    const double paper = rim[rim.size() / 2], noise = 0.1 * (paper - darkest);
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double weights = 0;
    for (int i = 0; i < area.area(); ++i)
    {
      const int x = area.x + i % area.width, y = area.y + i / area.width;
      const double missing = paper - lightAt(x, y);
      if (distance(x, y) <= radiusPx && missing > noise)
      {
        sum += missing * Eigen::Vector2d(x, y);
        weights += missing;
      }
    }
    if (!(weights > 0))
    {
      return center;
    }
    center = sum / weights;
  }
  return center;
}

/// The radius (px) around each circle within which nothing else is: a bit more than half the way to the nearest one.
double freeRadius(const std::vector<cv::Point2f>& centers, std::size_t i)
{
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < centers.size(); ++k)
  {
    nearest = k == i ? nearest : std::min(nearest, cv::norm(centers[k] - centers[i]));
  }
  return 0.5 * nearest;
}

}  // namespace

void findCircleGrid(const cv::Mat& grey8, const BoardDescription& board, BoardDetection& detection)
{
  const cv::Size size(board.columns, board.rows);
  const int grid = board.kind == BoardDescription::Kind::Circles ? cv::CALIB_CB_SYMMETRIC_GRID : cv::CALIB_CB_ASYMMETRIC_GRID;
  const cv::Ptr<cv::FeatureDetector> blobs = makeBlobDetector(grey8.size(), board.pointCount());
  std::vector<cv::Point2f> centers;
  const bool isFound = cv::findCirclesGrid(grey8, size, centers, grid, blobs) ||
    cv::findCirclesGrid(grey8, size, centers, grid | cv::CALIB_CB_CLUSTERING, blobs);
  if (!isFound || int(centers.size()) != board.pointCount())
  {
    detection.message =
      "no grid of " + std::to_string(board.columns) + " x " + std::to_string(board.rows) + " circles is seen as a whole";
    return;
  }
  std::vector<Eigen::Vector2d> found;
  for (std::size_t i = 0; i < centers.size(); ++i)
  {
    found.push_back(centroid(grey8, { centers[i].x, centers[i].y }, freeRadius(centers, i)));
  }
  detection.points_Image = numberGrid(found, board, {});
  if (detection.points_Image.empty())
  {
    detection.status = BoardDetection::Status::WrongBoard;
    detection.message = "the circles do not lie as the board's description says";
    return;
  }
  for (int id = 0; id < board.pointCount(); ++id)
  {
    detection.ids.push_back(id);
  }
  detection.status = BoardDetection::Status::Ok;
  detection.message = "all " + std::to_string(detection.ids.size()) + " circles";
}

}  // namespace handeye
