// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeCalibration.h"

#include <optional>
#include <vector>

namespace handeye
{

/// What the parts of the hand-eye calibration share: samples as points and lines, their residuals and what is expected of them.
/// Internal.

using HandEyeSamples = std::vector<HandEyeSample>;
using Eyes = std::vector<Eye>;

/// A sample as point and line, the line in the head's camera frame.
PointLinePair toPair(const HandEyeSample& sample, const Eyes& eyes, double weight);

/// Between the projected tip and the segmented ball; very large for a tip behind the camera or outside of the lens model.
double residualPx(const HandEyeSample& sample, const Eyes& eyes, const Eigen::Isometry3d& markerToCamera);

/// Of the tip from its eye.
double distanceMm(const HandEyeSample& sample, const Eyes& eyes, const Eigen::Isometry3d& markerToCamera);

/// The expected error (one standard deviation per axis) of a sample at this distance: at the ball (mm), and in the image (px).
double expectedMm(const HandEyeSample& sample, double distance, const Eyes& eyes, const HandEyeCalibrationOptions& options);
double expectedPx(const HandEyeSample& sample, double distance, const Eyes& eyes, const HandEyeCalibrationOptions& options);

/// Residuals (px) of all samples in multiples of what is expected of them.
std::vector<double> normalizedResiduals(const HandEyeSamples& samples, const Eyes& eyes, const Eigen::Isometry3d& markerToCamera,
  const HandEyeCalibrationOptions& options);

/// One sample at a solution, in its eye's image.
struct HandEyeTerm
{
  Eigen::Vector2d residualPx = Eigen::Vector2d::Zero();                       ///< projected tip minus segmented ball
  Eigen::Matrix<double, 2, 3> byPoint = Eigen::Matrix<double, 2, 3>::Zero();  ///< derivative by tip_Camera
  Eigen::Matrix<double, 2, 6> byPose = Eigen::Matrix<double, 2, 6>::Zero();   ///< by a motion from the left
  double sigmaPx = 0;                                                         ///< of the segmentation
  Eigen::Matrix2d covariancePx = Eigen::Matrix2d::Identity();                 ///< that is expected of the residual
};

/// Nothing where the tip is not seen.
std::optional<HandEyeTerm> handEyeTerm(
  const HandEyeSample& sample, const Eyes& eyes, const Eigen::Isometry3d& markerToCamera, const HandEyeCalibrationOptions& options);

/// Mean of fx and fy.
double focalLength(const CameraModel& camera);

/// How often the calibration renews its weights.
constexpr int HandEyeWeightRounds = 4;

/// The solution of some of the samples; weights follow the distances that the solution itself gives.
/// @param weightRounds how often the weights are renewed; 0 for equal weights
/// @param findRivals see PointLineOptions
PointLineResult solveHandEye(const HandEyeSamples& samples, const std::vector<int>& subset, const Eyes& eyes,
  const HandEyeCalibrationOptions& options, PointLineOptions::Method method, int weightRounds, bool findRivals = false);

}  // namespace handeye
