// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardPattern.h"

#include "BoardDictionary.h"

namespace handeye
{

namespace
{

using Rectangle = BoardPattern::Rectangle;
using Circle = BoardPattern::Circle;

/// Squares from the outer corner (-s, -s), the first one black.
Rectangle square(const BoardDescription& board, int column, int row)
{
  const Eigen::Vector2d lower_Board((column - 1) * board.spacingMm, (row - 1) * board.spacingMm);
  return { lower_Board, lower_Board + Eigen::Vector2d::Constant(board.spacingMm) };
}

/// The black modules of a marker in the middle of its square, those beside each other in one.
void addMarker(const BoardDescription& board, int marker, const Rectangle& square, std::vector<Rectangle>& black)
{
  const cv::Mat modules = markerModules(board.dictionary, marker);
  const double side = board.markerMm / modules.rows;
  const Eigen::Vector2d origin = square.lower_Board + Eigen::Vector2d::Constant((board.spacingMm - board.markerMm) / 2);
  for (int row = 0; row < modules.rows; ++row)
  {
    for (int column = 0; column < modules.cols;)
    {
      int end = column;
      while (end < modules.cols && modules.at<uchar>(row, end) == 0)
      {
        ++end;
      }
      if (end > column)
      {
        black.push_back({ origin + side * Eigen::Vector2d(column, row), origin + side * Eigen::Vector2d(end, row + 1) });
      }
      column = std::max(end, column + 1);
    }
  }
}

bool isInside(const Rectangle& rectangle, const Eigen::Vector2d& point_Board)
{
  return (point_Board.array() >= rectangle.lower_Board.array()).all() &&
    (point_Board.array() < rectangle.upper_Board.array()).all();
}

}  // namespace

BoardPattern::BoardPattern(const BoardDescription& board)
{
  board.check();
  using Kind = BoardDescription::Kind;
  const double spacing = board.spacingMm;
  cellMm_ = spacing;
  if (board.kind == Kind::Chessboard || board.kind == Kind::Charuco)
  {
    const int columns = board.pointColumns() + 1, rows = board.pointRows() + 1;
    for (int i = 0, marker = 0; i < columns * rows; ++i)
    {
      const Rectangle place = square(board, i % columns, i / columns);
      if ((i % columns + i / columns) % 2 == 0)
      {
        rectangles_.push_back(place);
      }
      else if (board.kind == Kind::Charuco)
      {
        addMarker(board, marker++, place, rectangles_);
      }
    }
    pattern_ = { square(board, 0, 0).lower_Board, square(board, columns - 1, rows - 1).upper_Board };
  }
  else
  {
    const double radius = printedCircleDiameterMm(board) / 2;
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3d& center_Board : boardPoints(board))
    {
      circles_.push_back({ center_Board.head<2>(), radius });
      box.extend(center_Board.head<2>());
    }
    pattern_ = { box.min() - Eigen::Vector2d::Constant(radius), box.max() + Eigen::Vector2d::Constant(radius) };
  }
  sheet_ = { pattern_.lower_Board - Eigen::Vector2d::Constant(spacing), pattern_.upper_Board + Eigen::Vector2d::Constant(spacing) };
  this->fillGrid();
}

void BoardPattern::fillGrid()
{
  const Eigen::Vector2d size = sheet_.upper_Board - sheet_.lower_Board;
  gridColumns_ = int(std::ceil(size.x() / cellMm_)) + 1;
  grid_.resize(std::size_t(gridColumns_) * std::size_t(std::ceil(size.y() / cellMm_) + 1));
  const auto enter = [&](const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, int index)
  {
    const Eigen::Vector2i first = ((lower - sheet_.lower_Board) / cellMm_ - Eigen::Vector2d::Constant(1e-9)).cast<int>();
    const Eigen::Vector2i last = ((upper - sheet_.lower_Board) / cellMm_ + Eigen::Vector2d::Constant(1e-9)).cast<int>();
    for (int row = first.y(); row <= last.y(); ++row)
    {
      for (int column = first.x(); column <= last.x(); ++column)
      {
        grid_[std::size_t(row * gridColumns_ + column)].push_back(index);
      }
    }
  };
  for (std::size_t i = 0; i < rectangles_.size(); ++i)
  {
    enter(rectangles_[i].lower_Board, rectangles_[i].upper_Board, int(i));
  }
  for (std::size_t i = 0; i < circles_.size(); ++i)
  {
    const Eigen::Vector2d radius = Eigen::Vector2d::Constant(circles_[i].radiusMm);
    enter(circles_[i].center_Board - radius, circles_[i].center_Board + radius, int(rectangles_.size() + i));
  }
}

bool BoardPattern::isBlack(const Eigen::Vector2d& point_Board) const
{
  if (!isInside(pattern_, point_Board))
  {
    return false;
  }
  const Eigen::Vector2i cell = ((point_Board - sheet_.lower_Board) / cellMm_).cast<int>();
  for (const int index : grid_[std::size_t(cell.y() * gridColumns_ + cell.x())])
  {
    const std::size_t i = std::size_t(index), first = rectangles_.size();
    if (i < first ? isInside(rectangles_[i], point_Board)
                  : (circles_[i - first].center_Board - point_Board).norm() < circles_[i - first].radiusMm)
    {
      return true;
    }
  }
  return false;
}

double printedCircleDiameterMm(const BoardDescription& board)
{
  switch (board.kind)
  {
    case BoardDescription::Kind::Circles:
      return board.spacingMm / 2;
    case BoardDescription::Kind::AsymmetricCircles:
      return board.spacingMm;
    default:
      return 0;
  }
}

}  // namespace handeye
