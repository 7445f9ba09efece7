// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointLineMethods.h"
#include "RigidTransform.h"

#include <opencv2/calib3d.hpp>

namespace handeye
{

namespace
{

using Status = PointLineResult::Status;

/// Rays flatter than this towards the image plane have no pixel (cosine).
constexpr double FlattestRay = 1e-3;

int solverOf(PointLineOptions::Method method)
{
  switch (method)
  {
    case PointLineOptions::Method::Epnp:
      return cv::SOLVEPNP_EPNP;
    case PointLineOptions::Method::Sqpnp:
      return cv::SOLVEPNP_SQPNP;
    default:
      return cv::SOLVEPNP_ITERATIVE;
  }
}

void refuse(PointLineResult& result, const std::string& message)
{
  result.status = Status::NotApplicable;
  result.message = message;
}

}  // namespace

void solveByOpenCV(const PointLinePairs& pairs, const PointLineOptions& options, PointLineResult& result)
{
  if (!haveOneCentre(pairs, options, result))
  {
    return;
  }
  // A camera that looks where the rays go on average; its pixels are the normalised coordinates.
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const PointLinePair& pair : pairs)
  {
    mean += pair.direction_Lines.normalized();
  }
  const bool alreadyForward = mean.normalized().z() > 0.5;
  const Eigen::Matrix3d linesToCamera = alreadyForward
    ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
    : Eigen::Quaterniond::FromTwoVectors(mean, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (const PointLinePair& pair : pairs)
  {
    const Eigen::Vector3d ray_Camera = linesToCamera * pair.direction_Lines.normalized();
    if (!(ray_Camera.z() > FlattestRay))
    {
      refuse(result, toString(options.method) + " takes rays of one half space only: use ml or global");
      return;
    }
    points.emplace_back(pair.point_Points.x(), pair.point_Points.y(), pair.point_Points.z());
    pixels.emplace_back(ray_Camera.x() / ray_Camera.z(), ray_Camera.y() / ray_Camera.z());
  }
  cv::Vec3d rotationVector, translation;
  try
  {
    if (!cv::solvePnP(
          points, pixels, cv::Matx33d::eye(), cv::noArray(), rotationVector, translation, false, solverOf(options.method)))
    {
      result.status = Status::NotConverged;
      result.message = "OpenCV's " + toString(options.method) + " found no solution";
      return;
    }
  }
  catch (const cv::Exception& error)
  {
    refuse(result, "OpenCV's " + toString(options.method) + " does not take these points: " + error.err);
    return;
  }
  const Eigen::Vector3d vector(rotationVector[0], rotationVector[1], rotationVector[2]);
  Eigen::Isometry3d pointsToCamera = Eigen::Isometry3d::Identity();
  pointsToCamera.linear() = rotationFromVector(vector);
  pointsToCamera.translation() << translation[0], translation[1], translation[2];
  if (!pointsToCamera.matrix().allFinite())
  {
    result.status = Status::NotConverged;
    result.message = "OpenCV's " + toString(options.method) + " gave numbers that are not finite";
    return;
  }
  result.pointsToLines = linesToCamera.transpose() * pointsToCamera;
  result.pointsToLines.translation() += pairs.front().origin_Lines;
  result.status = Status::Ok;
  if (options.linesAreRays && !areMostInFront(pairs, result.pointsToLines))
  {
    result.status = Status::Mirrored;
    result.message = "OpenCV's " + toString(options.method) + " ended with the points behind the camera";
  }
}

}  // namespace handeye
