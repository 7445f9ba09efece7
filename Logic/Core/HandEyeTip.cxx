// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeTip.h"

#include "HandEyeUncertainty.h"
#include "NumberWords.h"
#include "RigidTransform.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Vector9 = Eigen::Matrix<double, 9, 1>;

constexpr int Rounds = 15;
/// A tip (mm per axis) of which nothing is known.
constexpr double UnknownTipMm = 1;

Eigen::Matrix3d priorCovariance(const HandEyeCalibrationOptions& options)
{
  const double smallest = 1e-6;
  const Eigen::Matrix3d& given = options.tipCovariance_Stylus;
  return given.isZero(0) ? Eigen::Matrix3d(UnknownTipMm * UnknownTipMm * Eigen::Matrix3d::Identity())
                         : Eigen::Matrix3d(given + smallest * Eigen::Matrix3d::Identity());
}

struct Normal
{
  Matrix9 matrix = Matrix9::Zero();  ///< pose, then tip; of the data alone
  Vector9 right = Vector9::Zero();
};

Normal normalEquations(const HandEyeSamples& samples, const std::vector<int>& used, const Eyes& eyes,
  const HandEyeCalibrationOptions& options, const Eigen::Isometry3d& markerToCamera, const Eigen::Vector3d& correction_Stylus)
{
  Normal normal;
  for (int i : used)
  {
    HandEyeSample sample = samples[std::size_t(i)];
    sample.tip_Marker += sample.stylusToMarker * correction_Stylus;
    const std::optional<HandEyeTerm> term = handEyeTerm(sample, eyes, markerToCamera, options);
    if (!term)
    {
      continue;
    }
    const Eigen::Matrix3d stylusToCamera = markerToCamera.linear() * sample.stylusToMarker;
    Eigen::Matrix<double, 2, 9> slope;
    slope << term->byPose, term->byPoint * stylusToCamera;
    const Eigen::Matrix<double, 9, 2> weighted = slope.transpose() * term->covariancePx.inverse();
    normal.matrix += weighted * slope;
    normal.right -= weighted * term->residualPx;
  }
  return normal;
}

std::string sizesOf(const Eigen::Matrix3d& covariance)
{
  return fixedDigits(std::sqrt(covariance(0, 0)), 2) + ", " + fixedDigits(std::sqrt(covariance(1, 1)), 2) + ", " +
    fixedDigits(std::sqrt(covariance(2, 2)), 2) + " mm";
}

}  // namespace

void refineTip(
  const HandEyeSamples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, HandEyeCalibrationResult& result)
{
  const std::vector<int> used = usedIndices(result);
  if (std::any_of(used.begin(), used.end(), [&](int i) { return samples[std::size_t(i)].stylusToMarker.isZero(0); }))
  {
    result.tipMessage = "the tip was not refined: the samples do not say how the stylus was turned";
    return;
  }
  const Eigen::Matrix3d prior = priorCovariance(options), priorInformation = prior.inverse();
  Eigen::Isometry3d markerToCamera = result.markerToCamera;
  Eigen::Vector3d correction_Stylus = Eigen::Vector3d::Zero();
  Normal normal;
  for (int round = 0; round < Rounds; ++round)
  {
    normal = normalEquations(samples, used, eyes, options, markerToCamera, correction_Stylus);
    Matrix9 matrix = normal.matrix;
    matrix.bottomRightCorner<3, 3>() += priorInformation;
    normal.right.tail<3>() -= priorInformation * correction_Stylus;
    const Vector9 step = matrix.ldlt().solve(normal.right);
    if (!step.allFinite())
    {
      result.tipMessage = "the tip was not refined: the samples do not determine it";
      return;
    }
    const Eigen::Matrix3d turned = rotationFromVector(step.head<3>());
    markerToCamera.linear() = nearestRotation(turned * markerToCamera.linear());
    markerToCamera.translation() = turned * markerToCamera.translation() + step.segment<3>(3);
    correction_Stylus += step.tail<3>();
  }
  // What the data alone say of the tip, the pose being free, against what the prior says.
  const auto pose = normal.matrix.topLeftCorner<6, 6>();
  const Eigen::Matrix<double, 6, 3> mixed = normal.matrix.topRightCorner<6, 3>();
  const Eigen::Matrix3d ofTip = normal.matrix.bottomRightCorner<3, 3>();
  const Eigen::Matrix3d information = ofTip - mixed.transpose() * pose.ldlt().solve(mixed);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> gained(
    0.5 * (information + information.transpose()), priorInformation);
  const Eigen::Matrix3d posterior = (information + priorInformation).inverse();
  if (!(gained.eigenvalues()(0) >= 1))
  {
    result.tipMessage = "the tip was not refined: the samples say less of it than its pivot calibration does (" + sizesOf(prior) +
      " there); turn the stylus more between the places";
    return;
  }
  result.markerToCamera = markerToCamera;
  result.tipCorrection_Stylus = correction_Stylus;
  result.refinedTipCovariance_Stylus = posterior;
  result.tipMessage = "the tip was refined by " + fixedDigits(correction_Stylus.norm(), 2) + " mm; its standard error is " +
    sizesOf(posterior) + ", before " + sizesOf(prior);
}

}  // namespace handeye
