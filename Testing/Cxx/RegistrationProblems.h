// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "PointLineRegistration.h"
#include "Simulation.h"
#include "TestCameras.h"

#include <opencv2/core.hpp>

#include <string>
#include <vector>

namespace handeye::test
{

/// A camera of the evaluation and the depths in which it works.
struct EvaluationCamera
{
  std::string name;
  CameraModel camera;
  double nearestMm, furthestMm;
};

inline std::vector<EvaluationCamera> evaluationCameras()
{
  return { { "webcam", makeCamera(640, 480, 650, 650, 319.5, 239.5, {}), 150, 700 },
    { "headset", makeCamera(1280, 960, 700, 700, 639.5, 479.5, {}), 200, 700 },
    { "laparoscope", makeCamera(1024, 768, 1100, 1100, 511.5, 383.5, {}), 60, 250 } };
}

constexpr double EvaluationSigmaPx = 0.5;
constexpr double EvaluationSigmaMm = 0.4;

/// One problem in the forms that the methods take.
struct RegistrationProblem
{
  Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();  ///< markerToCamera
  std::vector<HandEyeSample> samples;
  std::vector<PointLinePair> pairs;
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  cv::Matx33d cameraMatrix;
};

inline void toPairs(const CameraModel& camera, RegistrationProblem& problem)
{
  const Eigen::Matrix3d& k = camera.cameraMatrix();
  problem.cameraMatrix = cv::Matx33d(k(0, 0), 0, k(0, 2), 0, k(1, 1), k(1, 2), 0, 0, 1);
  for (const HandEyeSample& sample : problem.samples)
  {
    problem.pairs.push_back({ sample.tip_Marker, Eigen::Vector3d::Zero(), sample.ray_Eye, 1 });
    problem.points.emplace_back(sample.tip_Marker.x(), sample.tip_Marker.y(), sample.tip_Marker.z());
    problem.pixels.emplace_back(sample.ball_Image.x(), sample.ball_Image.y());
  }
}

inline SimulatedCapture evaluationCapture(const EvaluationCamera& view)
{
  return { view.nearestMm, view.furthestMm, 0, EvaluationSigmaMm, EvaluationSigmaPx };
}

/// Balls anywhere in the image and the depths, with the evaluation's noise.
inline RegistrationProblem randomProblem(const EvaluationCamera& view, int count, Random& random)
{
  RegistrationProblem problem;
  problem.truth = random.rigid(100);
  problem.samples = simulateSamples(view.camera, problem.truth, count, evaluationCapture(view), random);
  toPairs(view.camera, problem);
  return problem;
}

/// The samples of given places, with fresh noise.
inline std::vector<HandEyeSample> samplesAt(const EvaluationCamera& view, const Eigen::Isometry3d& markerToCamera,
  const std::vector<Eigen::Vector3d>& balls_Camera, Random& random)
{
  std::vector<HandEyeSample> samples;
  for (const Eigen::Vector3d& ball_Camera : balls_Camera)
  {
    const Eigen::Vector3d tip_Marker = markerToCamera.inverse() * ball_Camera + random.normal3(EvaluationSigmaMm);
    samples.push_back(makeSample(int(samples.size()), ball_Camera, { view.camera }, 0, tip_Marker, EvaluationSigmaPx, random));
  }
  return samples;
}

/// The evaluation's noise given, no sample left out, no result refused for being uncertain.
inline HandEyeCalibrationOptions evaluationOptions(PointLineOptions::Method method)
{
  HandEyeCalibrationOptions options;
  options.method = method;
  options.trackingSigmaMm = EvaluationSigmaMm;
  options.segmentationSigmaPx = EvaluationSigmaPx;
  options.rejectOutliers = false;
  options.minimumSamples = 4;
  options.maximumMisfit = options.maximumPredictedErrorPx = 1e9;
  return options;
}

inline std::vector<PointLineOptions::Method> allMethods()
{
  using Method = PointLineOptions::Method;
  return { Method::MaximumLikelihood, Method::Global, Method::Procrustes, Method::OrthogonalIteration, Method::ProcrustesPnP,
    Method::Epnp, Method::Sqpnp, Method::Iterative };
}

}  // namespace handeye::test
