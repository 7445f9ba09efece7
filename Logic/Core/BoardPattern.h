// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardDescription.h"

#include <Eigen/Core>

#include <vector>

namespace handeye
{

/// What is printed on a board: black areas on white paper.
///
/// Frame `Board` (mm). A drawing of the whole sheet needs nothing else: a printer and the simulated camera both use it.
/// Immutable, thread-safe.
class BoardPattern
{
public:
  struct Rectangle
  {
    Eigen::Vector2d lower_Board;  ///< the corner with the smaller coordinates
    Eigen::Vector2d upper_Board;
  };
  struct Circle
  {
    Eigen::Vector2d center_Board;
    double radiusMm = 0;
  };

  /// @throws std::invalid_argument as BoardDescription::check()
  explicit BoardPattern(const BoardDescription& board);

  const std::vector<Rectangle>& blackRectangles() const { return rectangles_; }
  const std::vector<Circle>& blackCircles() const { return circles_; }

  /// The pattern without, and the sheet with, the white margin that the detectors need (one square or spacing).
  const Rectangle& pattern() const { return pattern_; }
  const Rectangle& sheet() const { return sheet_; }

  /// Whether the board is black here; false outside of the pattern.
  bool isBlack(const Eigen::Vector2d& point_Board) const;

private:
  void fillGrid();

  std::vector<Rectangle> rectangles_;
  std::vector<Circle> circles_;
  Rectangle pattern_;
  Rectangle sheet_;
  double cellMm_ = 0;  ///< of the grid in which isBlack() looks things up
  int gridColumns_ = 0;
  std::vector<std::vector<int>> grid_;  ///< indices of rectangles, then of circles
};

/// The diameter of a circle grid's circles as we print them, mm; 0 for other boards.
double printedCircleDiameterMm(const BoardDescription& board);

}  // namespace handeye
