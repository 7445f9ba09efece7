// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CaptureTruth.h"

#include "PointLineRegistration.h"

#include <Eigen/LU>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace handeye::testing
{

namespace
{

using nlohmann::json;

template<int Size> Eigen::Matrix<double, Size, 1> toVector(const json& values)
{
  Eigen::Matrix<double, Size, 1> vector;
  for (int i = 0; i < Size; ++i)
  {
    vector(i) = values.at(std::size_t(i)).get<double>();
  }
  return vector;
}

Eigen::Isometry3d toTransform(const json& rows)
{
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row)
  {
    transform.matrix().row(row) = toVector<4>(rows.at(std::size_t(row))).transpose();
  }
  return transform;
}

std::vector<std::optional<CaptureTruth::Ball>> toBalls(const json& frames)
{
  std::vector<std::optional<CaptureTruth::Ball>> balls;
  for (const json& frame : frames)
  {
    balls.emplace_back();
    if (!frame.at("ball_Image_Px").is_null())
    {
      balls.back() = { toVector<3>(frame.at("ball_Camera_Mm")), toVector<2>(frame.at("ball_Image_Px")),
        frame.value("visibleShare", 1.0) };
    }
  }
  return balls;
}

}  // namespace

CaptureTruth readTruth(const std::filesystem::path& capture)
{
  std::ifstream file(capture / "truth.json");
  const json object = json::parse(file);
  CaptureTruth truth;
  truth.markerToCamera = toTransform(object.at("markerToCamera"));
  truth.tip_Stylus = toVector<3>(object.at("tip_Stylus_Mm"));
  truth.ballRadiusMm = object.at("ballRadiusMm");
  truth.calibration = toBalls(object.at("calibration"));
  truth.validation = toBalls(object.at("validation"));
  if (object.contains("modelToPhantom"))
  {
    truth.modelToPhantom = toTransform(object.at("modelToPhantom"));
  }
  return truth;
}

VolumeError errorOverVolume(const CameraModel& camera, double nearestMm, double furthestMm, const Eigen::Isometry3d& markerToCamera,
  const Eigen::Isometry3d& trueMarkerToCamera)
{
  constexpr int depths = 5, columns = 9, rows = 7;
  const Eigen::Isometry3d trueToOurs = markerToCamera * trueMarkerToCamera.inverse();
  VolumeError error;
  for (int k = 0; k < depths * columns * rows; ++k)
  {
    const double depth = nearestMm + (furthestMm - nearestMm) * (k / columns / rows) / (depths - 1);
    const Eigen::Vector3d pixel(
      (camera.width() - 1.0) * (k % columns) / (columns - 1), (camera.height() - 1.0) * (k / columns % rows) / (rows - 1), 1);
    const Eigen::Vector3d point_Camera = camera.cameraMatrix().inverse() * pixel * depth;
    const Eigen::Vector2d moved = (camera.cameraMatrix() * (trueToOurs * point_Camera)).hnormalized();
    const double shift = (moved - pixel.head<2>()).norm();
    error.meanPx += shift / (depths * columns * rows);
    error.maximumPx = std::max(error.maximumPx, shift);
  }
  return error;
}

VolumeError trackingFloor(const CaptureTruth& truth, const io::Recording& calibration, const CameraModel& camera)
{
  std::vector<PointLinePair> pairs;
  for (int frame = 0; frame < calibration.frameCount(); ++frame)
  {
    const std::optional<CaptureTruth::Ball>& ball = truth.calibration.at(std::size_t(frame));
    if (ball)
    {
      const Eigen::Isometry3d trackerToMarker = calibration.transform(frame, "MarkerToTracker").transform.inverse();
      const Eigen::Vector3d tip_Tracker = calibration.transform(frame, "StylusToTracker").transform * truth.tip_Stylus;
      pairs.push_back({ trackerToMarker * tip_Tracker, Eigen::Vector3d::Zero(), ball->ball_Camera, 1 });
    }
  }
  PointLineOptions options;
  options.method = PointLineOptions::Method::Procrustes;
  options.linesAreRays = true;
  const PointLineResult registration = registerPointsToLines(pairs, options);
  if (!registration.isUsable())
  {
    throw std::runtime_error("the truth of the capture does not register: " + registration.message);
  }
  return errorOverVolume(camera, nearestBallMm(truth), furthestBallMm(truth), registration.pointsToLines, truth.markerToCamera);
}

double nearestBallMm(const CaptureTruth& truth)
{
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& ball : truth.calibration)
  {
    nearest = ball ? std::min(nearest, ball->ball_Camera.z()) : nearest;
  }
  return nearest;
}

double furthestBallMm(const CaptureTruth& truth)
{
  double furthest = 0;
  for (const auto& ball : truth.calibration)
  {
    furthest = ball ? std::max(furthest, ball->ball_Camera.z()) : furthest;
  }
  return furthest;
}

}  // namespace handeye::testing
