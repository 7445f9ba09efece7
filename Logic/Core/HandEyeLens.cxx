// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeLens.h"

#include "Statistics.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace handeye
{

namespace
{

/// The median residual in px of all samples with lenses of this scale, outliers included: a median does not mind.
double medianResidualPx(
  const HandEyeSamples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options, double focalScale)
{
  Eyes scaledEyes = eyes;
  for (Eye& eye : scaledEyes)
  {
    Eigen::Matrix3d cameraMatrix = eye.camera.cameraMatrix();
    cameraMatrix(0, 0) *= focalScale;
    cameraMatrix(1, 1) *= focalScale;
    eye.camera = CameraModel(eye.camera.width(), eye.camera.height(), cameraMatrix, eye.camera.distortionCoefficients());
  }
  HandEyeSamples scaled;
  for (HandEyeSample sample : samples)
  {
    const CameraModel::Unprojection unprojected = scaledEyes[std::size_t(sample.eye)].camera.unproject(sample.ball_Image);
    if (unprojected.isUsable())
    {
      sample.ray_Eye = unprojected.ray_Camera;
      scaled.push_back(sample);
    }
  }
  std::vector<int> all(scaled.size());
  std::iota(all.begin(), all.end(), 0);
  if (2 * scaled.size() < samples.size() || scaled.size() < 4)
  {
    return std::numeric_limits<double>::infinity();
  }
  const PointLineResult solution = solveHandEye(scaled, all, scaledEyes, options, PointLineOptions::Method::Global, 1);
  if (!solution.isUsable())
  {
    return std::numeric_limits<double>::infinity();
  }
  std::vector<double> residuals;
  for (const HandEyeSample& sample : scaled)
  {
    residuals.push_back(residualPx(sample, scaledEyes, solution.pointsToLines));
  }
  return median(residuals);
}

}  // namespace

std::optional<double> betterFocalScale(const HandEyeSamples& samples, const Eyes& eyes, const HandEyeCalibrationOptions& options)
{
  constexpr std::size_t LeastSamples = 8;
  constexpr int Steps = 16;
  constexpr double Largest = 1.333, MuchBetter = 0.4;
  if (samples.size() < LeastSamples)
  {
    return std::nullopt;
  }
  const double given = medianResidualPx(samples, eyes, options, 1);
  double best = given, bestScale = 1;
  int bestStep = 0;
  for (int step = -Steps; step <= Steps; ++step)
  {
    const double scale = std::pow(Largest, double(step) / Steps);
    const double residual = medianResidualPx(samples, eyes, options, scale);
    if (residual < best)
    {
      best = residual;
      bestScale = scale;
      bestStep = step;
    }
  }
  return std::abs(bestStep) < Steps && best < MuchBetter * given ? std::optional<double>(bestScale) : std::nullopt;
}

}  // namespace handeye
