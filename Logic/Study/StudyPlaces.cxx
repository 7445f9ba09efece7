// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StudyPlaces.h"

#include <stdexcept>

namespace handeye::study
{

namespace
{

constexpr double Degree = EIGEN_PI / 180;

/// A point that is seen at a random pixel at least `margin` from the border.
Eigen::Vector3d drawPoint(const CameraModel& camera, double margin, double depthMm, StudyRandom& random)
{
  const double u = random.uniform(margin, camera.width() - 1 - margin), v = random.uniform(margin, camera.height() - 1 - margin);
  const Eigen::Vector3d ray_Camera = camera.unproject({ u, v }).ray_Camera;
  return ray_Camera * (depthMm / ray_Camera.z());
}

bool isInView(const CameraModel& camera, const Eigen::Vector3d& point_Camera, double margin)
{
  const CameraModel::Projection seen = camera.project(point_Camera);
  return seen.isUsable() && seen.point_Image.x() > margin && seen.point_Image.x() < camera.width() - 1 - margin &&
    seen.point_Image.y() > margin && seen.point_Image.y() < camera.height() - 1 - margin;
}

bool isBoardInView(const CameraModel& camera, const BoardDescription& board, const Eigen::Isometry3d& boardToCamera)
{
  // The corners of the printed sheet, whose white margin of one square the detectors need.
  const double right = board.spacingMm * board.columns, bottom = board.spacingMm * board.rows, before = -board.spacingMm;
  for (const Eigen::Vector3d& corner : { Eigen::Vector3d(before, before, 0), Eigen::Vector3d(right, before, 0),
         Eigen::Vector3d(before, bottom, 0), Eigen::Vector3d(right, bottom, 0) })
  {
    if (!isInView(camera, boardToCamera * corner, 4))
    {
      return false;
    }
  }
  return true;
}

}  // namespace

Eigen::Vector3d drawBallPlace(const StudyCamera& camera, const StudyEye& eye, StudyRandom& random)
{
  const double depth = random.uniform(camera.nearestMm, camera.furthestMm);
  // Half of the ball may be out of view, as the detector allows.
  const double margin = 0.05 * eye.camera.height();
  return drawPoint(eye.camera, margin, depth, random);
}

Eigen::Isometry3d drawBoardPose(const StudyCamera& camera, const StudyEye& eye, StudyRandom& random)
{
  const Eigen::Vector3d middle_Board = boardCenter(camera.board);
  for (int attempt = 0; attempt < 10000; ++attempt)
  {
    const double direction = random.uniform(0, 2 * EIGEN_PI), tilt = random.uniform(5, 45) * Degree,
                 roll = random.uniform(-60, 60) * Degree;
    const Eigen::Vector3d axis(std::cos(direction), std::sin(direction), 0);
    Eigen::Isometry3d boardToCamera = Eigen::Isometry3d::Identity();
    boardToCamera.linear() = rotationFromVector(tilt * axis) * rotationFromVector({ 0, 0, roll });
    const Eigen::Vector3d middle_Camera =
      drawPoint(eye.camera, 0.1 * eye.camera.height(), random.uniform(camera.nearestMm, camera.furthestMm), random);
    boardToCamera.translation() = middle_Camera - boardToCamera.linear() * middle_Board;
    if (isBoardInView(eye.camera, camera.board, boardToCamera))
    {
      return boardToCamera;
    }
  }
  throw std::runtime_error("the board " + toString(camera.board) + " does not fit into the view of the " + camera.name);
}

}  // namespace handeye::study
