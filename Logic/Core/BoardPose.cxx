// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardPose.h"

#include "NumberWords.h"
#include "PoseRefinement.h"
#include "RigidTransform.h"

#include <opencv2/calib3d.hpp>

#include <optional>

namespace handeye
{

namespace
{

void checkPoints(const std::vector<Eigen::Vector3d>& points_Board, const std::vector<Eigen::Vector2d>& points_Image)
{
  if (points_Board.size() != points_Image.size())
  {
    throw std::invalid_argument("estimateBoardPose: " + std::to_string(points_Board.size()) + " points of the board, but " +
      std::to_string(points_Image.size()) + " of the image");
  }
  for (std::size_t i = 0; i < points_Board.size(); ++i)
  {
    if (!points_Board[i].allFinite() || !points_Image[i].allFinite())
    {
      throw std::invalid_argument("estimateBoardPose: point " + std::to_string(i) + " has a number that is not finite");
    }
  }
}

/// Coordinates in the plane in which the points lie: p_Plane = boardToPlane * p_Board has z = 0.
struct Plane
{
  Eigen::Isometry3d boardToPlane = Eigen::Isometry3d::Identity();
  Eigen::Vector3d spread = Eigen::Vector3d::Zero();  ///< root mean square extents, the largest first
};

Plane fitPlane(const std::vector<Eigen::Vector3d>& points)
{
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points)
  {
    center += point / double(points.size());
  }
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points)
  {
    scatter += (point - center) * (point - center).transpose() / double(points.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
  Eigen::Matrix3d rotation = axes.eigenvectors().rowwise().reverse().transpose();
  rotation.row(2) *= rotation.determinant() < 0 ? -1 : 1;
  Plane plane;
  plane.boardToPlane.linear() = rotation;
  plane.boardToPlane.translation() = -(rotation * center);
  plane.spread = axes.eigenvalues().reverse().cwiseMax(0).cwiseSqrt();
  return plane;
}

/// Both poses of a plane.
std::vector<Eigen::Isometry3d> planePoses(const std::vector<Eigen::Vector3d>& points_Board,
  const std::vector<Eigen::Vector3d>& rays_Camera, const Eigen::Isometry3d& boardToPlane)
{
  std::vector<cv::Point3d> object;
  std::vector<cv::Point2d> image;
  for (std::size_t i = 0; i < points_Board.size(); ++i)
  {
    const Eigen::Vector3d point_Plane = boardToPlane * points_Board[i];
    object.emplace_back(point_Plane.x(), point_Plane.y(), 0);
    image.emplace_back(rays_Camera[i].x() / rays_Camera[i].z(), rays_Camera[i].y() / rays_Camera[i].z());
  }
  std::vector<cv::Mat> rotations, translations;
  cv::solvePnPGeneric(object, image, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotations, translations, false, cv::SOLVEPNP_IPPE);
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < rotations.size(); ++i)
  {
    const Eigen::Map<const Eigen::Vector3d> rotation(rotations[i].ptr<double>()), translation(translations[i].ptr<double>());
    Eigen::Isometry3d planeToCamera = Eigen::Isometry3d::Identity();
    planeToCamera.linear() = rotationFromVector(rotation);
    planeToCamera.translation() = translation;
    if (planeToCamera.matrix().allFinite())
    {
      poses.push_back(planeToCamera * boardToPlane);
    }
  }
  return poses;
}

BoardPose failed(BoardPose::Status status, const std::string& message)
{
  BoardPose pose;
  pose.status = status;
  pose.message = message;
  return pose;
}

double diagonalPx(const CameraModel& camera)
{
  return camera.hasImageSize() ? std::hypot(camera.width(), camera.height()) : 2 * std::hypot(camera.cx(), camera.cy());
}

}  // namespace

void BoardPoseOptions::check() const
{
  if (!(maximumRelativeRms > 0) || !(minimumAmbiguityRatio >= 1))
  {
    throw std::invalid_argument("BoardPoseOptions: maximumRelativeRms is positive and minimumAmbiguityRatio at least 1");
  }
}

BoardPose estimateBoardPose(const std::vector<Eigen::Vector3d>& points_Board, const std::vector<Eigen::Vector2d>& points_Image,
  const CameraModel& camera, const BoardPoseOptions& options)
{
  options.check();
  checkPoints(points_Board, points_Image);
  if (points_Board.size() < 4)
  {
    return failed(BoardPose::Status::TooFewPoints, "a pose needs four points, there are " + std::to_string(points_Board.size()));
  }
  const Plane plane = fitPlane(points_Board);
  if (plane.spread(1) < 0.02 * plane.spread(0))
  {
    return failed(BoardPose::Status::NotObservable, "the points that are seen lie on one line");
  }
  if (plane.spread(2) > 1e-3 * plane.spread(0))
  {
    throw std::invalid_argument("estimateBoardPose: the points do not lie in one plane");
  }
  std::vector<Eigen::Vector3d> rays_Camera;
  for (const Eigen::Vector2d& point_Image : points_Image)
  {
    const CameraModel::Unprojection seen = camera.unproject(point_Image);
    if (!seen.isUsable() || seen.ray_Camera.z() <= 0)
    {
      return failed(BoardPose::Status::PoorFit, "a point lies where the lens model does not hold");
    }
    rays_Camera.push_back(seen.ray_Camera);
  }
  std::optional<RefinedPose> best, other;
  for (const Eigen::Isometry3d& start : planePoses(points_Board, rays_Camera, plane.boardToPlane))
  {
    const std::optional<RefinedPose> refined = refinePose(points_Board, points_Image, camera, start);
    if (refined && (!best || refined->rmsPx < best->rmsPx))
    {
      other = best;
      best = refined;
    }
    else if (refined)
    {
      other = refined;
    }
  }
  if (!best || best->rmsPx > options.maximumRelativeRms * diagonalPx(camera))
  {
    return failed(BoardPose::Status::PoorFit,
      "no pose of the board explains its points" + (best ? " (" + fixedDigits(best->rmsPx, 1) + " px are left)" : std::string()) +
        ": another board, or another lens");
  }
  BoardPose pose;
  pose.boardToCamera = best->boardToCamera;
  pose.residualsPx = best->residualsPx;
  pose.rmsPx = best->rmsPx;
  pose.covariance = best->covariance;
  const bool isOther = other && rotationAngle(other->boardToCamera.linear().transpose() * best->boardToCamera.linear()) > 0.02;
  if (isOther && other->rmsPx < options.minimumAmbiguityRatio * best->rmsPx)
  {
    pose.status = BoardPose::Status::Ambiguous;
    pose.message = "the board may as well be tilted the other way (" + fixedDigits(best->rmsPx, 3) + " against " +
      fixedDigits(other->rmsPx, 3) + " px): hold it nearer, or tilt it more";
    return pose;
  }
  pose.status = BoardPose::Status::Ok;
  pose.message = fixedDigits(pose.rmsPx, 2) + " px RMS";
  return pose;
}

std::string toString(BoardPose::Status status)
{
  switch (status)
  {
    case BoardPose::Status::Ok:
      return "ok";
    case BoardPose::Status::TooFewPoints:
      return "too_few_points";
    case BoardPose::Status::NotObservable:
      return "not_observable";
    case BoardPose::Status::Ambiguous:
      return "ambiguous";
    case BoardPose::Status::PoorFit:
      return "poor_fit";
  }
  return "unknown";
}

}  // namespace handeye
