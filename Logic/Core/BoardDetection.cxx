// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardDetection.h"

#include "BoardDictionary.h"
#include "BoardEdges.h"
#include "BoardFinders.h"

#include <opencv2/imgproc.hpp>

namespace handeye
{

namespace
{

cv::Mat toGrey8(const cv::Mat& image)
{
  if (image.empty() || (image.depth() != CV_8U && image.depth() != CV_16U))
  {
    throw std::invalid_argument("detectBoard: an image with 8 or 16 bits is expected");
  }
  cv::Mat grey = image;
  if (image.channels() != 1)
  {
    cv::cvtColor(image, grey, image.channels() == 4 ? cv::COLOR_BGRA2GRAY : cv::COLOR_BGR2GRAY);
  }
  if (grey.depth() == CV_16U)
  {
    // As bright as it gets: 10 or 12 bits in 16 would be black otherwise.
    cv::normalize(grey, grey, 0, 255, cv::NORM_MINMAX, CV_8U);
  }
  return grey;
}

/// The terms of a polynomial of third order, board coordinates scaled to about 1.
Eigen::Matrix<double, 1, 10> cubicTerms(double x, double y)
{
  Eigen::Matrix<double, 1, 10> terms;
  terms << 1, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
  return terms;
}

/// How far each point is from where the others put it: a homography, and a polynomial on what that leaves.
std::vector<double> misplacements(const BoardDetection& detection)
{
  std::vector<cv::Point2f> from, to;
  double scale = 1e-9;
  for (std::size_t i = 0; i < detection.ids.size(); ++i)
  {
    from.emplace_back(float(detection.points_Board[i].x()), float(detection.points_Board[i].y()));
    to.emplace_back(float(detection.points_Image[i].x()), float(detection.points_Image[i].y()));
    scale = std::max(scale, detection.points_Board[i].norm());
  }
  const cv::Mat homography = fitHomography(from, to);
  if (homography.empty())
  {
    return std::vector<double>(from.size(), std::numeric_limits<double>::infinity());
  }
  std::vector<cv::Point2f> mapped;
  cv::perspectiveTransform(from, mapped, homography);
  const Eigen::Index count = Eigen::Index(from.size());
  Eigen::MatrixXd rest(count, 2), terms(count, 10);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    const cv::Point2f difference = to[std::size_t(i)] - mapped[std::size_t(i)];
    rest.row(i) << difference.x, difference.y;
    const Eigen::Vector3d& point = detection.points_Board[std::size_t(i)];
    terms.row(i) = cubicTerms(point.x() / scale, point.y() / scale);
  }
  if (count >= 20)
  {
    rest -= terms * terms.colPivHouseholderQr().solve(rest);
  }
  std::vector<double> lengths;
  for (Eigen::Index i = 0; i < count; ++i)
  {
    lengths.push_back(rest.row(i).norm());
  }
  return lengths;
}

/// The distance (px) of a point from the nearest one of its board.
double neighbourDistance(const BoardDetection& detection, std::size_t i)
{
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < detection.ids.size(); ++k)
  {
    nearest = k == i ? nearest : std::min(nearest, (detection.points_Image[k] - detection.points_Image[i]).norm());
  }
  return nearest;
}

void judgePlaces(const BoardDetectionOptions& options, BoardDetection& detection)
{
  const std::vector<double> distances = misplacements(detection);
  for (std::size_t i = 0; i < distances.size(); ++i)
  {
    if (!(distances[i] <= options.maximumMisplacement * neighbourDistance(detection, i)))
    {
      detection.status = BoardDetection::Status::WrongBoard;
      detection.message = "the points do not lie as the board's description says: its columns, rows or sizes are others";
      return;
    }
  }
}

}  // namespace

void BoardDetectionOptions::check() const
{
  if (minimumPoints < 4)
  {
    throw std::invalid_argument("BoardDetectionOptions: minimumPoints is at least 4");
  }
  if (!(maximumMisplacement > 0))
  {
    throw std::invalid_argument("BoardDetectionOptions: maximumMisplacement is a positive number");
  }
}

BoardDetection detectBoard(const cv::Mat& image, const BoardDescription& board, const BoardDetectionOptions& options)
{
  board.check();
  options.check();
  const cv::Mat grey = toGrey8(image);
  BoardDetection detection;
  switch (board.kind)
  {
    case BoardDescription::Kind::Chessboard:
      findChessboard(grey, board, detection);
      break;
    case BoardDescription::Kind::Charuco:
      findCharuco(grey, board, options.minimumPoints, detection);
      break;
    case BoardDescription::Kind::Circles:
    case BoardDescription::Kind::AsymmetricCircles:
      findCircleGrid(grey, board, detection);
      break;
  }
  if (!detection.isUsable())
  {
    return detection;
  }
  for (const int id : detection.ids)
  {
    detection.points_Board.push_back(boardPoint(board, id));
  }
  judgePlaces(options, detection);
  detection.edgeWidthPx = measureEdgeWidth(grey, board, detection);
  return detection;
}

std::string toString(BoardDetection::Status status)
{
  switch (status)
  {
    case BoardDetection::Status::Ok:
      return "ok";
    case BoardDetection::Status::NotFound:
      return "not_found";
    case BoardDetection::Status::TooFewPoints:
      return "too_few_points";
    case BoardDetection::Status::WrongBoard:
      return "wrong_board";
  }
  return "unknown";
}

}  // namespace handeye
