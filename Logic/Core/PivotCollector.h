// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "PivotCalibration.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <vector>

namespace handeye
{

struct PivotCollectorOptions
{
  PivotCalibrationOptions calibration;
  double enoughTipErrorMm = 0.1;                   ///< the predicted error of the tip below which no more poses are needed
  std::size_t capacity = 600;                      ///< poses that are kept
  double domeAngle = double(30 * EIGEN_PI / 180);  ///< rad: how far the shaft leans at the rim of the dome to be covered

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// Which parts of a dome of shaft directions have been visited: its middle, and two rings of eight sectors.
struct DomeCoverage
{
  static constexpr int Sectors = 8;
  static constexpr int Cells = 1 + 2 * Sectors;
  static constexpr int PosesEach = 3;     ///< from so many on a cell is covered
  static constexpr int EnoughCells = 12;  ///< with so many covered, poses that are all wrong in one way would not have agreed

  /// Kept poses in each: the middle, the inner ring and the outer ring, each counter-clockwise about the mean shaft.
  std::array<int, Cells> poses{};

  /// Share of the cells that have a pose.
  double share() const;

  /// Cells that are covered, and whether they are enough.
  int covered() const;
  bool isEnough() const { return covered() >= EnoughCells; }
};

/// Pivot calibration while the stylus is being pivoted: poses arrive one by one, and at any time there is an estimate, how good
/// it is, and what is missing.
///
/// Frames and equation are those of calibratePivot(), which makes the estimates from the poses that are kept. At most
/// `capacity` are: when it is full, poses of crowded orientations give way to those of rare ones, so that time spent in one
/// place costs nothing else. Poses that disagree with a usable estimate are counted, not kept; when they prevail, the tip has
/// moved, and the estimate is no longer enough. Memory does not grow with the stream.
///
/// Not safe to share between threads.
class PivotCollector
{
public:
  enum class Outcome
  {
    Kept,
    Redundant,  ///< its orientation is there often enough
    Repeated,   ///< bit for bit the pose before it: the tracker had nothing new to say
    Invalid,    ///< not tracked
    Disagrees   ///< it puts the tip elsewhere
  };

  /// `kept` are poses(); one that gave way to a rarer orientation is redundant, whatever add() said of it.
  struct Counts
  {
    long long kept = 0, redundant = 0, repeated = 0, invalid = 0, disagreeing = 0;

    long long total() const { return kept + redundant + repeated + invalid + disagreeing; }
  };

  /// @throws std::invalid_argument if the options do not check
  explicit PivotCollector(const PivotCollectorOptions& options = {});

  /// A tracked pose. One that holds a number that is not finite counts as invalid: a live stream is no caller's mistake.
  Outcome add(const Eigen::Isometry3d& stylusToTracker);

  /// The tracker did not see the stylus.
  Outcome addInvalid();

  const Counts& counts() const { return counts_; }
  const std::vector<Eigen::Isometry3d>& poses() const { return poses_; }

  /// The running estimate, which is renewed as poses come; its indices are those of the poses at the time.
  const PivotCalibrationResult& estimate() const { return estimate_; }

  /// From all poses that are kept now.
  PivotCalibrationResult calibrate() const;

  /// The counts as they are once such a result has left poses out: `kept` are those that it used.
  Counts countsWith(const PivotCalibrationResult& result) const;

  /// Root mean square distance (mm) that the tip of the estimate is expected to be off; infinite without a usable one.
  double predictedTipErrorMm() const;

  /// The poses of late disagree with the estimate: the tip slipped, or the divot moved.
  bool hasTipMoved() const;

  /// The estimate is usable, its predicted error below the limit, and the tip where it was.
  bool isEnough() const;

  DomeCoverage coverage() const;

  /// Forgets everything: another stylus, another divot.
  void reset();

private:
  bool disagrees(const Eigen::Isometry3d& stylusToTracker) const;
  Outcome keep(const Eigen::Isometry3d& stylusToTracker);
  void renew();
  void dropRejected();

  PivotCollectorOptions options_;
  std::vector<Eigen::Isometry3d> poses_;
  std::vector<std::uint16_t> crowd_;  ///< kept poses by orientation
  Counts counts_;
  PivotCalibrationResult estimate_;
  Eigen::Isometry3d last_ = Eigen::Isometry3d::Identity();
  bool hasLast_ = false;
  std::size_t changes_ = 0;   ///< since the estimate
  double disagreement_ = 0;   ///< share of late
  std::uint32_t random_ = 1;  ///< state of the choice of who gives way
};

}  // namespace handeye
