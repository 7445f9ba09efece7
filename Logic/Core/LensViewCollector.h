// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LensCalibration.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace handeye
{

struct LensViewCollectorOptions
{
  /// The board's points must not have moved by more than this (px, median) since the last picture...
  double stillnessPx = 1.0;
  /// ...nor for so many pictures in a row. 1: every picture counts, as in a folder of photographs.
  int stillFrames = 3;
  /// Edges that are blurred more than this (px, 10 to 90 %) are not sharp.
  double maximumEdgeWidthPx = 5;
  /// A view is new when it differs from every one that was taken: its points by this share of the image's diagonal (median)...
  double newPlaceShare = 0.06;
  /// ...or the board's tilt by this angle (rad).
  double newTiltRad = 0.15;
  int coverageColumns = 8;
  int coverageRows = 6;
  int wantedViews = 20;
  int maximumViews = 60;
  /// Complete when this share of the coverage map has points, and the tilts are there.
  double wantedCoverage = 0.8;

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// What became of a picture.
struct LensViewVerdict
{
  enum class Status
  {
    Taken,
    NoBoard,  ///< see the detection's own message
    Moving,
    Blurred,
    NotNew,  ///< much like one that was taken
    Full     ///< as many views as are of use
  };

  Status status = Status::NoBoard;
  std::string message;  ///< a few words for the person who holds the board
  bool isTaken() const { return status == Status::Taken; }
};

/// Takes views of a board for the lens hands-free: when the board is sharp, still, and stands in a new place or a new way.
///
/// Feed it the detection of each picture in order, live or from a recording. The coverage map says where in the image points have
/// been seen and which way the board was tilted; hint() says what to do next. The tilt is judged with a lens of a typical opening
/// angle until there are enough views for a better guess, which is good enough for "left", "right", "towards you".
///
/// Not thread-safe.
class LensViewCollector
{
public:
  /// @throws std::invalid_argument as LensViewCollectorOptions::check(), or for a size that is not positive
  LensViewCollector(int width, int height, const LensViewCollectorOptions& options = {});

  /// One picture. @param frame passed through to the view
  LensViewVerdict add(int frame, const BoardDetection& detection);

  const std::vector<LensView>& views() const { return views_; }
  /// Takes one back, for a person who does not like it; @throws std::out_of_range
  void remove(int index);
  void clear();

  /// Points seen per cell, rows from the top: coverageRows x coverageColumns.
  const Eigen::MatrixXi& coverage() const { return coverage_; }
  /// Share of the cells that have points.
  double coverageShare() const;

  /// Ways the board has been tilted, by which of its sides is nearer to the camera.
  struct Tilts
  {
    int square = 0;  ///< not tilted by 10 degrees
    int left = 0;
    int right = 0;
    int top = 0;
    int bottom = 0;
  };
  Tilts tilts() const;

  /// How much of what is wanted is there, 0 to 1: views, coverage and tilts, the least of the three.
  double completeness() const;
  bool isComplete() const { return this->completeness() >= 1; }

  /// What to do next, in one sentence: "Hold the board into the upper left corner."
  std::string hint() const;

private:
  struct Attitude
  {
    Eigen::Vector3d normal_Camera = Eigen::Vector3d::UnitZ();
  };

  bool isNew(const LensView& view, const Attitude& attitude) const;
  std::optional<Attitude> attitudeOf(const LensView& view) const;
  void count(const LensView& view, int sign);

  int width_;
  int height_;
  LensViewCollectorOptions options_;
  std::vector<LensView> views_;
  std::vector<Attitude> attitudes_;
  Eigen::MatrixXi coverage_;
  LensView last_;
  int stillCount_ = 0;
};

/// "taken", "no_board", ...: the word that result files use.
std::string toString(LensViewVerdict::Status status);

}  // namespace handeye
