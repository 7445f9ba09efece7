// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardHandEye.h"
#include "LensCalibration.h"
#include "RigidTransform.h"
#include "Simulation.h"

#include <vector>

namespace handeye::test
{

/// A board that is looked at from somewhere: tilted by up to `tiltRad` about a random axis in its plane, turned in its plane by
/// up to
/// `turnRad`, its middle at a random place of the image.
struct BoardViews
{
  double nearestMm = 250;
  double furthestMm = 450;
  double tiltRad = 0.7;
  double turnRad = 0.5;
  double borderShare = 0.35;  ///< of the image that the board's middle keeps free

  Eigen::Isometry3d pose(const BoardDescription& board, const CameraModel& camera, Random& random) const
  {
    const SimulatedCapture place{ nearestMm, furthestMm, borderShare, 0, 0 };
    const Eigen::Vector3d middle_Camera = randomPointInView(camera, place, random);
    const double way = random.uniform(-EIGEN_PI, EIGEN_PI), tilt = random.uniform(0.2, 1) * tiltRad;
    const Eigen::Vector3d axis(std::cos(way), std::sin(way), 0);
    Eigen::Isometry3d boardToCamera = Eigen::Isometry3d::Identity();
    boardToCamera.linear() = rotationFromVector(tilt * axis) * rotationFromVector({ 0, 0, random.uniform(-turnRad, turnRad) });
    boardToCamera.translation() = middle_Camera - boardToCamera.linear() * boardCenter(board);
    return boardToCamera;
  }
};

/// The points of a board that a camera sees, with noise (px per axis); those outside of the image are not among them.
inline LensView seenBoard(int frame, const BoardDescription& board, const CameraModel& camera,
  const Eigen::Isometry3d& boardToCamera, double sigmaPx, Random& random)
{
  LensView view;
  view.frame = frame;
  for (int id = 0; id < board.pointCount(); ++id)
  {
    const Eigen::Vector3d point_Board = boardPoint(board, id);
    const CameraModel::Projection seen = camera.project(boardToCamera * point_Board);
    const Eigen::Vector2d noise(random.normal(sigmaPx), random.normal(sigmaPx));
    const bool isInside = seen.isUsable() && seen.point_Image.x() > 2 && seen.point_Image.y() > 2 &&
      seen.point_Image.x() < camera.width() - 3 && seen.point_Image.y() < camera.height() - 3;
    if (isInside)
    {
      view.ids.push_back(id);
      view.points_Board.push_back(point_Board);
      view.points_Image.push_back(seen.point_Image + noise);
    }
  }
  return view;
}

/// How well tracker and camera know where things are.
struct BoardNoise
{
  double trackingRad = 0;  ///< of the marker's attitude, per axis
  double trackingMm = 0;   ///< of its place, per axis
  double cornerPx = 0;     ///< per axis
};

/// A board that stands still, the camera moving around it with a marker on its back.
struct BoardScene
{
  BoardDescription board = parseBoard("chessboard:9x6:15");
  CameraModel camera;
  Eigen::Isometry3d markerToCamera = typicalMarkerToCamera();
  Eigen::Isometry3d boardToTracker = makeRigid({ 0.3, -2.2, 0.9 }, { 120, -340, -1450 });

  /// One view of the board standing where `boardToCamera` says. The camera's place follows.
  BoardHandEyeView view(int frame, const Eigen::Isometry3d& boardToCamera, const BoardNoise& noise, Random& random) const
  {
    const LensView seen = seenBoard(frame, board, camera, boardToCamera, noise.cornerPx, random);
    BoardHandEyeView view;
    view.frame = frame;
    view.ids = seen.ids;
    view.points_Board = seen.points_Board;
    view.points_Image = seen.points_Image;
    const Eigen::Isometry3d cameraToBoard = boardToCamera.inverse();
    const Eigen::Isometry3d markerToBoard = cameraToBoard * markerToCamera;
    view.markerToTracker = boardToTracker * markerToBoard;
    view.markerToTracker.linear() = view.markerToTracker.linear() * rotationFromVector(random.normal3(noise.trackingRad));
    view.markerToTracker.translation() += random.normal3(noise.trackingMm);
    return view;
  }

  std::vector<BoardHandEyeView> views(int count, const BoardViews& how, const BoardNoise& noise, Random& random) const
  {
    std::vector<BoardHandEyeView> result;
    while (int(result.size()) < count)
    {
      const Eigen::Isometry3d boardToCamera = how.pose(board, camera, random);
      BoardHandEyeView next = this->view(int(result.size()), boardToCamera, noise, random);
      if (int(next.ids.size()) == board.pointCount())
      {
        result.push_back(std::move(next));
      }
    }
    return result;
  }
};

}  // namespace handeye::test
