// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "HandEyeCalibration.h"
#include "RigidTransform.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <random>
#include <vector>

namespace handeye::test
{

/// Random numbers from a fixed seed.
class Random
{
public:
  explicit Random(unsigned seed)
    : engine_(seed)
  {
  }

  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(engine_); }
  int integer(int from, int to) { return std::uniform_int_distribution<int>(from, to)(engine_); }
  double normal(double sigma) { return sigma * std::normal_distribution<double>()(engine_); }

  Eigen::Vector3d uniform3(double extent)
  {
    const double x = uniform(-extent, extent), y = uniform(-extent, extent), z = uniform(-extent, extent);
    return { x, y, z };
  }

  /// Sigma per axis.
  Eigen::Vector3d normal3(double sigma)
  {
    const double x = normal(sigma), y = normal(sigma), z = normal(sigma);
    return { x, y, z };
  }

  Eigen::Vector3d direction() { return normal3(1).normalized(); }

  /// All rotations equally likely.
  Eigen::Matrix3d rotation()
  {
    const double w = normal(1);
    const Eigen::Vector3d xyz = normal3(1);
    return Eigen::Quaterniond(w, xyz.x(), xyz.y(), xyz.z()).normalized().toRotationMatrix();
  }

  Eigen::Isometry3d rigid(double extentMm)
  {
    Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
    transform.linear() = rotation();
    transform.translation() = uniform3(extentMm);
    return transform;
  }

private:
  std::mt19937 engine_;
};

inline Eigen::Isometry3d makeRigid(const Eigen::Vector3d& rotationVector, const Eigen::Vector3d& translation)
{
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = rotationFromVector(rotationVector);
  transform.translation() = translation;
  return transform;
}

/// A marker on a camera's back, as a user would fix it: turned by 2.3 rad, some centimetres off.
inline Eigen::Isometry3d typicalMarkerToCamera()
{
  return makeRigid({ 1.9, -1.1, 0.7 }, { 18, -61, 34 });
}

/// Where balls are held, and how well they are seen.
struct SimulatedCapture
{
  double nearestMm = 150;
  double furthestMm = 700;
  double borderShare = 0.08;  ///< of the image's width and height that stays free of balls
  double trackingSigmaMm = 0;
  double segmentationSigmaPx = 0;
};

/// A point (mm) that is seen at a random place of the image.
inline Eigen::Vector3d randomPointInView(const CameraModel& camera, const SimulatedCapture& capture, Random& random)
{
  const double dx = capture.borderShare * camera.width(), dy = capture.borderShare * camera.height();
  const double u = random.uniform(dx, camera.width() - 1 - dx), v = random.uniform(dy, camera.height() - 1 - dy);
  const Eigen::Vector3d ray_Camera = camera.unproject({ u, v }).ray_Camera;
  return ray_Camera * random.uniform(capture.nearestMm, capture.furthestMm) / ray_Camera.z();
}

/// The sample that an eye gives of a ball, with noise on the tracked tip and on the segmented centre.
inline HandEyeSample makeSample(int frame, const Eigen::Vector3d& ball_Camera, const Eye& eye, int eyeIndex,
  const Eigen::Vector3d& tip_Marker, double segmentationSigmaPx, Random& random)
{
  HandEyeSample sample;
  sample.frame = frame;
  sample.eye = eyeIndex;
  sample.tip_Marker = tip_Marker;
  sample.ball_Image = eye.camera.project(eye.cameraToEye * ball_Camera).point_Image;
  sample.ball_Image.x() += random.normal(segmentationSigmaPx);
  sample.ball_Image.y() += random.normal(segmentationSigmaPx);
  sample.ray_Eye = eye.camera.unproject(sample.ball_Image).ray_Camera;
  return sample;
}

inline std::vector<HandEyeSample> simulateSamples(
  const CameraModel& camera, const Eigen::Isometry3d& markerToCamera, int count, const SimulatedCapture& capture, Random& random)
{
  std::vector<HandEyeSample> samples;
  for (int frame = 0; frame < count; ++frame)
  {
    const Eigen::Vector3d ball_Camera = randomPointInView(camera, capture, random);
    const Eigen::Vector3d tip_Marker = markerToCamera.inverse() * ball_Camera + random.normal3(capture.trackingSigmaMm);
    samples.push_back(makeSample(frame, ball_Camera, { camera }, 0, tip_Marker, capture.segmentationSigmaPx, random));
  }
  return samples;
}

}  // namespace handeye::test
