// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LensCalibration.h"
#include "Statistics.h"

#include <functional>

namespace handeye
{

struct LensRepetitionOptions
{
  int repetitions = 10;
  double viewShare = 0.6;  ///< of the views, drawn anew each time
  unsigned seed = 1;

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// The same lens calibrated again and again, each time from other views.
struct LensRepetition
{
  std::vector<LensCalibrationResult> results;  ///< those that were usable
  int failedCount = 0;
  Summary fx, fy, cx, cy;             ///< px
  std::vector<Summary> coefficients;  ///< in their order
  /// How far (px) the repeated lenses see the rays from where the lens of all views sees them, over a grid of the image: what the
  /// spread of the parameters, which hide each other, comes to.
  double meanShiftPx = 0;
  double maximumShiftPx = 0;
};

/// Calibrates from random parts of the views and says how much the lens varies.
/// @param progress (done, total), may be empty; false cancels
/// @throws std::invalid_argument as calibrateLens()
/// Thread-safe, deterministic.
[[nodiscard]] LensRepetition repeatLensCalibration(const std::vector<LensView>& views, int width, int height,
  const LensCalibrationOptions& options = {}, const LensRepetitionOptions& repetition = {},
  const std::function<bool(int, int)>& progress = {});

}  // namespace handeye
