// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeResiduals.h"

#include "HandEyePrediction.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

/// A residual (px) that stands for a point behind the camera or outside of the lens model.
constexpr double NotSeenPx = 1e4;

double segmentationSigmaPx(const HandEyeSample& sample, const HandEyeCalibrationOptions& options)
{
  return sample.sigmaPx > 0 ? sample.sigmaPx : options.segmentationSigmaPx;
}

/// What the noise of a sample does to its point and its ray.
PointLineNoise toNoise(const HandEyeSample& sample, const Eyes& eyes, const HandEyeCalibrationOptions& options)
{
  const Eye& eye = eyes[std::size_t(sample.eye)];
  const double sigmaPx = segmentationSigmaPx(sample, options);
  const Eigen::Vector3d ray_Eye = sample.ray_Eye.normalized();
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = ray_Eye.unitOrthogonal();
  across.col(1) = ray_Eye.cross(across.col(0));
  Eigen::Matrix<double, 2, 3> byPoint;
  Eigen::Matrix2d byPixel = Eigen::Matrix2d::Identity() / focalLength(eye.camera);
  if (eye.camera.project(ray_Eye, &byPoint).isUsable())
  {
    byPixel = (byPoint * across).inverse();
  }
  const Eigen::Matrix<double, 3, 2> direction_Camera = eye.cameraToEye.linear().transpose() * across;
  const Eigen::Matrix<double, 3, 2> byPixel_Camera = sigmaPx * direction_Camera * byPixel;
  return { options.trackingSigmaMm * options.trackingSigmaMm * Eigen::Matrix3d::Identity(),
    byPixel_Camera * byPixel_Camera.transpose() };
}

}  // namespace

double focalLength(const CameraModel& camera)
{
  return (camera.fx() + camera.fy()) / 2;
}

std::optional<HandEyeTerm> handEyeTerm(
  const HandEyeSample& sample, const Eyes& eyes, const Eigen::Isometry3d& markerToCamera, const HandEyeCalibrationOptions& options)
{
  const Eye& eye = eyes[std::size_t(sample.eye)];
  const Eigen::Vector3d tip_Camera = markerToCamera * sample.tip_Marker;
  Eigen::Matrix<double, 2, 3> byPoint_Eye;
  const CameraModel::Projection seen = eye.camera.project(eye.cameraToEye * tip_Camera, &byPoint_Eye);
  if (!seen.isUsable())
  {
    return std::nullopt;
  }
  HandEyeTerm term;
  term.residualPx = seen.point_Image - sample.ball_Image;
  term.byPoint = byPoint_Eye * eye.cameraToEye.linear();
  term.byPose = term.byPoint * motionJacobian(tip_Camera);
  term.sigmaPx = segmentationSigmaPx(sample, options);
  const Eigen::Matrix<double, 2, 3> byNoise = options.trackingSigmaMm * term.byPoint;
  term.covariancePx = byNoise * byNoise.transpose();
  term.covariancePx.diagonal().array() += std::max(term.sigmaPx * term.sigmaPx, 1e-12 * term.covariancePx.trace());
  return term;
}

PointLinePair toPair(const HandEyeSample& sample, const Eyes& eyes, double weight)
{
  const Eigen::Isometry3d eyeToCamera = eyes[std::size_t(sample.eye)].cameraToEye.inverse();
  return { sample.tip_Marker, eyeToCamera.translation(), eyeToCamera.linear() * sample.ray_Eye, weight };
}

double residualPx(const HandEyeSample& sample, const Eyes& eyes, const Eigen::Isometry3d& markerToCamera)
{
  const Eye& eye = eyes[std::size_t(sample.eye)];
  const Eigen::Vector3d tip_Camera = markerToCamera * sample.tip_Marker;
  const CameraModel::Projection seen = eye.camera.project(eye.cameraToEye * tip_Camera);
  return seen.isUsable() ? (seen.point_Image - sample.ball_Image).norm() : NotSeenPx;
}

double distanceMm(const HandEyeSample& sample, const Eyes& eyes, const Eigen::Isometry3d& markerToCamera)
{
  const Eigen::Vector3d tip_Camera = markerToCamera * sample.tip_Marker;
  return (eyes[std::size_t(sample.eye)].cameraToEye * tip_Camera).norm();
}

double expectedMm(const HandEyeSample& sample, double distance, const Eyes& eyes, const HandEyeCalibrationOptions& options)
{
  const double focal = focalLength(eyes[std::size_t(sample.eye)].camera);
  return std::hypot(options.trackingSigmaMm, segmentationSigmaPx(sample, options) * distance / focal);
}

double expectedPx(const HandEyeSample& sample, double distance, const Eyes& eyes, const HandEyeCalibrationOptions& options)
{
  const double atLeast1Mm = std::max(distance, 1.0);
  return expectedMm(sample, atLeast1Mm, eyes, options) * focalLength(eyes[std::size_t(sample.eye)].camera) / atLeast1Mm;
}

std::vector<double> normalizedResiduals(const HandEyeSamples& samples, const Eyes& eyes, const Eigen::Isometry3d& markerToCamera,
  const HandEyeCalibrationOptions& options)
{
  std::vector<double> normalized;
  for (const HandEyeSample& sample : samples)
  {
    const double expected = expectedPx(sample, distanceMm(sample, eyes, markerToCamera), eyes, options);
    normalized.push_back(residualPx(sample, eyes, markerToCamera) / expected);
  }
  return normalized;
}

PointLineResult solveHandEye(const HandEyeSamples& samples, const std::vector<int>& subset, const Eyes& eyes,
  const HandEyeCalibrationOptions& options, PointLineOptions::Method method, int weightRounds, bool findRivals)
{
  PointLineOptions pointLine;
  pointLine.method = method;
  pointLine.linesAreRays = true;
  pointLine.findRivals = findRivals;
  const bool isLikelihood = method == PointLineOptions::Method::MaximumLikelihood;
  // The noise comes with its size, unless that is to be estimated.
  pointLine.sigmaMm = pointLine.sigmaRad = options.estimateNoise ? 0 : 1;
  std::vector<PointLinePair> pairs;
  std::vector<PointLineNoise> noise;
  for (int i : subset)
  {
    const HandEyeSample& sample = samples[std::size_t(i)];
    pairs.push_back(toPair(sample, eyes, 1));
    if (isLikelihood)
    {
      noise.push_back(toNoise(sample, eyes, options));
    }
  }
  PointLineResult result = registerPointsToLines(pairs, noise, pointLine);
  for (int round = 0; round < weightRounds && result.isUsable(); ++round)
  {
    for (std::size_t k = 0; k < subset.size(); ++k)
    {
      const HandEyeSample& sample = samples[std::size_t(subset[k])];
      const double distance = distanceMm(sample, eyes, result.pointsToLines);
      const double sigmaMm = expectedMm(sample, distance, eyes, options);
      pairs[k].weight = 1 / (sigmaMm * sigmaMm);
    }
    result = registerPointsToLines(pairs, pointLine);
  }
  return result;
}

}  // namespace handeye
