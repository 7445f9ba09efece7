// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeCalibration.h"
#include "MethodComparison.h"

#include <vector>

namespace handeye
{

/// One capture of the ball as the methods take it.
struct BallCapture
{
  std::vector<HandEyeSample> samples;           ///< by our segmentation
  std::vector<HandEyeSample> publishedSamples;  ///< by the paper's (HSV threshold, Hough circle); empty: not looked at
};

/// The methods that calibrate with the ball: ours (`ml`, `global`), the paper's iteration (`procrustes`) on the same samples, the
/// paper's whole pipeline (`as-published`: its segmentation, its iteration, no sample left out) where there are samples of it, and
/// the peers that solve the same problem as a perspective-n-point one (`oi`, `ppnp`, `epnp`, `sqpnp`, `iterative`).
///
/// Random subsets are drawn from the samples that `ml` keeps of the whole first capture, so that a wrong sample does not decide
/// about small ones; they are judged by their outcome, not refused for being uncertain.
///
/// @param options noise and consensus; `method` is each method's own
[[nodiscard]] std::vector<ComparedMethod> ballMethods(
  const std::vector<BallCapture>& captures, const CameraModel& camera, const HandEyeCalibrationOptions& options = {});

/// The answer of a calibration with the ball.
[[nodiscard]] MethodAnswer toAnswer(const HandEyeCalibrationResult& calibration, int sampleCount, double seconds);

}  // namespace handeye
