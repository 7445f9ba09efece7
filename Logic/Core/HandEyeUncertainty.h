// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeResiduals.h"

namespace handeye
{

/// The covariance that the expected noise gives the solution of the chosen method, scaled by the scatter that was found where that
/// is clearly more. The tracker's error is common to the samples of one place, the segmentation's to those of one eye there, the
/// tip's to all of them; a scatter well above the expected noise is taken to be systematic: it does not average out. Stored in the
/// result, whose samples must be filled in. Internal.
/// @return the scatter in multiples of what was expected
double estimateCovariance(
  const HandEyeSamples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, HandEyeCalibrationResult& result);

/// For each sample the first used sample of its place of the ball; samples are of one place if their tips are within 2 mm of that
/// one's. -1 for samples that are not used.
std::vector<int> placesOf(const HandEyeSamples& samples, const std::vector<int>& used);

/// How the chosen method weights a residual: by the inverse of its covariance, of its size, or of what a pixel is at its distance.
Eigen::Matrix2d weightOf(
  const HandEyeTerm& term, double distance, const CameraModel& camera, const HandEyeCalibrationOptions& options);

/// The indices of the used samples.
std::vector<int> usedIndices(const HandEyeCalibrationResult& result);

}  // namespace handeye
