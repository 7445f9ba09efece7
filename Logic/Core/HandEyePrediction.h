// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeCalibration.h"

#include <Eigen/Core>

#include <optional>

namespace handeye
{

/// What the covariance of a hand-eye calibration says of the points that are mapped with it.
///
/// A motion (w, v) from the left moves p_Camera by  w x p_Camera + v = motionJacobian(p_Camera) * (w, v); a covariance C of
/// (rotation vector rad, translation mm) therefore gives p_Camera the covariance J C J^T. Errors are root mean squares over all
/// directions, one number for the 3 (mm) or 2 (px) axes together. All functions are thread-safe and throw nothing.
/// Reference: Ma, Chen and Peters, "On the accuracy of hand-eye calibration with a target registration error model", Int J CARS
/// 11:889 (2016): the first-order propagation.

using Covariance6 = Eigen::Matrix<double, 6, 6>;

/// The covariance of a pose error in another frame. The error (w, v) is a small motion from the left, p_From -> exp(w) p_From +
/// v; seen from the other frame it is the motion (R w, R v + t x R w), with R and t of `fromToTo` (mm).
/// @param covariance_From of (rotation vector rad, translation mm) @return the same in the frame To
Covariance6 poseCovarianceIn(const Eigen::Isometry3d& fromToTo, const Covariance6& covariance_From);

/// [-skew(p), I]
Eigen::Matrix<double, 3, 6> motionJacobian(const Eigen::Vector3d& point_Camera);

/// Covariance (mm^2) of a mapped point, and the target registration error (mm), the root of its trace.
Eigen::Matrix3d predictTargetCovariance(const Covariance6& covariance, const Eigen::Vector3d& point_Camera);
double predictTargetErrorMm(const Covariance6& covariance, const Eigen::Vector3d& point_Camera);

/// The point (mm, head's camera frame) that an eye sees at a pixel, at this depth (mm, z of the eye); nothing outside of the lens
/// model.
std::optional<Eigen::Vector3d> pointSeenAt(const Eye& eye, const Eigen::Vector2d& pixel, double depthMm);

/// Derivative of an eye's pixel by a motion from the left of the head's camera frame; nothing where the point is not seen.
std::optional<Eigen::Matrix<double, 2, 6>> pixelJacobian(const Eye& eye, const Eigen::Vector3d& point_Camera);

/// Projection error (px) at a pixel and a depth; nothing outside of the lens model.
std::optional<double> predictProjectionErrorPx(
  const Covariance6& covariance, const Eye& eye, const Eigen::Vector2d& pixel, double depthMm);

/// Both errors over an eye's image between two depths (mm), on a grid of 9 x 7 pixels and 5 depths.
PredictedError predictError(const Covariance6& covariance, const Eye& eye, double nearestMm, double furthestMm);

/// The combination of turns and shifts that a covariance leaves most uncertain at a depth (mm), in words: "pitch together with a
/// vertical shift (0.12 deg, 0.8 mm)".
std::string describeWeakestFreedom(const Covariance6& covariance, double depthMm);

}  // namespace handeye
