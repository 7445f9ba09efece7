// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

namespace handeye
{

/// A flat calibration board with points whose places are known.
///
/// Frame `Board` (mm): the origin is point 0, x runs along the columns to the right and y along the rows downwards, as the board is
/// printed; z points into the board, so that a board that is looked at squarely has all its axes along those of `Camera`. Points
/// are numbered row by row: 0, 1, ... columns - 1, then the next row.
///
///     chessboard:COLSxROWS:SQUARE_MM                     the inner corners, COLS x ROWS of them
///     charuco:COLSxROWS:SQUARE_MM:MARKER_MM:DICTIONARY   COLS x ROWS squares: (COLS - 1) x (ROWS - 1) corners
///     circles:COLSxROWS:SPACING_MM                       the centres of black circles
///     acircles:COLSxROWS:SPACING_MM                      those of circles at (2 column + row % 2, row) times SPACING_MM
///
/// The asymmetric grid is OpenCV's: neighbours in a row are two spacings apart. Circles have a diameter of half a spacing
/// (`circles`) or of one spacing (`acircles`) when they are printed by us; any other does for reading.
struct BoardDescription
{
  enum class Kind
  {
    Chessboard,
    Charuco,
    Circles,
    AsymmetricCircles
  };

  Kind kind = Kind::Chessboard;
  int columns = 9;
  int rows = 6;
  double spacingMm = 25;  ///< side of a square, or the spacing of circles
  double markerMm = 0;    ///< side of an ArUco marker, of `Charuco`
  std::string
    dictionary;  ///< of `Charuco`: OpenCV's name without the prefix, "4X4_50" ... "7X7_1000", "ARUCO_ORIGINAL", "APRILTAG_36H11"

  /// @throws std::invalid_argument with a sentence where a number makes no sense or the dictionary is unknown or too small
  void check() const;

  int pointColumns() const { return kind == Kind::Charuco ? columns - 1 : columns; }
  int pointRows() const { return kind == Kind::Charuco ? rows - 1 : rows; }
  int pointCount() const { return this->pointColumns() * this->pointRows(); }

  /// Whether half a turn leaves the points' pattern as it is, so that a picture does not say which end is which: chessboards whose
  /// counts are both even or both odd, symmetric circles, asymmetric circles with an even number of rows. Good for a lens, not
  /// for a
  /// hand-eye calibration on its own: see resolveHalfTurns().
  bool looksTheSameTurned() const;
};

/// Where a point is, mm; z is 0. @throws std::out_of_range for a point that there is not
Eigen::Vector3d boardPoint(const BoardDescription& board, int id);

/// All of them, in order of their numbers.
std::vector<Eigen::Vector3d> boardPoints(const BoardDescription& board);

/// The middle of all points, mm.
Eigen::Vector3d boardCenter(const BoardDescription& board);

/// A board by its text: "chessboard:9x6:25", "charuco:8x6:30:22:DICT_4X4_250", "circles:7x6:20", "acircles:4x11:15".
/// @throws std::invalid_argument with a sentence that names the part of the text and what was expected there
BoardDescription parseBoard(const std::string& text);

/// The text that parseBoard() reads back.
std::string toString(const BoardDescription& board);

/// The names of the dictionaries: "DICT_4X4_50", ...
std::vector<std::string> arucoDictionaryNames();

}  // namespace handeye
