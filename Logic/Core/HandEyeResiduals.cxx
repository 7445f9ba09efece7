// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeResiduals.h"

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

/// A residual (px) that stands for a point behind the camera or outside of the lens model.
constexpr double NotSeenPx = 1e4;

double focalLength(const CameraModel& camera)
{
  return (camera.fx() + camera.fy()) / 2;
}

double segmentationSigmaPx(const HandEyeSample& sample, const HandEyeCalibrationOptions& options)
{
  return sample.sigmaPx > 0 ? sample.sigmaPx : options.segmentationSigmaPx;
}

}  // namespace

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
  const HandEyeCalibrationOptions& options, PointLineOptions::Method method, int weightRounds)
{
  PointLineOptions pointLine;
  pointLine.method = method;
  pointLine.linesAreRays = true;
  std::vector<PointLinePair> pairs;
  for (int i : subset)
  {
    pairs.push_back(toPair(samples[std::size_t(i)], eyes, 1));
  }
  PointLineResult result = registerPointsToLines(pairs, pointLine);
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
