// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardDescription.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace cv
{
class Mat;
}

namespace handeye
{

struct BoardDetectionOptions
{
  /// A ChArUco board that is seen in part needs so many corners; other boards are seen whole or not at all.
  int minimumPoints = 6;
  /// A point further than this share of the distance to its neighbours from where the others put it is no point of this board.
  double maximumMisplacement = 0.2;

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// The points of a board in one picture.
struct BoardDetection
{
  enum class Status
  {
    Ok,
    NotFound,      ///< no board, or one of which a part is hidden that has to be seen
    TooFewPoints,  ///< a ChArUco board of which too little is seen
    WrongBoard     ///< a board with other markers, or whose points do not lie as described
  };

  Status status = Status::NotFound;
  std::string message;                        ///< for a person
  std::vector<int> ids;                       ///< numbers of the points, ascending
  std::vector<Eigen::Vector2d> points_Image;  ///< one per id, px of the recorded (distorted) image, integers being pixel centres
  std::vector<Eigen::Vector3d> points_Board;  ///< one per id, mm
  /// How far the picture's edges are blurred: 10 to 90 % of a black-white step across the board's lines, px (median). A sharp
  /// picture
  /// has 1.5 to 2.5; 0 where it could not be measured.
  double edgeWidthPx = 0;

  bool isUsable() const { return status == Status::Ok; }
};

/// Finds a board.
///
/// Chessboards by OpenCV's sector-based detector, circles by its grid finder, ChArUco by its markers and refined corners; the
/// numbering follows the board's colours, so that a point has the same number in every picture (but for boards that
/// looksTheSameTurned()). Points that do not lie as the board says are no detection: a polynomial map of third order from the board
/// to the image, which has room for perspective and lens, must place every one.
///
/// The centre of a circle's picture is not the picture of its centre; estimateBoardPose() and calibrateLens() allow for it where
/// they are told the circles' diameter.
///
/// @param image 8 or 16 bits; grey, BGR or BGRA
/// @throws std::invalid_argument for an empty image or another depth, and as BoardDescription::check()
/// Thread-safe.
[[nodiscard]] BoardDetection detectBoard(
  const cv::Mat& image, const BoardDescription& board, const BoardDetectionOptions& options = {});

/// "ok", "not_found", ...: the word that result files use.
std::string toString(BoardDetection::Status status);

}  // namespace handeye
