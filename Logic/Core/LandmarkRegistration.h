// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace handeye
{

struct LandmarkRegistrationOptions
{
  /// One positive number per landmark, 1 / variance for the most likely registration; only their ratios matter. Empty: all alike.
  std::vector<double> weights;
  /// Where the registration's error is predicted (mm, Model), beside the landmarks themselves: where it will be used.
  std::vector<Eigen::Vector3d> targets_Model;
  /// Root mean square error (mm) with which a landmark of weight 1 is touched. 0: estimated from the residuals, which are few.
  double localizationErrorMm = 0;
  /// Larger residuals (mm, root mean square) are no registration of anatomy that was touched with care.
  double largestRmsMm = 3;
  /// Whether other orders of touching are tried; up to this many landmarks.
  int largestReorderedCount = 12;

  /// @param count of the landmarks @throws std::invalid_argument with a sentence where a number makes no sense
  void check(std::size_t count) const;
};

/// What is left without one of the landmarks.
struct LandmarkLeftOut
{
  double rmsMm = 0;   ///< root mean square residual of the others, registered without it
  double missMm = 0;  ///< how far the touched landmark is from where the others put it
};

struct LandmarkRegistrationResult
{
  enum class Status
  {
    Ok,
    TooFewPoints,  ///< fewer than 3
    Collinear,     ///< the points of one side lie on one line or in one place
    PoorFit,       ///< the touched points are not where the model has them: wrong unit, a slip
    WrongOrder,    ///< they are, in another order
    Mirrored       ///< the touched points are the model's mirror image: wrong order or wrong model
  };

  Status status = Status::TooFewPoints;
  std::string message;                                               ///< for a person
  Eigen::Isometry3d modelToPhantom = Eigen::Isometry3d::Identity();  ///< p_Phantom = modelToPhantom * p_Model; only if usable
  std::vector<double> residualsMm;                                   ///< fiducial registration error of each landmark
  double rmsMm = 0;                                                  ///< root mean square of the residuals
  double localizationErrorMm = 0;        ///< root mean square error of touching a landmark of weight 1: given, or estimated
  std::vector<double> landmarkTreMm;     ///< predicted target registration error (root mean square) at each landmark
  std::vector<double> targetTreMm;       ///< the same at each target
  std::vector<LandmarkLeftOut> leftOut;  ///< one per landmark, from 4 landmarks on
  int worst = -1;                        ///< the landmark without which the residuals are least; -1 for fewer than 4
  /// Another order that fits, if there is one: touched point suggestedOrder[i] belongs to landmark i. With WrongOrder it
  /// explains the misfit; with Ok it fits about as well, so that the landmarks are too symmetric for the order to be checked.
  std::vector<int> suggestedOrder;
  double suggestedRmsMm = 0;
  bool suggestionIsUnique = false;  ///< no third order fits about as well

  bool isUsable() const { return status == Status::Ok; }
};

/// Registers paired landmarks: the rotation and translation that bring the model's points onto the touched ones with the least
/// (weighted) squares.
///
/// Residuals say how well the landmarks fit, not how far off a target will be. That is predicted by carrying the error of touching,
/// with the residuals' root mean square FRE and FLE^2 = FRE^2 n / (n - 2), through the registration: with equal weights
/// TRE^2(r) = FLE^2 / n (1 + 1/3 sum_k d_k^2 / f_k^2), d_k the target's distance from principal axis k of the landmarks and f_k
/// their root mean square distance from it; with weights by the covariance of the six parameters.
///
/// A fit of more than `largestRmsMm` is not usable; its message offers the order that fits, if the landmarks were touched in
/// another one, or names the landmark whose leaving out helps most.
///
/// That the two lists were exchanged cannot be seen from them: the result is then the inverse, with the same residuals.
///
/// @param points_Model,points_Phantom the same landmarks in the same order, mm
/// @throws std::invalid_argument if the counts differ, a number is not finite, or the options do not check
/// Thread-safe.
/// References: S. Umeyama, IEEE PAMI 13:376 (1991), eq. 40-42 without scale; J. Fitzpatrick, J. West, C. Maurer, IEEE TMI
/// 17:694 (1998), for FLE and TRE.
[[nodiscard]] LandmarkRegistrationResult registerLandmarks(const std::vector<Eigen::Vector3d>& points_Model,
  const std::vector<Eigen::Vector3d>& points_Phantom, const LandmarkRegistrationOptions& options = {});

/// The touched points in the order that a result suggests.
std::vector<Eigen::Vector3d> reordered(const std::vector<Eigen::Vector3d>& points_Phantom, const std::vector<int>& order);

/// "ok", "too_few_points", ...: the word that result files use.
std::string toString(LandmarkRegistrationResult::Status status);

}  // namespace handeye
