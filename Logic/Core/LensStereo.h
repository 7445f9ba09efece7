// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LensCalibration.h"

namespace handeye
{

/// Two lenses and how they stand to each other.
struct StereoLensResult
{
  enum class Status
  {
    Ok,
    LensFailed,   ///< one of the lenses: see `left` and `right`
    TooFewPairs,  ///< too few moments at which both saw enough of the board
    Disagreement  ///< the pairs do not share one transform: the pictures are not of the same moments, or the eyes moved
  };

  Status status = Status::TooFewPairs;
  std::string message;  ///< for a person, verdict first
  LensCalibrationResult left;
  LensCalibrationResult right;
  /// p_RightCamera = leftToRight * p_LeftCamera, mm; only if usable
  Eigen::Isometry3d leftToRight = Eigen::Isometry3d::Identity();
  /// Of (rotation vector rad, translation mm) acting from the left in the right camera's frame, from the scatter of the pairs.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<int> frames;        ///< of the pairs that were used
  std::vector<double> pairRmsPx;  ///< one per pair
  double rmsPx = 0;

  bool isUsable() const { return status == Status::Ok; }
};

/// Calibrates both eyes and their relation. Views with the same `frame` are of the same moment.
/// @throws std::invalid_argument as calibrateLens()
/// Thread-safe, deterministic.
[[nodiscard]] StereoLensResult calibrateStereoLens(const std::vector<LensView>& leftViews, int leftWidth, int leftHeight,
  const std::vector<LensView>& rightViews, int rightWidth, int rightHeight, const LensCalibrationOptions& options = {});

/// "ok", "lens_failed", ...: the word that result files use.
std::string toString(StereoLensResult::Status status);

}  // namespace handeye
