// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace handeye
{

struct LandmarkRegistrationResult
{
  enum class Status
  {
    Ok,
    TooFewPoints,  ///< fewer than 3
    Collinear,     ///< the points of one side lie on one line or in one place
    PoorFit,       ///< the touched points are not where the model has them: wrong order, wrong unit, a slip
    Mirrored       ///< the touched points are the model's mirror image: wrong order or wrong model
  };

  Status status = Status::TooFewPoints;
  std::string message;                                               ///< for a person
  Eigen::Isometry3d modelToPhantom = Eigen::Isometry3d::Identity();  ///< p_Phantom = modelToPhantom * p_Model; only if usable
  std::vector<double> residualsMm;                                   ///< fiducial registration error of each landmark
  double rmsMm = 0;                                                  ///< root mean square of the residuals

  bool isUsable() const { return status == Status::Ok; }
};

/// Registers paired landmarks: the rotation and translation that bring the model's points onto the touched ones with the least
/// squares.
///
/// A fit of more than 3 mm RMS is not usable; its message names the landmark whose leaving out helps most.
///
/// @param points_Model,points_Phantom the same landmarks in the same order, mm
/// @throws std::invalid_argument if the counts differ or a number is not finite
/// Thread-safe.
/// Reference: S. Umeyama, IEEE PAMI 13:376 (1991), without scale.
[[nodiscard]] LandmarkRegistrationResult registerLandmarks(
  const std::vector<Eigen::Vector3d>& points_Model, const std::vector<Eigen::Vector3d>& points_Phantom);

/// "ok", "too_few_points", ...: the word that result files use.
std::string toString(LandmarkRegistrationResult::Status status);

}  // namespace handeye
