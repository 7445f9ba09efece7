// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComparedMethods.h"

#include <algorithm>
#include <chrono>
#include <memory>

namespace handeye
{

namespace
{

using Method = PointLineOptions::Method;
using Samples = std::vector<HandEyeSample>;

/// What all ball methods share.
struct Captures
{
  std::vector<BallCapture> captures;
  CameraModel camera;
  HandEyeCalibrationOptions options;
  Samples pool;  ///< of the first capture, what `ml` keeps
};

MethodAnswer calibrateTimed(const Samples& samples, const CameraModel& camera, const HandEyeCalibrationOptions& options)
{
  const auto start = std::chrono::steady_clock::now();
  const HandEyeCalibrationResult result = calibrateHandEye(samples, { { camera } }, options);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  return toAnswer(result, int(samples.size()), elapsed.count());
}

/// The method as it stands, from as few samples as it can take, whatever their uncertainty.
HandEyeCalibrationOptions forSubsets(HandEyeCalibrationOptions options)
{
  options.minimumSamples = 4;
  options.rejectOutliers = false;
  options.maximumMisfit = options.maximumPredictedErrorPx = 1e9;
  return options;
}

Samples choose(const Samples& pool, const std::vector<int>& numbers)
{
  Samples chosen;
  for (const int number : numbers)
  {
    chosen.push_back(pool.at(std::size_t(number)));
  }
  return chosen;
}

Samples poolOf(const Samples& samples, const CameraModel& camera, const HandEyeCalibrationOptions& options)
{
  const HandEyeCalibrationResult whole = calibrateHandEye(samples, { { camera } }, options);
  Samples kept;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    if (!whole.isUsable() || whole.samples[i].used)
    {
      kept.push_back(samples[i]);
    }
  }
  return kept;
}

ComparedMethod makeMethod(const std::shared_ptr<const Captures>& shared, Method solver, const char* title, const char* reference)
{
  ComparedMethod method;
  method.name = toString(solver);
  method.title = title;
  method.reference = reference;
  method.isOurs = solver == Method::MaximumLikelihood || solver == Method::Global || solver == Method::Procrustes;
  for (const BallCapture& capture : shared->captures)
  {
    method.sampleCounts.push_back(int(capture.samples.size()));
  }
  method.subsetPool = int(shared->pool.size());
  HandEyeCalibrationOptions options = shared->options;
  options.method = solver;
  method.calibrate = [shared, options](int capture)
  { return calibrateTimed(shared->captures.at(std::size_t(capture)).samples, shared->camera, options); };
  method.calibrateSome = [shared, options = forSubsets(options)](const std::vector<int>& samples)
  { return calibrateTimed(choose(shared->pool, samples), shared->camera, options); };
  return method;
}

/// The paper's own pipeline, from its segmentation on.
ComparedMethod makePublished(const std::shared_ptr<const Captures>& shared)
{
  ComparedMethod method;
  method.name = "as-published";
  method.title = "the paper's pipeline: HSV threshold, Hough circle, Procrustes iteration, no sample left out";
  method.reference = "Morgan et al. 2017";
  for (const BallCapture& capture : shared->captures)
  {
    method.sampleCounts.push_back(int(capture.publishedSamples.size()));
  }
  method.subsetPool = method.sampleCounts.front();
  HandEyeCalibrationOptions options = forSubsets(shared->options);
  options.method = Method::Procrustes;
  options.maximumScaleError = 1e9;  // the paper does not look at the ball's size
  method.calibrate = [shared, options](int capture)
  { return calibrateTimed(shared->captures.at(std::size_t(capture)).publishedSamples, shared->camera, options); };
  method.calibrateSome = [shared, options](const std::vector<int>& samples)
  { return calibrateTimed(choose(shared->captures.front().publishedSamples, samples), shared->camera, options); };
  return method;
}

}  // namespace

MethodAnswer toAnswer(const HandEyeCalibrationResult& calibration, int sampleCount, double seconds)
{
  MethodAnswer answer;
  answer.status = toString(calibration.status);
  answer.message = calibration.message;
  answer.sampleCount = sampleCount;
  answer.usedCount = calibration.usedCount;
  answer.seconds = seconds;
  if (calibration.isUsable())
  {
    answer.markerToCamera = calibration.markerToCamera;
  }
  return answer;
}

std::vector<ComparedMethod> ballMethods(
  const std::vector<BallCapture>& captures, const CameraModel& camera, const HandEyeCalibrationOptions& options)
{
  if (captures.empty())
  {
    return {};
  }
  const auto shared =
    std::make_shared<const Captures>(Captures{ captures, camera, options, poolOf(captures.front().samples, camera, options) });
  std::vector<ComparedMethod> methods = {
    makeMethod(shared, Method::MaximumLikelihood, "point-to-line, maximum likelihood", "this program"),
    makeMethod(shared, Method::Global, "point-to-line, proven global minimum", "this program"),
    makeMethod(shared, Method::Procrustes, "point-to-line, Procrustes iteration", "Morgan et al. 2017"),
  };
  const bool hasPublished =
    std::any_of(captures.begin(), captures.end(), [](const BallCapture& capture) { return !capture.publishedSamples.empty(); });
  if (hasPublished)
  {
    methods.push_back(makePublished(shared));
  }
  methods.push_back(makeMethod(shared, Method::OrthogonalIteration, "orthogonal iteration", "Lu, Hager, Mjolsness 2000"));
  methods.push_back(makeMethod(shared, Method::ProcrustesPnP, "Procrustean PnP", "Garro, Crosilla, Fusiello 2012"));
  methods.push_back(makeMethod(shared, Method::Epnp, "EPnP (OpenCV)", "Lepetit, Moreno-Noguer, Fua 2009"));
  methods.push_back(makeMethod(shared, Method::Sqpnp, "SQPnP (OpenCV)", "Terzakis, Lourakis 2020"));
  methods.push_back(makeMethod(shared, Method::Iterative, "reprojection error, Levenberg-Marquardt (OpenCV)", "OpenCV solvePnP"));
  return methods;
}

}  // namespace handeye
